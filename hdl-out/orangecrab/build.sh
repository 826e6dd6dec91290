#!/bin/sh
# Makes the bitstream with yosys, nextpnr and prjtrellis for this board: OrangeCrab r0.2 and r0.2.1.
# This file is generated: change the generator instead.
#
# Tools from pip begin with `yowasp-`; they are used where the others are not found. If yours have
# other names, give them as the variables YOSYS, NEXTPNR and ECPPACK.
set -eu
cd "$(dirname "$0")"
tool() { command -v "$1" > /dev/null && echo "$1" || echo "yowasp-$1"; }
yosys=${YOSYS:-$(tool yosys)} nextpnr=${NEXTPNR:-$(tool nextpnr-ecp5)} ecppack=${ECPPACK:-$(tool ecppack)}

"$yosys" -q -l yosys.log -p 'read_verilog carrystep_orangecrab_top.v carrystep_clock.v ../core/carrystep_uart.v ../core/carrystep_link.v ../core/carrystep_engine.v; synth_ecp5 -top carrystep_orangecrab_top -json carrystep_orangecrab_top.json'
# If nextpnr finds no placement, or none that reaches 80 MHz, the loop tries another seed.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches 80 MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" --25k --package CSFBGA285 --speed 8 --freq 80 --seed $seed --json carrystep_orangecrab_top.json --lpf carrystep_orangecrab_top.lpf --textcfg carrystep_orangecrab_top.config --quiet --log nextpnr.log && break
done
"$ecppack" --compress carrystep_orangecrab_top.config --bit carrystep_orangecrab_top.bit
echo "carrystep_orangecrab_top.bit is made; load it with: dfu-util -d 1209:5af0 -a 0 -D carrystep_orangecrab_top.bit"

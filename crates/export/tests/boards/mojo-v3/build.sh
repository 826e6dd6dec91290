#!/bin/sh
# Embedded Micro (Alchitry) Mojo v3: Verilog to bitstream with ISE 14.7, whose settings64.sh has been read. Generated: change the generator,
# not this file. This script was never run: ISE was not at hand. SYNTHESIS=yosys ./build.sh leaves synthesis to yosys, which calls this family experimental.
set -eu
cd "$(dirname "$0")"

if [ "${SYNTHESIS:-xst}" = yosys ]; then
    # Without -nowidelut four times the cells; without -pvector bra ISE builds wrong adders and says nothing.
    yosys -q -l yosys.log -p 'read_verilog carrystep_clock.v top.v; synth_xilinx -family xc6s -ise -nowidelut -flatten -top top; write_edif -pvector bra top.edif'
    ngdbuild -p xc6slx9-tqg144-2 -uc top.ucf top.edif top.ngd
else
    xst -ifn top.xst -ofn top.syr
    ngdbuild -p xc6slx9-tqg144-2 -uc top.ucf top.ngc top.ngd
fi
map -ol high -w -o top_map.ncd top.ngd top_map.pcf
par -ol high -w top_map.ncd top.ncd top_map.pcf
trce -v 3 top.ncd top_map.pcf -o top.twr
grep "All constraints were met" top.par || { echo "80 MHz is not reached: see top.twr"; exit 1; }
bitgen -g Binary:Yes -w top.ncd top.bit top_map.pcf
echo "top.bin is made; load it with: mojo.py top.bin"

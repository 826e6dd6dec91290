#!/bin/sh
# Digilent Nexys2: Verilog to bitstream with ISE 14.7, whose settings64.sh has been read. Generated: change the generator,
# not this file. This script was never run: ISE was not at hand. SYNTHESIS=yosys ./build.sh leaves synthesis to yosys, which calls this family experimental.
set -eu
cd "$(dirname "$0")"

if [ "${SYNTHESIS:-xst}" = yosys ]; then
    # Without -nowidelut four times the cells; without -pvector bra ISE builds wrong adders and says nothing.
    yosys -q -l yosys.log -p 'read_verilog carrystep_clock.v top.v; synth_xilinx -family xc3se -ise -nowidelut -flatten -top top; write_edif -pvector bra top.edif'
    ngdbuild -p xc3s500e-fg320-4 -uc top.ucf top.edif top.ngd
else
    xst -ifn top.xst -ofn top.syr
    ngdbuild -p xc3s500e-fg320-4 -uc top.ucf top.ngc top.ngd
fi
map -ol high -w -o top_map.ncd top.ngd top_map.pcf
par -ol high -w top_map.ncd top.ncd top_map.pcf
trce -v 3 top.ncd top_map.pcf -o top.twr
grep "All constraints were met" top.par || { echo "40 MHz is not reached: see top.twr"; exit 1; }
bitgen -g Binary:Yes -g StartupClk:JtagClk -w top.ncd top.bit top_map.pcf
echo "top.bit is made; load it with: djtgcfg prog -d Nexys2 -i 0 -f top.bit"

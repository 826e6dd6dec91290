#!/bin/sh
# Makes the bitstream with ISE 14.7 for this board: Embedded Micro (Alchitry) Mojo v3.
# Source the settings64.sh of ISE before you run this script.
# This file is generated: change the generator instead.
#
# This script has not been tested, because ISE was not available. SYNTHESIS=yosys ./build.sh uses
# yosys for the synthesis instead of xst; yosys calls its support of this family experimental.
set -eu
cd "$(dirname "$0")"

if [ "${SYNTHESIS:-xst}" = yosys ]; then
    # Without -nowidelut the design takes four times as many cells. Without -pvector bra ISE builds
    # wrong adders and gives no message. Without clean -purge the net of a pin may have another name
    # than the pin, so that the constraints do not apply to it.
    yosys -q -l yosys.log -p 'read_verilog carrystep_mojo_v3_top.v carrystep_clock.v ../core/carrystep_uart.v ../core/carrystep_link.v ../core/carrystep_engine.v; synth_xilinx -family xc6s -ise -nowidelut -flatten -top carrystep_mojo_v3_top; clean -purge; write_edif -pvector bra carrystep_mojo_v3_top.edif'
    # yosys writes the index of a bit in a bus as [5], xst as <5>.
    sed 's/<\([0-9]*\)>/[\1]/' carrystep_mojo_v3_top.ucf > carrystep_mojo_v3_top_yosys.ucf
    ngdbuild -p xc6slx9-tqg144-2 -uc carrystep_mojo_v3_top_yosys.ucf carrystep_mojo_v3_top.edif carrystep_mojo_v3_top.ngd
else
    xst -ifn carrystep_mojo_v3_top.xst -ofn carrystep_mojo_v3_top.syr
    ngdbuild -p xc6slx9-tqg144-2 -uc carrystep_mojo_v3_top.ucf carrystep_mojo_v3_top.ngc carrystep_mojo_v3_top.ngd
fi
map -ol high -w -o carrystep_mojo_v3_top_map.ncd carrystep_mojo_v3_top.ngd carrystep_mojo_v3_top_map.pcf
par -ol high -w carrystep_mojo_v3_top_map.ncd carrystep_mojo_v3_top.ncd carrystep_mojo_v3_top_map.pcf
trce -v 3 carrystep_mojo_v3_top.ncd carrystep_mojo_v3_top_map.pcf -o carrystep_mojo_v3_top.twr
grep "All constraints were met" carrystep_mojo_v3_top.par || { echo "80 MHz is not reached: see carrystep_mojo_v3_top.twr"; exit 1; }
bitgen -g Binary:Yes -w carrystep_mojo_v3_top.ncd carrystep_mojo_v3_top.bit carrystep_mojo_v3_top_map.pcf
echo "carrystep_mojo_v3_top.bin is made; load it with: mojo.py carrystep_mojo_v3_top.bin"

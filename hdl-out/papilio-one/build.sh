#!/bin/sh
# Makes the bitstream with ISE 14.7 for this board: Gadget Factory Papilio One.
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
    yosys -q -l yosys.log -p 'read_verilog carrystep_papilio_one_top.v carrystep_clock.v ../core/carrystep_uart.v ../core/carrystep_link.v ../core/carrystep_engine.v; synth_xilinx -family xc3se -ise -nowidelut -flatten -top carrystep_papilio_one_top; clean -purge; write_edif -pvector bra carrystep_papilio_one_top.edif'
    # yosys writes the index of a bit in a bus as [5], xst as <5>.
    sed 's/<\([0-9]*\)>/[\1]/' carrystep_papilio_one_top.ucf > carrystep_papilio_one_top_yosys.ucf
    ngdbuild -p xc3s500e-vq100-4 -uc carrystep_papilio_one_top_yosys.ucf carrystep_papilio_one_top.edif carrystep_papilio_one_top.ngd
else
    xst -ifn carrystep_papilio_one_top.xst -ofn carrystep_papilio_one_top.syr
    ngdbuild -p xc3s500e-vq100-4 -uc carrystep_papilio_one_top.ucf carrystep_papilio_one_top.ngc carrystep_papilio_one_top.ngd
fi
map -ol high -w -o carrystep_papilio_one_top_map.ncd carrystep_papilio_one_top.ngd carrystep_papilio_one_top_map.pcf
par -ol high -w carrystep_papilio_one_top_map.ncd carrystep_papilio_one_top.ncd carrystep_papilio_one_top_map.pcf
trce -v 3 carrystep_papilio_one_top.ncd carrystep_papilio_one_top_map.pcf -o carrystep_papilio_one_top.twr
grep "All constraints were met" carrystep_papilio_one_top.par || { echo "40 MHz is not reached: see carrystep_papilio_one_top.twr"; exit 1; }
bitgen -g Binary:Yes -w carrystep_papilio_one_top.ncd carrystep_papilio_one_top.bit carrystep_papilio_one_top_map.pcf
echo "carrystep_papilio_one_top.bit is made; load it with: openFPGALoader -b papilio_one carrystep_papilio_one_top.bit"

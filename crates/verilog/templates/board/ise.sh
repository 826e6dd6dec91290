#!/bin/sh
# Makes the bitstream with ISE 14.7 for this board: {{ board.title }}.
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
    yosys -q -l yosys.log -p 'read_verilog {{ sources | join(" ") }}; synth_xilinx -family {{ yosys }} -ise -nowidelut -flatten -top {{ top }}; clean -purge; write_edif -pvector bra {{ top }}.edif'
    # yosys writes the index of a bit in a bus as [5], xst as <5>.
    sed 's/<\([0-9]*\)>/[\1]/' {{ top }}.ucf > {{ top }}_yosys.ucf
    ngdbuild -p {{ part.ordered }} -uc {{ top }}_yosys.ucf {{ top }}.edif {{ top }}.ngd
else
    xst -ifn {{ top }}.xst -ofn {{ top }}.syr
    ngdbuild -p {{ part.ordered }} -uc {{ top }}.ucf {{ top }}.ngc {{ top }}.ngd
fi
map -ol high -w -o {{ top }}_map.ncd {{ top }}.ngd {{ top }}_map.pcf
par -ol high -w {{ top }}_map.ncd {{ top }}.ncd {{ top }}_map.pcf
trce -v 3 {{ top }}.ncd {{ top }}_map.pcf -o {{ top }}.twr
grep "All constraints were met" {{ top }}.par || { echo "{{ mhz }} MHz is not reached: see {{ top }}.twr"; exit 1; }
bitgen -g Binary:Yes{{ " " ~ bitgen if bitgen }} -w {{ top }}.ncd {{ top }}.bit {{ top }}_map.pcf
echo "{{ bitstream }} is made; load it with: {{ flash }}"

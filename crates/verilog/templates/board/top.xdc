# Pins and clock of this board: {{ board.title }}.
# This file is generated: change the generator instead.
set_property CFGBVS VCCO [current_design]
set_property CONFIG_VOLTAGE 3.3 [current_design]
set_property -dict { PACKAGE_PIN {{ oscillator.pin }} IOSTANDARD {{ oscillator.io }} } [get_ports { {{- oscillator.port -}} }]
create_clock -name {{ oscillator.port }} -period {{ oscillator.period_ns }} [get_ports { {{- oscillator.port -}} }]
{% for row in pins %}
set_property -dict { PACKAGE_PIN {{ row.pin }} IOSTANDARD {{ row.io }}{{ " PULLUP true" if row.pulled_up }} } [get_ports { {{- row.port -}} }]
{% endfor %}
{% if gate %}
set_property -dict { PACKAGE_PIN {{ gate.pin }} IOSTANDARD {{ io }} PULLDOWN true } [get_ports { {{- gate.port -}} }]
{% endif %}
{% for tie in ties %}
set_property -dict { PACKAGE_PIN {{ tie.pin }} IOSTANDARD {{ io }} } [get_ports { {{- tie.port -}} }]
{% endfor %}

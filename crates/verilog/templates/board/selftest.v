// SPDX-License-Identifier: MIT OR Apache-2.0
//
// The self-test of this board: {{ title }}.
// It moves nothing: the drivers have no power, and one output at a time is 1, for a second. This
// file is generated: change the generator instead.

`default_nettype none

module {{ top }} (
    input wire oscillator,
{% if gate %}
    input wire {{ gate.port }},
{% endif %}
{% for port in ports if port.name != "uart_tx" %}
    {{ "output" if port.out else "input" }} wire {{ port.range }}{{ port.name }},
{% endfor %}
{% for tie in ties %}
    output wire {{ tie.port }},
{% endfor %}
    output wire uart_tx
);
    // No module has a reset. Every register keeps the initial value that the bitstream gives it
    // until this clock starts.
    wire clock;
    {{ clock }} clock_of_all (.oscillator(oscillator), .clock(clock));

    // Bit i of both masks belongs to row i of the texts.
    wire [{{ top_row }}:0] pins;
    wire [{{ top_row }}:0] active;
    assign pins[{{ below - 1 }}:0] = {{ below }}'d0;
{% for input in inputs %}
    assign pins[{{ input.row }}] = {{ input.port }};
{% endfor %}
{% if above > 0 %}
    assign pins[{{ top_row }}:{{ next }}] = {{ above }}'d0;
{% endif %}

{% if gate %}
{% include "gate.v" %}

{% endif %}
{% for output in outputs %}
    assign {{ output.port }} = {{ "driven ? " if output.held }}active[{{ output.row }}]{{ " : 1'bz" if output.held }};
{% endfor %}
{% if enable %}

    assign enable_n = 1'b1; // the drivers have no power
{% endif %}

    wire sent;
    wire lit;
    {{ self_test }}{{ parameters }}self_test (
        .clock(clock),
        .rx(uart_rx),
        .tx(sent),
        .pins(pins),
        .active(active),
        .lit(lit)
    );
    assign uart_tx = {{ "driven ? sent : 1'bz" if tx_held else "sent" }};
{% if led %}

    assign led = {{ "!" if led_low }}lit;
{% endif %}
{% for tie in ties %}

    assign {{ tie.port }} = 1'b{{ tie.level }}; // {{ tie.why }}
{% endfor %}
endmodule

`default_nettype wire

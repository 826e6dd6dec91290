// SPDX-License-Identifier: MIT OR Apache-2.0
//
// The top level for this board: {{ title }}.
// It connects the clock, the line to the host, the host link and the engine to the pins. This file
// is generated: change the generator instead.

`default_nettype none

module {{ top }} (
    input wire oscillator,
{% for wire in line_pins %}
    {{ "output" if wire.out else "input" }} wire {{ wire.pin }},
{% endfor %}
{% if gate %}
    input wire {{ gate.port }},
{% endif %}
{% for switch in switches if switch.pin %}
    input wire {{ switch.range }}{{ switch.name }},
{% endfor %}
{% if low is not none %}
    input wire {{ low }}limit_min,
{% endif %}
{% if high is not none %}
    input wire {{ high }}limit_max,
{% endif %}
{% for name in firsts %}
    input wire {{ name }},
{% endfor %}
{% if general is not none %}
    input wire {{ general }}general,
{% endif %}
{% if outputs is not none %}
    output wire {{ outputs }}outputs,
{% endif %}
{% if pwm %}
    output wire pwm,
{% endif %}
{% for tie in ties %}
    output wire {{ tie.port }},
{% endfor %}
{% if led %}
    output wire led,
{% endif %}
    output wire enable_n,
    output wire {{ axes }}step,
    output wire {{ axes }}dir
);
    // No module has a reset. Every register keeps the initial value that the bitstream gives it
    // until this clock starts.
    wire clock;
    {{ clock }} clock_of_all (.oscillator(oscillator), .clock(clock));

{% for wire in bytes + between %}
    wire {{ wire.range }}{{ wire.name }};
{% endfor %}

{% for wire in line_pins if wire.held %}
    wire {{ wire.pin }}_out;
{% endfor %}
    {{ line }}{{ line_parameters }}line (
{% for wire in bytes %}
        .{{ wire.name }}({{ wire.name }}),
{% endfor %}
{% for wire in line_pins %}
        .{{ wire.port }}({{ wire.pin }}{{ "_out" if wire.held }}),
{% endfor %}
        .clock(clock)
    );

{% if gate %}
{% include "gate.v" %}

{% for wire in line_pins if wire.held %}
    assign {{ wire.pin }} = driven{{ " && !spi_cs_n" if wire.pin == "spi_miso" }} ? {{ wire.pin }}_out : 1'bz;
{% endfor %}

{% endif %}
    {{ link }}{{ link_parameters }}link (
{% for wire in bytes + between %}
        .{{ wire.name }}({{ wire.name }}),
{% endfor %}
        .clock(clock)
    );

    wire enabled;
{% if outputs is not none %}
    wire [7:0] levels;
    assign outputs = levels[{{ last_output }}:0];
{% endif %}
    assign enable_n = !enabled;
    {{ engine }}{{ engine_parameters }}engine (
{% for wire in between %}
        .{{ wire.name }}({{ wire.name }}),
{% endfor %}
        .clock(clock),
{% for switch in switches %}
        .{{ switch.name }}({{ switch.wire }}),
{% endfor %}
{% if more_latches %}
        .more_latches({ {{- more_latches }}}),
{% endif %}
{% if low is none %}
        .limit_min({{ count }}'d0),
{% elif one_for_all %}
        .limit_min({ {{- others }}'d0, limit_min}), // one switch for all axes
{% else %}
        .limit_min(limit_min),
{% endif %}
        .limit_max({{ "limit_max" if high is not none else count ~ "'d0" }}),
{% for port in inputs %}
        .{{ port.name }}({{ port.bits }}),
{% endfor %}
{% for port in unlinked %}
        .{{ port.name }}({{ port.tied }}),
{% endfor %}
        .step(step),
        .dir(dir),
        .enabled(enabled),
        .outputs({{ "levels" if outputs is not none }}),
        .pwm({{ "pwm" if pwm }}),
        .started(),
        .reset(1'b0), // the host stops and clears; it needs no reset
        .resetting()
    );
{% if led %}

    // The LED is lit while the gateware is loaded and no stop is latched.
    assign led = {{ "fault" if led_low else "!fault" }};
{% endif %}
{% for tie in ties %}

    assign {{ tie.port }} = 1'b{{ tie.level }}; // {{ tie.why }}
{% endfor %}
endmodule

`default_nettype wire

// SPDX-License-Identifier: MIT OR Apache-2.0
//
// The top level for {{ title }}: clock, host link and engine on its pins. Generated: change the generator, not this file.

`default_nettype none

module {{ top }} (
    input wire oscillator,
{% for wire in line_pins %}
    {{ "output" if wire.out else "input" }} wire {{ wire.pin }},
{% endfor %}
    input wire estop,
{% if low is not none %}
    input wire {{ low }}limit_min,
{% endif %}
{% if high is not none %}
    input wire {{ high }}limit_max,
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
    // Nothing has a reset: all comes up as the bitstream says, and stays so until this clock begins.
    wire clock;
    {{ clock }} clock_of_all (.oscillator(oscillator), .clock(clock));

{% for wire in bytes + between %}
    wire {{ wire.range }}{{ wire.name }};
{% endfor %}

    {{ line }} line (
{% for wire in bytes %}
        .{{ wire.name }}({{ wire.name }}),
{% endfor %}
{% for wire in line_pins %}
        .{{ wire.port }}({{ wire.pin }}),
{% endfor %}
        .clock(clock)
    );

    {{ link }} link (
{% for wire in bytes + between %}
        .{{ wire.name }}({{ wire.name }}),
{% endfor %}
        .clock(clock)
    );

    wire enabled;
    assign enable_n = !enabled;
    {{ engine }} engine (
{% for wire in between %}
        .{{ wire.name }}({{ wire.name }}),
{% endfor %}
        .clock(clock),
        .estop(estop),
{% if low is none %}
        .limit_min({{ count }}'d0),
{% elif one_for_all %}
        .limit_min({ {{- others }}'d0, limit_min}), // one for all axes
{% else %}
        .limit_min(limit_min),
{% endif %}
        .limit_max({{ "limit_max" if high is not none else count ~ "'d0" }}),
        .step(step),
        .dir(dir),
        .enabled(enabled),
        .started()
    );
{% if led %}

    // Lit: the gateware is loaded, and no stop has been called.
    assign led = {{ "fault" if led_low else "!fault" }};
{% endif %}
{% for tie in ties %}

    assign {{ tie.port }} = 1'b{{ tie.level }}; // {{ tie.why }}
{% endfor %}
endmodule

`default_nettype wire

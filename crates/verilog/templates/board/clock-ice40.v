{% extends "clock.v" %}
{% block made %}
{% if made_by == "oscillator" %}
    assign made = oscillator;
    assign locked = 1'b1;
{% else %}
{% set settings = made_by.ice40_pll %}
    {{ cell }} #(
        .FEEDBACK_PATH("SIMPLE"),
        .DIVR(4'd{{ settings.divr }}),
        .DIVF(7'd{{ settings.divf }}),
        .DIVQ(3'd{{ settings.divq }}),
        .FILTER_RANGE(3'd{{ settings.filter_range }})
    ) pll (
        .{{ "PACKAGEPIN" if cell == "SB_PLL40_PAD" else "REFERENCECLK" }}(oscillator),
        .PLLOUTGLOBAL(made),
        .LOCK(locked),
        .RESETB(1'b1),
        .BYPASS(1'b0)
    );
{% endif %}
{% endblock %}
{% block gate %}
    // `open` changes while the clock is low, so that the first pulse has its full length.
    reg open = 1'b0;
    always @(negedge made) open <= waited[{{ bits }}];
    SB_GB gate (.USER_SIGNAL_TO_GLOBAL_BUFFER(made & open), .GLOBAL_BUFFER_OUTPUT(clock));
{% endblock %}

{% extends "clock.v" %}
{% block made %}
{% if made_by == "oscillator" %}
    assign made = oscillator;
    assign locked = 1'b1;
{% else %}
{% set settings = made_by.ecp5_pll %}
    // CLKOP closes the loop; CLKOS is the clock. The phases are those of an edge at each division.
    wire looped;
    wire synthesised;
    {{ cell }} #(
        .PLLRST_ENA("DISABLED"),
        .INTFB_WAKE("DISABLED"),
        .STDBY_ENABLE("DISABLED"),
        .DPHASE_SOURCE("DISABLED"),
        .OUTDIVIDER_MUXA("DIVA"),
        .OUTDIVIDER_MUXB("DIVB"),
        .OUTDIVIDER_MUXC("DIVC"),
        .OUTDIVIDER_MUXD("DIVD"),
        .CLKI_DIV({{ settings.divide }}),
        .CLKFB_DIV(1),
        .FEEDBK_PATH("CLKOP"),
        .CLKOP_ENABLE("ENABLED"),
        .CLKOP_DIV({{ settings.multiply }}),
        .CLKOP_CPHASE({{ settings.multiply - 1 }}),
        .CLKOP_FPHASE(0),
        .CLKOS_ENABLE("ENABLED"),
        .CLKOS_DIV({{ settings.out_divide }}),
        .CLKOS_CPHASE({{ settings.out_divide - 1 }}),
        .CLKOS_FPHASE(0)
    ) pll (
        .CLKI(oscillator),
        .CLKFB(looped),
        .CLKOP(looped),
        .CLKOS(synthesised),
        .LOCK(locked),
        .RST(1'b0),
        .STDBY(1'b0),
        .PHASESEL0(1'b0),
        .PHASESEL1(1'b0),
        .PHASEDIR(1'b0),
        .PHASESTEP(1'b0),
        .PHASELOADREG(1'b0),
        .PLLWAKESYNC(1'b0),
        .ENCLKOP(1'b0),
        .ENCLKOS(1'b0)
    );
    DCCA free (.CLKI(synthesised), .CE(1'b1), .CLKO(made));
{% endif %}
{% endblock %}
{% block gate %}
    // `open` changes while the clock is low, so that the first pulse has its full length. A DCCA
    // cannot be fed by the output of another one.
    reg open = 1'b0;
    always @(negedge made) open <= waited[{{ bits }}];
    DCCA gate (.CLKI({{ "oscillator" if made_by == "oscillator" else "synthesised" }}), .CE(open), .CLKO(clock));
{% endblock %}

{% extends "clock.v" %}
{% block made %}
{% if made_by == "oscillator" %}
    assign made = oscillator;
    assign locked = 1'b1;
{% else %}
{% set settings = made_by.gowin_pll %}
    // The dividers are those of the parameters plus one; that of the output is the parameter.
    {{ cell }} #(
        .FCLKIN("{{ from }}"),
        .DEVICE("{{ part }}"),
        .IDIV_SEL({{ settings.divide - 1 }}),
        .FBDIV_SEL({{ settings.multiply - 1 }}),
        .ODIV_SEL({{ settings.out_divide }}),
        .DYN_IDIV_SEL("false"),
        .DYN_FBDIV_SEL("false"),
        .DYN_ODIV_SEL("false"),
        .PSDA_SEL("0000"),
        .DYN_DA_EN("false"),
        .DUTYDA_SEL("1000"),
        .CLKFB_SEL("internal"),
        .CLKOUT_BYPASS("false"),
        .CLKOUTP_BYPASS("false"),
        .CLKOUTD_BYPASS("false"),
        .DYN_SDIV_SEL(2),
        .CLKOUTD_SRC("CLKOUT"),
        .CLKOUTD3_SRC("CLKOUT")
    ) pll (
        .CLKIN(oscillator),
        .CLKFB(1'b0),
        .RESET(1'b0),
        .RESET_P(1'b0),
        .FBDSEL(6'd0),
        .IDSEL(6'd0),
        .ODSEL(6'd0),
        .PSDA(4'd0),
        .DUTYDA(4'd0),
        .FDLY(4'd15),
        .CLKOUT(made),
        .LOCK(locked)
    );
{% endif %}
{% endblock %}
{% block gate %}
    // `open` changes while the clock is low, so that the first pulse has its full length.
    reg open = 1'b0;
    always @(negedge made) open <= waited[{{ bits }}];
    DQCE gate (.CLKIN(made), .CE(open), .CLKOUT(clock));
{% endblock %}

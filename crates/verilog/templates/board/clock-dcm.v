{% extends "clock-xilinx.v" %}
{% block manager %}
{% set settings = made_by.dcm %}
    wire pad;
    wire synthesised;
    IBUFG ibufg (.I(oscillator), .O(pad));
    {{ cell }} #(
        .CLKFX_MULTIPLY({{ settings.multiply }}),
        .CLKFX_DIVIDE({{ settings.divide }}),
        .CLKIN_PERIOD({{ period_ns }}),
        .CLK_FEEDBACK("NONE"),
        .DFS_FREQUENCY_MODE("LOW")
    ) dcm (
        .CLKIN(pad),
        .CLKFB(1'b0),
        .RST(1'b0),
        .DSSEN(1'b0),
        .PSCLK(1'b0),
        .PSEN(1'b0),
        .PSINCDEC(1'b0),
        .CLKFX(synthesised),
        .LOCKED(locked)
    );
    BUFG bufg (.I(synthesised), .O(made));
{% endblock %}

{% extends "clock-xilinx.v" %}
{% block manager %}
{% set settings = made_by.mmcm %}
    wire pad;
    wire feedback;
    wire synthesised;
    IBUF ibuf (.I(oscillator), .O(pad));
    {{ cell }} #(
        .CLKIN1_PERIOD({{ period_ns }}),
        .DIVCLK_DIVIDE({{ settings.divide }}),
        .CLKFBOUT_MULT_F({{ settings.multiply }}.0),
        .CLKOUT0_DIVIDE_F({{ settings.out_divide }}.0)
    ) mmcm (
        .CLKIN1(pad),
        .CLKFBIN(feedback),
        .CLKFBOUT(feedback),
        .CLKOUT0(synthesised),
        .LOCKED(locked),
        .PWRDWN(1'b0),
        .RST(1'b0)
    );
    BUFG bufg (.I(synthesised), .O(made));
{% endblock %}

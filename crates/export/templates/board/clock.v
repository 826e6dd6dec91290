// SPDX-License-Identifier: MIT OR Apache-2.0
//
// {{ title }}: {{ to }} MHz of the oscillator's {{ from }} MHz. Generated: change the generator, not this file.

`default_nettype none

module carrystep_clock (
    input wire oscillator,
    output wire clock,
    output wire locked
);
{% if cell == "" %}
    assign clock = oscillator;
    assign locked = 1'b1;
{% elif "PLL" in cell %}
    {{ cell }} #(
        .FEEDBACK_PATH("SIMPLE"),
        .DIVR(4'd{{ settings.divr }}),
        .DIVF(7'd{{ settings.divf }}),
        .DIVQ(3'd{{ settings.divq }}),
        .FILTER_RANGE(3'd{{ settings.filter_range }})
    ) pll (
        .{{ "PACKAGEPIN" if cell == "SB_PLL40_PAD" else "REFERENCECLK" }}(oscillator),
        .PLLOUTGLOBAL(clock),
        .LOCK(locked),
        .RESETB(1'b1),
        .BYPASS(1'b0)
    );
{% elif "DCM" in cell %}
    wire pad;
    wire made;
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
        .CLKFX(made),
        .LOCKED(locked)
    );
    BUFG bufg (.I(made), .O(clock));
{% else %}
    wire pad;
    wire feedback;
    wire made;
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
        .CLKOUT0(made),
        .LOCKED(locked),
        .PWRDWN(1'b0),
        .RST(1'b0)
    );
    BUFG bufg (.I(made), .O(clock));
{% endif %}
endmodule

`default_nettype wire

// SPDX-License-Identifier: MIT OR Apache-2.0
//
// {{ title }}: {{ to }} MHz of the oscillator's {{ from }} MHz. Generated: change the generator, not this file.
//
// The clock starts late: engine and link have no reset, but come up as the bitstream says. So no edge may reach them that
// is too fast (while a PLL locks, its clock is anything), and none while block RAMs are not ready (an iCE40's are not for some
// microseconds after configuration). {{ wait }} clocks after the lock the gate opens, for ever: a clock that stops could leave a STEP high.

`default_nettype none

module carrystep_clock (
    input wire oscillator,
    output wire clock
);
    wire made;
    wire locked;
{% if cell == "" %}
{% if ice40 %}
    assign made = oscillator;
{% else %}
    IBUFG ibufg (.I(oscillator), .O(made));
{% endif %}
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
        .PLLOUTGLOBAL(made),
        .LOCK(locked),
        .RESETB(1'b1),
        .BYPASS(1'b0)
    );
{% elif "DCM" in cell %}
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
{% else %}
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
{% endif %}

    // Held at 0 until the lock is seen, whatever `made` does until then.
    reg [1:0] seen = 2'd0;
    reg [{{ bits }}:0] waited = {{ bits + 1 }}'d0;
    always @(posedge made) begin
        seen <= {seen[0], locked};
        if (!waited[{{ bits }}]) waited <= seen[1] ? waited + 1'b1 : {{ bits + 1 }}'d0;
    end

{% if ice40 %}
    // It opens while the clock is low: no pulse is cut.
    reg open = 1'b0;
    always @(negedge made) open <= waited[{{ bits }}];
    SB_GB gate (.USER_SIGNAL_TO_GLOBAL_BUFFER(made & open), .GLOBAL_BUFFER_OUTPUT(clock));
{% else %}
    BUFGCE gate (.I({{ "made" if cell == "" else "synthesised" }}), .CE(waited[{{ bits }}]), .O(clock));
{% endif %}
endmodule

`default_nettype wire

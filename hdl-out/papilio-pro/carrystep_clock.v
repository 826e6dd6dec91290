// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Gadget Factory Papilio Pro: 80 MHz of the oscillator's 32 MHz. Generated: change the generator, not this file.
//
// The clock starts late: engine and link have no reset, but come up as the bitstream says. So no edge may reach them that
// is too fast (while a PLL locks, its clock is anything), and none while block RAMs are not ready (an iCE40's are not for some
// microseconds after configuration). 1024 clocks after the lock the gate opens, for ever: a clock that stops could leave a STEP high.

`default_nettype none

module carrystep_clock (
    input wire oscillator,
    output wire clock
);
    wire made;
    wire locked;
    wire pad;
    wire synthesised;
    IBUFG ibufg (.I(oscillator), .O(pad));
    DCM_SP #(
        .CLKFX_MULTIPLY(5),
        .CLKFX_DIVIDE(2),
        .CLKIN_PERIOD(31.250),
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

    // Held at 0 until the lock is seen, whatever `made` does until then.
    reg [1:0] seen = 2'd0;
    reg [10:0] waited = 11'd0;
    always @(posedge made) begin
        seen <= {seen[0], locked};
        if (!waited[10]) waited <= seen[1] ? waited + 1'b1 : 11'd0;
    end

    BUFGCE gate (.I(synthesised), .CE(waited[10]), .O(clock));
endmodule

`default_nettype wire

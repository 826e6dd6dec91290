// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Embedded Micro (Alchitry) Mojo v3: 80 MHz of the oscillator's 50 MHz. Generated: change the generator, not this file.

`default_nettype none

module carrystep_clock (
    input wire oscillator,
    output wire clock,
    output wire locked
);
    wire pad;
    wire made;
    IBUFG ibufg (.I(oscillator), .O(pad));
    DCM_SP #(
        .CLKFX_MULTIPLY(8),
        .CLKFX_DIVIDE(5),
        .CLKIN_PERIOD(20.000),
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
endmodule

`default_nettype wire

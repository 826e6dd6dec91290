// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Lattice iCEstick: 48 MHz of the oscillator's 12 MHz. Generated: change the generator, not this file.

`default_nettype none

module carrystep_clock (
    input wire oscillator,
    output wire clock,
    output wire locked
);
    SB_PLL40_CORE #(
        .FEEDBACK_PATH("SIMPLE"),
        .DIVR(4'd0),
        .DIVF(7'd63),
        .DIVQ(3'd4),
        .FILTER_RANGE(3'd1)
    ) pll (
        .REFERENCECLK(oscillator),
        .PLLOUTGLOBAL(clock),
        .LOCK(locked),
        .RESETB(1'b1),
        .BYPASS(1'b0)
    );
endmodule

`default_nettype wire

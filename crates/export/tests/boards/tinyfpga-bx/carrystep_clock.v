// SPDX-License-Identifier: MIT OR Apache-2.0
//
// TinyFPGA BX: 40 MHz of the oscillator's 16 MHz. Generated: change the generator, not this file.

`default_nettype none

module carrystep_clock (
    input wire oscillator,
    output wire clock,
    output wire locked
);
    SB_PLL40_CORE #(
        .FEEDBACK_PATH("SIMPLE"),
        .DIVR(4'd0),
        .DIVF(7'd39),
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

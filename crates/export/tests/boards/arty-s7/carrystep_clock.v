// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Digilent Arty S7: 80 MHz of the oscillator's 12 MHz. Generated: change the generator, not this file.

`default_nettype none

module carrystep_clock (
    input wire oscillator,
    output wire clock,
    output wire locked
);
    wire pad;
    wire feedback;
    wire made;
    IBUF ibuf (.I(oscillator), .O(pad));
    MMCME2_BASE #(
        .CLKIN1_PERIOD(83.333),
        .DIVCLK_DIVIDE(1),
        .CLKFBOUT_MULT_F(60.0),
        .CLKOUT0_DIVIDE_F(9.0)
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
endmodule

`default_nettype wire

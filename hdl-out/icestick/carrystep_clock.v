// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Makes the clock of the gateware, 48 MHz, from the oscillator of 12 MHz.
// Board: Lattice iCEstick. This file is generated: change the generator instead.
//
// The clock starts late. The engine and the host link have no reset: the bitstream gives the
// initial values of their registers. So they must not receive a clock edge while the clock may be
// too fast (the output of a PLL has no defined frequency until it locks), nor while the block RAMs
// are not ready (those of an iCE40 are not ready for some microseconds after configuration). The
// gate opens 1024 clocks after the lock. It then stays open, because a clock that stops could
// leave a STEP pin high.

`default_nettype none

module carrystep_clock (
    input wire oscillator,
    output wire clock
);
    wire made;
    wire locked;
    SB_PLL40_CORE #(
        .FEEDBACK_PATH("SIMPLE"),
        .DIVR(4'd0),
        .DIVF(7'd63),
        .DIVQ(3'd4),
        .FILTER_RANGE(3'd1)
    ) pll (
        .REFERENCECLK(oscillator),
        .PLLOUTGLOBAL(made),
        .LOCK(locked),
        .RESETB(1'b1),
        .BYPASS(1'b0)
    );

    // `seen` synchronizes `locked`. `waited` is 0 until the lock, whatever the frequency of `made`
    // is until then; after the lock it counts clocks of `made` until its highest bit is set.
    reg [1:0] seen = 2'd0;
    reg [10:0] waited = 11'd0;
    always @(posedge made) begin
        seen <= {seen[0], locked};
        if (!waited[10]) waited <= seen[1] ? waited + 1'b1 : 11'd0;
    end

    // `open` changes while the clock is low, so that the first pulse has its full length.
    reg open = 1'b0;
    always @(negedge made) open <= waited[10];
    SB_GB gate (.USER_SIGNAL_TO_GLOBAL_BUFFER(made & open), .GLOBAL_BUFFER_OUTPUT(clock));
endmodule

`default_nettype wire

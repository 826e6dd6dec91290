// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Makes the clock of the gateware, 48 MHz, from the oscillator of 27 MHz.
// Board: Sipeed Tang Nano 9K. This file is generated: change the generator instead.
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
    // The dividers are those of the parameters plus one; that of the output is the parameter.
    rPLL #(
        .FCLKIN("27"),
        .DEVICE("GW1NR-9C"),
        .IDIV_SEL(8),
        .FBDIV_SEL(15),
        .ODIV_SEL(16),
        .DYN_IDIV_SEL("false"),
        .DYN_FBDIV_SEL("false"),
        .DYN_ODIV_SEL("false"),
        .PSDA_SEL("0000"),
        .DYN_DA_EN("false"),
        .DUTYDA_SEL("1000"),
        .CLKFB_SEL("internal"),
        .CLKOUT_BYPASS("false"),
        .CLKOUTP_BYPASS("false"),
        .CLKOUTD_BYPASS("false"),
        .DYN_SDIV_SEL(2),
        .CLKOUTD_SRC("CLKOUT"),
        .CLKOUTD3_SRC("CLKOUT")
    ) pll (
        .CLKIN(oscillator),
        .CLKFB(1'b0),
        .RESET(1'b0),
        .RESET_P(1'b0),
        .FBDSEL(6'd0),
        .IDSEL(6'd0),
        .ODSEL(6'd0),
        .PSDA(4'd0),
        .DUTYDA(4'd0),
        .FDLY(4'd15),
        .CLKOUT(made),
        .LOCK(locked)
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
    DQCE gate (.CLKIN(made), .CE(open), .CLKOUT(clock));
endmodule

`default_nettype wire

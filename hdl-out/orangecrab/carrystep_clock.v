// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Makes the clock of the gateware, 80 MHz, from the oscillator of 48 MHz.
// Board: OrangeCrab r0.2 and r0.2.1. This file is generated: change the generator instead.
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
    // CLKOP closes the loop; CLKOS is the clock. The phases are those of an edge at each division.
    wire looped;
    wire synthesised;
    EHXPLLL #(
        .PLLRST_ENA("DISABLED"),
        .INTFB_WAKE("DISABLED"),
        .STDBY_ENABLE("DISABLED"),
        .DPHASE_SOURCE("DISABLED"),
        .OUTDIVIDER_MUXA("DIVA"),
        .OUTDIVIDER_MUXB("DIVB"),
        .OUTDIVIDER_MUXC("DIVC"),
        .OUTDIVIDER_MUXD("DIVD"),
        .CLKI_DIV(1),
        .CLKFB_DIV(1),
        .FEEDBK_PATH("CLKOP"),
        .CLKOP_ENABLE("ENABLED"),
        .CLKOP_DIV(15),
        .CLKOP_CPHASE(14),
        .CLKOP_FPHASE(0),
        .CLKOS_ENABLE("ENABLED"),
        .CLKOS_DIV(9),
        .CLKOS_CPHASE(8),
        .CLKOS_FPHASE(0)
    ) pll (
        .CLKI(oscillator),
        .CLKFB(looped),
        .CLKOP(looped),
        .CLKOS(synthesised),
        .LOCK(locked),
        .RST(1'b0),
        .STDBY(1'b0),
        .PHASESEL0(1'b0),
        .PHASESEL1(1'b0),
        .PHASEDIR(1'b0),
        .PHASESTEP(1'b0),
        .PHASELOADREG(1'b0),
        .PLLWAKESYNC(1'b0),
        .ENCLKOP(1'b0),
        .ENCLKOS(1'b0)
    );
    DCCA free (.CLKI(synthesised), .CE(1'b1), .CLKO(made));

    // `seen` synchronizes `locked`. `waited` is 0 until the lock, whatever the frequency of `made`
    // is until then; after the lock it counts clocks of `made` until its highest bit is set.
    reg [1:0] seen = 2'd0;
    reg [10:0] waited = 11'd0;
    always @(posedge made) begin
        seen <= {seen[0], locked};
        if (!waited[10]) waited <= seen[1] ? waited + 1'b1 : 11'd0;
    end

    // `open` changes while the clock is low, so that the first pulse has its full length. A DCCA
    // cannot be fed by the output of another one.
    reg open = 1'b0;
    always @(negedge made) open <= waited[10];
    DCCA gate (.CLKI(synthesised), .CE(open), .CLKO(clock));
endmodule

`default_nettype wire

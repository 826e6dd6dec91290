// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Makes the clock of the gateware, 80 MHz, from the oscillator of 32 MHz.
// Board: Gadget Factory Papilio Pro. This file is generated: change the generator instead.
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

    // `seen` synchronizes `locked`. `waited` is 0 until the lock, whatever the frequency of `made`
    // is until then; after the lock it counts clocks of `made` until its highest bit is set.
    reg [1:0] seen = 2'd0;
    reg [10:0] waited = 11'd0;
    always @(posedge made) begin
        seen <= {seen[0], locked};
        if (!waited[10]) waited <= seen[1] ? waited + 1'b1 : 11'd0;
    end

    BUFGCE gate (.I(synthesised), .CE(waited[10]), .O(clock));
endmodule

`default_nettype wire

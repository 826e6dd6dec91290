// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Lattice iCE40-HX8K-B-EVN: 75 MHz of the oscillator's 12 MHz. Generated: change the generator, not this file.
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
    SB_PLL40_CORE #(
        .FEEDBACK_PATH("SIMPLE"),
        .DIVR(4'd0),
        .DIVF(7'd49),
        .DIVQ(3'd3),
        .FILTER_RANGE(3'd1)
    ) pll (
        .REFERENCECLK(oscillator),
        .PLLOUTGLOBAL(made),
        .LOCK(locked),
        .RESETB(1'b1),
        .BYPASS(1'b0)
    );

    // Held at 0 until the lock is seen, whatever `made` does until then.
    reg [1:0] seen = 2'd0;
    reg [10:0] waited = 11'd0;
    always @(posedge made) begin
        seen <= {seen[0], locked};
        if (!waited[10]) waited <= seen[1] ? waited + 1'b1 : 11'd0;
    end

    // It opens while the clock is low: no pulse is cut.
    reg open = 1'b0;
    always @(negedge made) open <= waited[10];
    SB_GB gate (.USER_SIGNAL_TO_GLOBAL_BUFFER(made & open), .GLOBAL_BUFFER_OUTPUT(clock));
endmodule

`default_nettype wire

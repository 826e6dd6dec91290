// SPDX-License-Identifier: MIT OR Apache-2.0
//
// An instance of carrystep_parallel_6 to be copied into a design. The values of the parameters are
// the defaults, and may be left out. Ports without a comment on their width have one bit; the
// comments in carrystep_parallel_6.v describe the ports. An output that is not used stays empty;
// each input needs a value. This file is generated: change the generator instead.
carrystep_parallel_6 #(
    .CLOCKS_PER_TICK(32'd80),
    .START_HALF(32'd1),
    .STEP_HIGH_0(32'd8),
    .STEP_HIGH_1(32'd80),
    .STEP_HIGH_2(32'd152),
    .STEP_HIGH_3(32'd200),
    .STEP_HIGH_4(32'd8),
    .STEP_HIGH_5(32'd240),
    .STEP_LOW_0(32'd8),
    .STEP_LOW_1(32'd80),
    .STEP_LOW_2(32'd152),
    .STEP_LOW_3(32'd200),
    .STEP_LOW_4(32'd8),
    .STEP_LOW_5(32'd240),
    .DIR_SETUP_0(32'd2),
    .DIR_SETUP_1(32'd16),
    .DIR_SETUP_2(32'd52),
    .DIR_SETUP_3(32'd400),
    .DIR_SETUP_4(32'd2),
    .DIR_SETUP_5(32'd120),
    .DIR_HOLD_0(32'd2),
    .DIR_HOLD_1(32'd16),
    .DIR_HOLD_2(32'd52),
    .DIR_HOLD_3(32'd400),
    .DIR_HOLD_4(32'd2),
    .DIR_HOLD_5(32'd120)
) parallel_6 (
    .clock(),       // input
    .seg_valid(),   // input
    .seg_axis(),    // input [2:0]
    .seg_ticks(),   // input [31:0]
    .seg_v(),       // input [63:0]
    .seg_a(),       // input [63:0]
    .seg_j(),       // input [63:0]
    .seg_last(),    // input
    .seg_ready(),   // output
    .start_valid(), // input
    .start_mask(),  // input [5:0]
    .start_ready(), // output
    .clear(),       // input
    .step(),        // output [5:0]
    .dir(),         // output [5:0]
    .position(),    // output [191:0]
    .discarded(),   // output [191:0]
    .idle(),        // output
    .fault(),       // output
    .overrun(),     // output [5:0]
    .overspeed(),   // output [5:0]
    .underrun(),    // output [5:0]
    .protocol(),    // output
    .started()      // output
);

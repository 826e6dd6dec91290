// SPDX-License-Identifier: MIT OR Apache-2.0
//
// An instance of carrystep_link to be copied into a design. The values of the parameters are the
// defaults, and may be left out. Ports without a comment on their width have one bit; the comments
// in carrystep_link.v describe the ports. An output that is not used stays empty; each input needs
// a value. This file is generated: change the generator instead.
carrystep_link #(
    .BUILD_ID(64'h5db5a34c719955df),
    .CLOCK_HZ(32'h4c4b400),
    .TICK_NS(32'd1000),
    .ROUND_TICKS(32'd32),
    .WATCHDOG_ROUNDS(32'd3126)
) link (
    .clock(),             // input
    .received_valid(),    // input
    .received(),          // input [7:0]
    .answer_valid(),      // output
    .answer(),            // output [7:0]
    .answer_take(),       // input
    .put_valid(),         // output
    .put_axis(),          // output [2:0]
    .put_word(),          // output [3:0]
    .put_data(),          // output [31:0]
    .put_ready(),         // input
    .room(),              // input [4:0]
    .room_valid(),        // input
    .start_valid(),       // output
    .start_mask(),        // output [5:0]
    .start_ready(),       // input
    .cut(),               // output
    .cut_busy(),          // input
    .cut_refused(),       // input
    .clear(),             // output
    .stop(),              // output
    .broken(),            // output
    .seek_source_valid(), // output
    .seek_source(),       // output [6:0]
    .seek_valid(),        // output
    .seek_mask(),         // output [5:0]
    .latch_arm(),         // output
    .snapshot(),          // output
    .kick(),              // output
    .enable(),            // output
    .state_valid(),       // input
    .state_page(),        // input [1:0]
    .state_axis(),        // input [2:0]
    .state_item(),        // input [2:0]
    .state(),             // input [31:0]
    .refreshed(),         // input
    .fault(),             // input
    .halted(),            // input
    .idle(),              // input
    .ready(),             // input
    .armed(),             // input
    .cause(),             // input [3:0]
    .culprits(),          // input [5:0]
    .seeking(),           // input [5:0]
    .hits(),              // input [5:0]
    .latch_armed(),       // input
    .latch_edges()        // input [3:0]
);

// SPDX-License-Identifier: MIT OR Apache-2.0
//
// An instance of carrystep_engine to be copied into a design. The values of the parameters are the
// defaults, and may be left out. Ports without a comment on their width have one bit; the comments
// in carrystep_engine.v describe the ports. An output that is not used stays empty; each input
// needs a value. This file is generated: change the generator instead.
carrystep_engine #(
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
    .DIR_HOLD_5(32'd120),
    .STOP_ACCEL_0(64'hd6bf94d5e57),
    .STOP_ACCEL_1(64'habcc7711846),
    .STOP_ACCEL_2(64'ha10fafa06c1),
    .STOP_ACCEL_3(64'h5f71977b826),
    .STOP_ACCEL_4(64'hee9bfab4c61),
    .STOP_ACCEL_5(64'h2843ebe81b0),
    .ROUND_TICKS(32'd32),
    .WATCHDOG_ROUNDS(32'd3126),
    .ENABLE_ROUNDS(32'd33),
    .DEBOUNCE_SAMPLES(32'd17),
    .LIMITS(32'd1),
    .LIMITS_LOW(32'd0),
    .LIMIT_FREEZES(32'd0),
    .INPUTS_0(32'd0),
    .INPUTS_0_LOW(32'd0),
    .INPUTS_1(32'd0),
    .INPUTS_1_LOW(32'd0),
    .LATCH_LOOKS(32'd0),
    .LATCH_LOW(32'd0),
    .ESTOP_LOW(32'd0),
    .OUTPUTS(32'd0),
    .OUTPUTS_OFF_AT_RAMPS(32'd0),
    .PWM_DIVIDER(32'd0),
    .CUTS(32'd0),
    .EVENT_MEMORY("block")
) engine (
    .clock(),             // input
    .put_valid(),         // input
    .put_axis(),          // input [2:0]
    .put_word(),          // input [3:0]
    .put_data(),          // input [31:0]
    .put_ready(),         // output
    .start_valid(),       // input
    .start_mask(),        // input [5:0]
    .start_ready(),       // output
    .cut(),               // input
    .cut_busy(),          // output
    .cut_refused(),       // output
    .clear(),             // input
    .reset(),             // input
    .stop(),              // input
    .broken(),            // input
    .seek_source_valid(), // input
    .seek_source(),       // input [6:0]
    .seek_valid(),        // input
    .seek_mask(),         // input [5:0]
    .latch_arm(),         // input
    .snapshot(),          // input
    .kick(),              // input
    .enable(),            // input
    .estop(),             // input
    .limit_min(),         // input [5:0]
    .limit_max(),         // input [5:0]
    .inputs_0(),          // input [5:0]
    .inputs_1(),          // input [5:0]
    .latch(),             // input
    .state_valid(),       // output
    .state_page(),        // output [1:0]
    .state_axis(),        // output [2:0]
    .state_item(),        // output [2:0]
    .state(),             // output [31:0]
    .refreshed(),         // output
    .room(),              // output [4:0]
    .room_valid(),        // output
    .step(),              // output [5:0]
    .dir(),               // output [5:0]
    .outputs(),           // output [7:0]
    .pwm(),               // output
    .enabled(),           // output
    .idle(),              // output
    .fault(),             // output
    .halted(),            // output
    .resetting(),         // output
    .cause(),             // output [3:0]
    .culprits(),          // output [5:0]
    .armed(),             // output
    .ready(),             // output
    .seeking(),           // output [5:0]
    .hits(),              // output [5:0]
    .latch_armed(),       // output
    .latch_edges(),       // output [3:0]
    .started()            // output
);

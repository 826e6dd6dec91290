// SPDX-License-Identifier: MIT OR Apache-2.0
//
// The top level for this board: Sipeed Tang Nano 20K.
// It connects the clock, the line to the host, the host link and the engine to the pins. This file
// is generated: change the generator instead.

`default_nettype none

module carrystep_tang_nano_20k_top (
    input wire oscillator,
    input wire uart_rx,
    output wire uart_tx,
    input wire estop,
    input wire [5:0] limit_min,
    output wire led,
    output wire enable_n,
    output wire [5:0] step,
    output wire [5:0] dir
);
    // No module has a reset. Every register keeps the initial value that the bitstream gives it
    // until this clock starts.
    wire clock;
    carrystep_clock clock_of_all (.oscillator(oscillator), .clock(clock));

    wire received_valid;
    wire [7:0] received;
    wire answer_valid;
    wire [7:0] answer;
    wire answer_take;
    wire put_valid;
    wire [2:0] put_axis;
    wire [3:0] put_word;
    wire [31:0] put_data;
    wire put_ready;
    wire [4:0] room;
    wire room_valid;
    wire start_valid;
    wire [5:0] start_mask;
    wire start_ready;
    wire cut;
    wire cut_busy;
    wire cut_refused;
    wire clear;
    wire stop;
    wire broken;
    wire seek_source_valid;
    wire [6:0] seek_source;
    wire seek_valid;
    wire [5:0] seek_mask;
    wire latch_arm;
    wire snapshot;
    wire kick;
    wire enable;
    wire state_valid;
    wire [1:0] state_page;
    wire [2:0] state_axis;
    wire [2:0] state_item;
    wire [31:0] state;
    wire refreshed;
    wire fault;
    wire halted;
    wire idle;
    wire ready;
    wire armed;
    wire [3:0] cause;
    wire [5:0] culprits;
    wire [5:0] seeking;
    wire [5:0] hits;
    wire latch_armed;
    wire [3:0] latch_edges;

    carrystep_uart #(
        .BIT_CLOCKS(32'd16)
    ) line (
        .received_valid(received_valid),
        .received(received),
        .answer_valid(answer_valid),
        .answer(answer),
        .answer_take(answer_take),
        .rx(uart_rx),
        .tx(uart_tx),
        .clock(clock)
    );

    carrystep_link #(
        .BUILD_ID(64'h3e7ae1ab3a5d130f),
        .CLOCK_HZ(32'h2dc6c00),
        .TICK_NS(32'd2000),
        .ROUND_TICKS(32'd16),
        .WATCHDOG_ROUNDS(32'd3126)
    ) link (
        .received_valid(received_valid),
        .received(received),
        .answer_valid(answer_valid),
        .answer(answer),
        .answer_take(answer_take),
        .put_valid(put_valid),
        .put_axis(put_axis),
        .put_word(put_word),
        .put_data(put_data),
        .put_ready(put_ready),
        .room(room),
        .room_valid(room_valid),
        .start_valid(start_valid),
        .start_mask(start_mask),
        .start_ready(start_ready),
        .cut(cut),
        .cut_busy(cut_busy),
        .cut_refused(cut_refused),
        .clear(clear),
        .stop(stop),
        .broken(broken),
        .seek_source_valid(seek_source_valid),
        .seek_source(seek_source),
        .seek_valid(seek_valid),
        .seek_mask(seek_mask),
        .latch_arm(latch_arm),
        .snapshot(snapshot),
        .kick(kick),
        .enable(enable),
        .state_valid(state_valid),
        .state_page(state_page),
        .state_axis(state_axis),
        .state_item(state_item),
        .state(state),
        .refreshed(refreshed),
        .fault(fault),
        .halted(halted),
        .idle(idle),
        .ready(ready),
        .armed(armed),
        .cause(cause),
        .culprits(culprits),
        .seeking(seeking),
        .hits(hits),
        .latch_armed(latch_armed),
        .latch_edges(latch_edges),
        .clock(clock)
    );

    wire enabled;
    assign enable_n = !enabled;
    carrystep_engine #(
        .CLOCKS_PER_TICK(32'd96),
        .START_HALF(32'd1),
        .STEP_HIGH_0(32'd5),
        .STEP_HIGH_1(32'd48),
        .STEP_HIGH_2(32'd92),
        .STEP_HIGH_3(32'd120),
        .STEP_HIGH_4(32'd5),
        .STEP_HIGH_5(32'd144),
        .STEP_LOW_0(32'd5),
        .STEP_LOW_1(32'd48),
        .STEP_LOW_2(32'd92),
        .STEP_LOW_3(32'd120),
        .STEP_LOW_4(32'd5),
        .STEP_LOW_5(32'd144),
        .DIR_SETUP_0(32'd1),
        .DIR_SETUP_1(32'd10),
        .DIR_SETUP_2(32'd32),
        .DIR_SETUP_3(32'd240),
        .DIR_SETUP_4(32'd1),
        .DIR_SETUP_5(32'd72),
        .DIR_HOLD_0(32'd1),
        .DIR_HOLD_1(32'd10),
        .DIR_HOLD_2(32'd32),
        .DIR_HOLD_3(32'd240),
        .DIR_HOLD_4(32'd1),
        .DIR_HOLD_5(32'd72),
        .STOP_ACCEL_0(64'h35afe535795e),
        .STOP_ACCEL_1(64'h2af31dc46118),
        .STOP_ACCEL_2(64'h2843ebe81b06),
        .STOP_ACCEL_3(64'h17dc65dee09b),
        .STOP_ACCEL_4(64'h3ba6fead3185),
        .STOP_ACCEL_5(64'ha10fafa06c1),
        .ROUND_TICKS(32'd16),
        .WATCHDOG_ROUNDS(32'd3126),
        .ENABLE_ROUNDS(32'd33),
        .DEBOUNCE_SAMPLES(32'd17),
        .LIMITS(32'd2),
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
        .put_valid(put_valid),
        .put_axis(put_axis),
        .put_word(put_word),
        .put_data(put_data),
        .put_ready(put_ready),
        .room(room),
        .room_valid(room_valid),
        .start_valid(start_valid),
        .start_mask(start_mask),
        .start_ready(start_ready),
        .cut(cut),
        .cut_busy(cut_busy),
        .cut_refused(cut_refused),
        .clear(clear),
        .stop(stop),
        .broken(broken),
        .seek_source_valid(seek_source_valid),
        .seek_source(seek_source),
        .seek_valid(seek_valid),
        .seek_mask(seek_mask),
        .latch_arm(latch_arm),
        .snapshot(snapshot),
        .kick(kick),
        .enable(enable),
        .state_valid(state_valid),
        .state_page(state_page),
        .state_axis(state_axis),
        .state_item(state_item),
        .state(state),
        .refreshed(refreshed),
        .fault(fault),
        .halted(halted),
        .idle(idle),
        .ready(ready),
        .armed(armed),
        .cause(cause),
        .culprits(culprits),
        .seeking(seeking),
        .hits(hits),
        .latch_armed(latch_armed),
        .latch_edges(latch_edges),
        .clock(clock),
        .estop(estop),
        .latch(1'b0),
        .limit_min(limit_min),
        .limit_max(6'd0),
        .inputs_0({1'b0, 1'b0, 1'b0, 1'b0, 1'b0, 1'b0}),
        .inputs_1({1'b0, 1'b0, 1'b0, 1'b0, 1'b0, 1'b0}),
        .step(step),
        .dir(dir),
        .enabled(enabled),
        .outputs(),
        .pwm(),
        .started(),
        .reset(1'b0), // the host stops and clears; it needs no reset
        .resetting()
    );

    // The LED is lit while the gateware is loaded and no stop is latched.
    assign led = fault;
endmodule

`default_nettype wire

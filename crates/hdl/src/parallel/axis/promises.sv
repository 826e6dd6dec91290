// Proves promises 5, 6, 8 and 13 of the axis, without a bound on time: P, V, A and J are those that
// docs/clock-by-clock.md specifies, and every carry is a step.
//
//   parameters   `DUT: the name of the exported axis, which includes its sequencer and its edge
//                START: the start value of P
//   assumptions  A pushed segment has at least one tick, and it is pushed only while none waits. A
//                frozen axis receives neither `push` nor `go`. An axis is cleared only while it is
//                frozen and has no step in flight (proved in core/promises.sv).
//
// This file sums the distance in 96 bits, so that no carry is lost: its upper 32 bits are the
// number of steps, and its lower 64 bits are P.

module promises (
    input wire clock,
    input wire strobe,
    input wire phase_start,
    input wire [3:0] phase,
    input wire frozen,
    input wire clear,
    input wire go,
    input wire push,
    input wire [31:0] seg_ticks,
    input wire [63:0] seg_v,
    input wire [63:0] seg_a,
    input wire [63:0] seg_j,
    input wire seg_last
);
    wire waiting, startable, request, request_back, want_fwd, want_back, in_flight, drained, overspeed, underrun;
    wire crossed, back;
    wire [3:0] q;
    wire [63:0] p, v;
    `DUT dut (.*);

    always_comb begin
        assume (!push || !waiting && !frozen && seg_ticks != 0);
        assume (!frozen || !go);
        assume (!clear || frozen && !in_flight);
    end

    (* inside = "dut.accel" *) wire [63:0] a;
    (* inside = "dut.jerk" *) wire [63:0] j;
    (* inside = "dut.sequencer.strobe" *) wire sequencer_strobe;
    (* inside = "dut.sequencer_load" *) wire load;
    (* inside = "dut.sequencer_advance" *) wire advance;
    (* inside = "dut.sequencer_running" *) wire running;
    (* inside = "dut.sequencer_v" *) wire [63:0] load_v;
    (* inside = "dut.sequencer_a" *) wire [63:0] load_a;
    (* inside = "dut.sequencer_j" *) wire [63:0] load_j;

    // ---- The distance, and the steps that the axis has reported.

    wire tick = strobe & !frozen;
    reg first_clock = 1, ticked = 0;
    reg signed [95:0] way = {32'd0, `START};
    reg [31:0] steps = 0;
    wire [31:0] steps_now = !(ticked & crossed) ? steps : back ? steps - 1 : steps + 1;
    always @(posedge clock) begin
        first_clock <= 0;
        ticked <= tick;
        steps <= steps_now;
        if (tick) way <= way + $signed({{32{v[63]}}, v});
        if (clear) way <= {steps_now, `START};
    end

    // ---- The values that V, A and J should have, computed from their old values.

    wire signed [64:0] faster = $signed({v[63], v}) + $signed({a[63], a});
    wire signed [64:0] next_v = load ? $signed({load_v[63], load_v}) : advance ? faster : 0;
    localparam signed [64:0] HALF_A_STEP = 65'sh0_8000_0000_0000_0000;
    wire fits = next_v < HALF_A_STEP && next_v > -HALF_A_STEP;
    reg [63:0] new_v = 0, new_a = 0, new_j = 0;
    reg was_off_limits = 0, was_overspeed = 0;
    always @(posedge clock) begin
        was_off_limits <= tick & !fits;
        was_overspeed <= overspeed;
        if (frozen || tick && !fits) {new_v, new_a, new_j} <= 0;
        else if (tick && load) {new_v, new_a, new_j} <= {load_v, load_a, load_j};
        else if (tick && advance) {new_v, new_a, new_j} <= {v + a, a + j, j};
        else if (tick) {new_v, new_a, new_j} <= 0;
    end

    // ---- The promises.

    always_comb begin
        promise_6_every_carry_is_a_step: assert (way == {steps_now, p});
        promise_6_registers_of_old_values: assert ({v, a, j} == {new_v, new_a, new_j});
        promise_6_speed_in_range: assert (v != 64'h8000_0000_0000_0000);
        promise_6_overspeed_is_told: assert (!was_off_limits || overspeed || clear);
        promise_6_overspeed_is_off_limits: assert (!overspeed || was_overspeed || was_off_limits);
        promise_5_frozen_adds_nothing: assert (!frozen || !sequencer_strobe && !load && !advance);
        promise_8_drained: assert (drained == (!running && !waiting && !in_flight));
        promise_8_rest_is_rest: assert (running || {v, a, j} == 0);
        promise_13_inactive: assert (!first_clock || drained && {request, want_fwd, want_back, v} == 0 && p == `START);
    end

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_6_forward: cover (steps_now == 1);
        cover_6_backward: cover (steps_now == 32'hffffffff && back);
        cover_6_overspeed: cover (overspeed && !was_overspeed);
        cover_8_drained_after_a_step: cover (steps == 1 && drained);
    end
endmodule

// The axis: P, V, A and J as design section 1 has them; every carry is a step: promises 5, 6, 8, 13. Without bound.
//
//   from outside   `DUT, the exported axis, its sequencer and its edge inside; START, the start value of P
//   assumed        what six_axis/promises.sv proves: a segment has ticks and is pushed only where none waits;
//                  frozen: no push, no go; only who is frozen, with no step on its way, is cleared
//
// The travelled way is summed here without a carry in 96 bits: its whole steps are the carries, its fraction is P.

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

    // ---- The way, and the steps that were told.

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

    // ---- What V, A and J are to be, of the old values.

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

    // ---- None of it is empty.

    always_comb begin
        cover_6_forward: cover (steps_now == 1);
        cover_6_backward: cover (steps_now == 32'hffffffff && back);
        cover_6_overspeed: cover (overspeed && !was_overspeed);
        cover_8_drained_after_a_step: cover (steps == 1 && drained);
    end
endmodule

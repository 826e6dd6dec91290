// Proves promises 11, 12, 13 and 15 of the schedule of an engine with several adders, without a
// bound on time.
//
//   parameters   AXES: number of axes
//                LANES: number of adders
//                CLOCKS: the least number of clocks from one strobe to the next
//                `DUT: the name of the exported module `lane_slots`
//   assumptions  A tick is never shorter than CLOCKS (proved in event_wheel/promises.sv).
//
// In every tick each axis has one time slot of 13 beats, together with the axes of the other lanes:
// axis i in the time slot i / LANES. The first one begins in the clock after the strobe, and the
// time slots do not overlap.

module promises (
    input wire clock,
    input wire strobe
);
    localparam [16:0] AXES = `AXES, LANES = `LANES, CLOCKS = `CLOCKS, TIME_SLOT_CLOCKS = 13,
        ALL_TIME_SLOTS = TIME_SLOT_CLOCKS * (AXES / LANES);

    wire [16:0] beat;
    wire [2:0] axis, axis_next;
    wire [`AXES-1:0] axis_one_hot;
    wire is_last;
    `DUT dut (.*);

    // ---- The clocks since the strobe, and the time slot and the beat that follow from them.

    reg [16:0] at = ALL_TIME_SLOTS;           // ALL_TIME_SLOTS means that all time slots are over
    reg [16:0] since = CLOCKS;
    wire in_time_slot = at < ALL_TIME_SLOTS;
    wire [16:0] number = at / TIME_SLOT_CLOCKS, clock_of_time_slot = at % TIME_SLOT_CLOCKS;
    always @(posedge clock) begin
        at <= strobe ? 0 : at == ALL_TIME_SLOTS ? at : at + 1;
        since <= strobe ? 1 : since == CLOCKS ? since : since + 1;
    end
    // Beats 13 to 16 of a time slot, which overlap the next time slot or follow the last one.
    reg [3:0] tail = 0;
    always @(posedge clock) tail <= {tail[2:0], in_time_slot & clock_of_time_slot == TIME_SLOT_CLOCKS - 1};
    always_comb begin
        assume (!strobe || since == CLOCKS);
    end

    // ---- Values of the clock before, for promises that the proofs of other modules assume; and
    // how often each axis had beat 0 in this tick.

    reg first_clock = 1, has_ticked = 0;
    reg [12:0] was_beat = 0;
    reg [2:0] was_next = 0, was_axis = 0;
    reg [`AXES-1:0] had = 0, twice = 0;
    wire [`AXES-1:0] of_time_slot = ((32'd1 << LANES) - 1) << axis;
    wire [`AXES-1:0] begins = beat[0] ? of_time_slot : 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_beat, was_next, was_axis} <= {beat[12:0], axis_next, axis};
        has_ticked <= has_ticked | strobe;
        had <= strobe ? 0 : had | begins;
        twice <= strobe ? 0 : twice | had & begins;
    end

    // ---- The promises.

    always_comb begin
        promise_11_every_axis_once_a_tick: assert (twice == 0 && (!strobe || !has_ticked || &had));
        promise_11_beats_of_a_time_slot: assert (beat[12:0] == (in_time_slot ? 13'd1 << clock_of_time_slot : 0));
        promise_11_tail: assert (beat[16:13] == tail);
        promise_12_whose_time_slot: assert (axis == (in_time_slot ? LANES * number : 0));
        promise_12_one_hot_is_the_axis: assert (axis_one_hot == 32'd1 << axis);
        promise_12_every_lane_has_an_axis: assert (axis % LANES == 0 && axis + LANES <= AXES);
        promise_12_one_after_the_other: assert ((beat[12:0] & (beat[12:0] - 1)) == 0 && beat[12:1] == was_beat[11:0]
            && (first_clock ? axis == 0 : axis == was_next));
        promise_12_nothing_else_in_a_time_slot: assert ((beat[11:0] == 0 || axis_next == axis)
            && (!beat[12] || axis_next != axis || AXES == LANES));
        promise_12_no_time_slot_at_a_strobe: assert (!strobe || beat[12:0] == 0);
        promise_12_findings_are_told_before_the_strobe: assert (!strobe || beat[14:13] == 0);
        promise_12_a_time_slot_of_its_own_after_a_pause: assert (!was_beat[12] || axis != was_axis || beat[12:0] == 0);
        promise_13_inactive: assert (!first_clock || beat == 0);
        promise_15_last: assert (!in_time_slot || is_last == (number == AXES / LANES - 1));
        promise_15_two_clocks_to_count_the_tick: assert (!(beat[0] && beat[14]));
    end

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (at <= ALL_TIME_SLOTS && since <= CLOCKS);
        invariant_2: assert (in_time_slot ? since == at + 1 : since > ALL_TIME_SLOTS);
        invariant_3: assert (in_time_slot ? was_beat == (clock_of_time_slot == 0 ? (at == 0 ? 0 : 13'h1000)
            : 13'd1 << (clock_of_time_slot - 1)) : was_beat == 0 || was_beat == 13'h1000);
        invariant_4: assert (was_next == axis || first_clock);
        invariant_5: assert (!was_beat[12] || first_clock || was_axis == LANES * ((in_time_slot ? number : AXES / LANES) - 1));
        invariant_6: assert (!in_time_slot || number == 0 || tail == (clock_of_time_slot < 4 ? 4'd1 << clock_of_time_slot : 0));
        invariant_7: assert (!in_time_slot || number != 0 || (at == 0 ? tail[2:0] == 0 : tail == 0));
        invariant_8: assert (in_time_slot || (since == ALL_TIME_SLOTS + 1 ? tail == 1 : since == ALL_TIME_SLOTS + 2 ? tail == 2
            : tail[1:0] == 0));
        invariant_9: assert (!has_ticked || had == (in_time_slot ? (32'd1 << LANES * (number + (clock_of_time_slot != 0))) - 1
            : (32'd1 << AXES) - 1));
        invariant_10: assert (has_ticked || !in_time_slot && had == 0 && since == CLOCKS);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_11_second_time_slot: cover (beat[0] && beat[13] && axis == LANES);
        cover_12_tail: cover (beat[16] && axis == LANES);
    end
endmodule

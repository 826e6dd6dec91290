// Proves promises 6, 11, 12 and 13 of the event wheel, without a bound on time: an event that a
// time slot has found is at the outputs once, two ticks later, at its phase.
//
//   parameters   AXES: number of axes
//                CLOCKS, PHASES: clocks and phases in a tick
//                `DUT: the name of the exported module `event_wheel`
//                The exported module carrystep_time_slot generates the time slots.
//   assumptions  The phase `q` does not change from the beat after `phase_known` to the end of the
//                next time slot, and the direction `back` does not change from the end of one time
//                slot to the end of the next one (proved in adder/promises.sv).
//
// All statements are about one axis, `who`, and about one word of the event memory, which is
// given by its tick modulo 4, `at_tick`, its phase, `at_phase`, and its kind: step or sign of V.
// The solver may choose any of them. The word contains an event of this axis if and only if a time
// slot of this axis has found the event.

module promises (
    input wire clock,
    input wire crosses,
    input wire has_sign,
    input wire back,
    input wire [3:0] q
);
    localparam [7:0] CLOCKS = `CLOCKS, PHASES = `PHASES, PHASE_CLOCKS = CLOCKS / PHASES, TIME_SLOT_CLOCKS = 13, ALL_TIME_SLOTS = TIME_SLOT_CLOCKS * `AXES;
    (* anyconst *) reg [2:0] who;
    (* anyconst *) reg [1:0] at_tick;
    (* anyconst *) reg [3:0] at_phase;
    (* anyconst *) reg sign;

    wire strobe, phase_start;
    wire [`AXES-1:0] events, backward, axis_one_hot;
    wire [16:0] beat;
    wire [2:0] axis, axis_next;
    wire is_last;
    wire time_slot_ends = beat[12], phase_known = beat[16];
    carrystep_time_slot time_slots (.*);
    `DUT dut (.*);

    // ---- Time: the clock within the tick, and the tick modulo 4. Of the last time slot that has
    // ended: the clocks since its end, whether it was that of `who`, and its tick.

    reg first_clock = 1, turning = 0;
    reg [7:0] at = 0;
    reg [1:0] tick = 0, found_in = 0;
    reg [3:0] age = 15;
    reg whose = 0, was_back = 0;
    reg [3:0] was_q = 0;
    wire mine = (axis_one_hot >> who) & 1;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_back, was_q} <= {back, q};
        at <= at == CLOCKS - 1 ? 0 : at + 1;
        if (at == CLOCKS - 1) {turning, tick} <= {1'b1, tick + 2'd1};
        age <= time_slot_ends ? 1 : age == 15 ? 15 : age + 1;
        if (time_slot_ends) {whose, found_in} <= {mine, tick};
    end
    always_comb begin
        assume (who < `AXES && at_phase < PHASES && (!sign || at_phase == PHASES - 1));
        assume (time_slot_ends || back == was_back);
        assume (age < 6 || age == 15 || q == was_q);
    end

    // ---- The event that the word should contain.

    reg finds_step = 0, finds_sign = 0, expected = 0, expected_back = 0;
    wire known = whose & (sign ? age == 1 & finds_sign & found_in + 2'd1 == at_tick
        : age == 5 & finds_step & found_in + 2'd2 == at_tick & q / (5'd16 / PHASES) == at_phase);
    wire now = !first_clock & tick == at_tick & (sign ? at == CLOCKS - 1 : at == at_phase * PHASE_CLOCKS);
    wire expected_now = known | expected;
    wire back_now = known ? back : expected_back;
    always @(posedge clock) begin
        if (time_slot_ends) {finds_step, finds_sign} <= {crosses, has_sign};
        expected <= expected_now & !now;
        expected_back <= back_now;
    end
    wire event_now = (events >> who) & 1, event_back = (backward >> who) & 1;

    // ---- The promises.

    always_comb begin
        promise_6_each_carry_once: assert (!now || event_now == expected);
        promise_11_at_its_phase: assert (!now || sign || !expected || phase_start && event_now);
        promise_11_sign_before_its_tick: assert (!now || !sign || !expected || strobe && event_now);
        promise_11_direction: assert (!now || !expected || event_back == expected_back);
        promise_11_one_beat: assert (strobe == (at == CLOCKS - 1)
            && phase_start == (at % PHASE_CLOCKS == 0 && !first_clock));
        promise_12_of_its_own_axis: assert (!now || !event_now || expected);
        promise_12_no_word_used_that_was_written: assert (!(strobe | phase_start) || !was_clash);
        promise_13_inactive: assert (!first_clock || !strobe && !phase_start);
    end

    // ---- The invariants that make the promises inductive. `look` is an additional read port for
    // the word in memory. The tick counter inside the event wheel runs one clock ahead.

    wire [6:0] place = {at_tick, sign, at_phase};
    wire [15:0] word;
    memory_probe #("\\dut.event_memory.words", 7, 16) at_event_memory (1'b0, 1'b1, place, word);
    (* inside = "dut.tick.sub" *) wire [15:0] sub;
    (* inside = "dut.tick.phases" *) wire [3:0] phases;
    (* inside = "dut.ahead" *) wire [1:0] ahead;
    (* inside = "dut.read" *) wire [6:0] read;
    (* inside = "dut.place" *) wire [6:0] to_read;
    (* inside = "dut.event_memory_read_data" *) wire [15:0] value;
    (* inside = "dut.sign_due" *) wire sign_due;
    (* inside = "dut.step_due" *) wire step_due;
    (* inside = "dut.step_known" *) wire step_known;
    (* inside = "dut.whose" *) wire [`AXES-1:0] dut_whose;
    (* inside = "dut.when" *) wire [1:0] when;
    (* inside = "dut.bits" *) wire [15:0] bits;
    (* inside = "dut.event_memory_write_address" *) wire [6:0] write_at;
    (* inside = "time_slots.beats" *) wire [16:0] beats;
    wire clash = bits != 0 & write_at == to_read;
    reg was_clash = 0;
    reg [2:0] wiped = 0;             // bit i: a word was cleared i + 1 clocks ago
    always @(posedge clock) begin
        was_clash <= clash;
        wiped <= {wiped[1:0], strobe | phase_start};
    end

    // A time slot that has ended has an event for the word, which is still to be written.
    wire comes = whose & (sign ? sign_due & when == at_tick
        : step_due & step_known & when + 2'd1 == at_tick & q / (5'd16 / PHASES) == at_phase);
    wire [7:0] next = at == CLOCKS - 1 ? 0 : at + 1;
    wire in_time_slot = turning & at < ALL_TIME_SLOTS;

    function wipes(input [7:0] clock_of_tick);
        wipes = clock_of_tick == CLOCKS - 1 || clock_of_tick % PHASE_CLOCKS == 0;
    endfunction
    function [7:0] before(input [7:0] clock_of_tick, input [1:0] clocks);
        before = clock_of_tick >= clocks ? clock_of_tick - clocks : clock_of_tick + CLOCKS - clocks;
    endfunction

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (at < CLOCKS && sub < PHASE_CLOCKS && phases < PHASES && phases * PHASE_CLOCKS + sub == next);
        invariant_2: assert (ahead == (at == CLOCKS - 1 ? tick + 2'd1 : tick));
        invariant_3: assert (read == (at == CLOCKS - 1 ? {tick, 1'b1, 4'd0} | (PHASES - 1)
            : {tick, 1'b0, 4'd0} | at / PHASE_CLOCKS));
        invariant_4: assert (beats[12:0] == (in_time_slot ? 13'd1 << (at % TIME_SLOT_CLOCKS) : 0)
            && axis_one_hot == 32'd1 << (in_time_slot ? at / TIME_SLOT_CLOCKS : 0));
        invariant_5: assert (beats[16:13] == {age == 4, age == 3, age == 2, age == 1});
        invariant_6: assert (age != 0 && (!turning || at < TIME_SLOT_CLOCKS || tick == 0 && !turning
            || age == (at < ALL_TIME_SLOTS ? at % TIME_SLOT_CLOCKS + 1 : at - (ALL_TIME_SLOTS - 1) > 15 ? 15 : at - (ALL_TIME_SLOTS - 1))));
        invariant_7: assert (at >= TIME_SLOT_CLOCKS || age == 15 || at + CLOCKS - (ALL_TIME_SLOTS - 1) == age);
        invariant_8: assert (turning || age == 15);
        invariant_9: assert (age == 15 || found_in == (at >= TIME_SLOT_CLOCKS ? tick : tick - 2'd1));
        invariant_10: assert (age == 15 && !sign_due && !step_due
            || when == found_in + 2'd1 && ((dut_whose >> who) & 1) == whose);
        invariant_11: assert (!sign_due || finds_sign && (age == 1 || age == 2 && wiped[0]
            || age == 3 && wiped[1:0] == 3 || age == 4 && wiped == 7));
        invariant_12: assert (age != 1 || sign_due == finds_sign && step_due == finds_step);
        invariant_13: assert (!step_due || finds_step && (age <= 5 || age == 6 && wiped[0]
            || age == 7 && wiped[1:0] == 3 || age == 8 && wiped == 7));
        invariant_14: assert (step_known == (age >= 5) || !step_due);
        invariant_15: assert (age > 5 || step_due == finds_step);
        invariant_16: assert (turning || tick == 0);
        invariant_17: assert (!first_clock || at == 0 && !turning);
        invariant_18: assert (!(turning || at >= 2) || wiped[0] == wipes(before(at, 1)));
        invariant_22: assert (!(turning || at >= 3) || wiped[1] == wipes(before(at, 2)));
        invariant_23: assert (!(turning || at >= 4) || wiped[2] == wipes(before(at, 3)));
        invariant_19: assert (expected_now == (((word >> who) & 1) | comes));
        invariant_20: assert (!expected_now || (comes ? back : (word >> (who + 8)) & 1) == back_now);
        invariant_21: assert (read != place || was_clash || first_clock || ((value ^ word) >> who & 16'h101) == 0);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    reg signed_event = 0, stepped = 0;
    always @(posedge clock) begin
        signed_event <= signed_event | now & sign & event_now;
        stepped <= stepped | now & !sign & event_now & event_back;
    end
    always_comb begin
        cover_11_sign: cover (signed_event);
        cover_11_step_back: cover (stepped);
    end
endmodule

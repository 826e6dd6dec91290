// Proves promises 5, 6, 7, 10, 12, 13 and 15 of the queue, without a bound on time: which segment
// runs, which segments wait, how pulses and discarded steps reach the counters in memory, and how
// many steps are on their way.
//
//   parameters   `DUT: the name of the exported queue
//   assumptions  The beats of a time slot follow one another and belong to one axis (proved in
//                time_slot/promises.sv). The inputs for starts and stops do not change within a time
//                slot; a word is taken only in beat 7 and if there is room; an axis starts only if
//                a segment waits (proved in engine/promises.sv). In any time there are at most
//                three pulses more than time slots, and at most seven discarded steps are not
//                counted in memory yet (docs/promises.md gives the reasons).
//
// All statements are about one axis, `who`; the solver may choose any. This file numbers the
// segments with 32 bits; the queue numbers them modulo 8.

module promises (
    input wire clock,
    input wire [16:0] beat,
    input wire [2:0] axis,
    input wire [2:0] axis_next,
    input wire starts,
    input wire halted,
    input wire ramp,
    input wire clear,
    input wire empties,
    input wire take,
    input wire [2:0] put_word,
    input wire last,
    input wire ended,
    input wire overflow,
    input wire least,
    input wire turned,
    input wire back,
    input wire crosses,
    input wire meets,
    input wire [2:0] pulses,
    input wire [2:0] losses,
    input wire rises,        // a pulse of `who` in this clock
    input wire rises_back,
    input wire discards      // one of its steps is discarded
);
    (* anyconst *) reg [2:0] who;

    wire [2:0] live, fresh, room;
    wire misplaced, full, empty, running, sound, slows, upward, steady, moves, goes_on, too_fast, dry, up, down, lost, met;
    wire [3:0] on_way;
    `DUT dut (.*);

    // ---- The beats of a time slot, and the inputs that do not change within it.

    wire mine = axis == who;
    wire in_time_slot = beat[12:0] != 0;
    wire samples = mine & beat[4];     // the queue compares the pulses with the counter in memory
    wire asked = mine & beat[12:5] != 0;   // `up`, `down` and `lost` give the result
    wire ends = mine & beat[12];
    reg first_clock = 1, was_running = 0;
    reg [12:0] was_beat = 0;
    reg [2:0] was_next = 0, was_axis = 0;
    reg was_starts = 0, was_halted = 0, was_ramp = 0, was_clear = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_beat, was_next, was_axis} <= {beat[12:0], axis_next, axis};
        {was_starts, was_halted, was_ramp, was_clear} <= {starts, halted, ramp, clear};
    end
    always_comb begin
        assume ((beat[12:0] & (beat[12:0] - 1)) == 0 && beat[12:1] == was_beat[11:0]);
        assume (first_clock ? axis == 0 && !in_time_slot : axis == was_next);
        assume (beat[11:0] == 0 || axis_next == axis);
        assume (!was_beat[12] || axis != was_axis || !in_time_slot);
        assume (was_beat[11:0] == 0 || {starts, halted, ramp, clear} == {was_starts, was_halted, was_ramp, was_clear});
        assume (!clear || halted);
    end

    // ---- The numbers of segments of `who` that have been committed and begun, and for each of the
    // eight places of the queue the mark `last of its move`.

    reg [31:0] committed = 0, begun = 0;
    reg [7:0] marks = 0;
    reg adds = 0;                    // a segment has been committed in this time slot
    reg takes = 0;                   // a word has been taken in this time slot
    reg [2:0] due = 0;               // the number of the word that must come next
    wire commit = put_word == due && due == 7;
    wire begins = mine & in_time_slot & starts;
    wire [31:0] begun_now = begun + begins;
    wire [31:0] waiting = committed - begun_now;
    wire [7:0] place = 8'd1 << (committed[2:0] + 3'd1);
    always_comb begin
        assume (!take || beat[7] && !full);
        assume (!begins || committed != begun && !runs && !halted);
    end

    // ---- The behaviour of an axis in its time slot, as docs/clock-by-clock.md specifies it.

    reg runs = 0, unfit = 0, known = 0, known_back = 0;
    wire on = (runs | begins) & !halted;
    wire fine = on & !unfit & !least;
    wire mark = marks[begun_now[2:0]];
    wire over = ended & mark;
    wire follows = ended & !mark & waiting != 0;
    wire rests = ramp ? known & turned : over;
    wire [31:0] begun_then = begun_now + (fine & !ramp & follows);
    always @(posedge clock) begin
        if (mine && take && put_word == due) takes <= 1;
        if (mine && take && commit) adds <= 1;
        if (mine && take) begin
            marks <= last ? marks | place : marks & ~place;
        end
        if (ends) begin
            begun <= clear ? 0 : empties ? committed : begun_then;
            committed <= clear ? 0 : committed + adds;
            due <= clear ? 0 : due + takes;
            {adds, takes} <= 0;
            runs <= fine & !rests;
            unfit <= fine & !rests & !ramp & !follows & overflow;
            known <= fine & !rests & ramp;
            if (!(ramp & known)) known_back <= back;
        end
    end

    // ---- The position on the pins (`at`) and the discarded steps (`given_up`) of `who`, and the
    // values that have been transferred to memory (`told` and `written_off`).

    reg [31:0] at = 0, told = 0, given_up = 0, written_off = 0;
    reg [1:0] spare = 3;
    reg [2:0] spare_losses = 7;
    wire [31:0] told_then = up ? told + 1 : down ? told - 1 : told;
    wire [31:0] written_off_then = written_off + lost;
    always_comb begin
        assume (!mine || !in_time_slot || {losses, pulses} == {given_up[2:0], at[2:0]});
        assume (!rises || spare != 0);
        assume (!discards || given_up - written_off != 7);
    end
    always @(posedge clock) begin
        at <= !rises ? at : rises_back ? at - 1 : at + 1;
        given_up <= given_up + discards;
        spare <= spare - rises + (samples & spare != 3);
        if (ends) {told, written_off} <= {told_then, written_off_then};
    end

    // ---- The carries of `who` since the last clear, counted from the position at that clear.

    reg [31:0] carried = 0;
    reg was_meets = 0;              // in the time slot before, the next words were to be those of a hit
    wire [31:0] step = !(fine & crosses) ? 0 : back ? -32'd1 : 32'd1;
    always @(posedge clock) begin
        if (ends) begin
            carried <= clear ? told_then : carried + step;
            was_meets <= meets;
        end
    end
    wire [31:0] ahead = carried - told;
    wire signed [31:0] behind = at - told;
    wire signed [31:0] behind_then = at - (asked ? told_then : told);

    // ---- The promises.

    always_comb begin
        promise_5_halted_runs_nothing: assert (!halted || !{running, sound, moves, goes_on, too_fast, dry});

        promise_6_words_in_order: assert (!was_mine || misplaced == was_wrong);
        promise_6_misplaced_is_taken: assert (!misplaced || was_take);
        promise_6_never_overtaken: assert (waiting <= 7 && committed - begun <= 7);
        promise_6_in_order: assert (!mine || !in_time_slot || live == begun_now[2:0] && fresh == committed[2:0] + 3'd1);
        promise_6_full: assert (!mine || beat[12:1] == 0 || full == (waiting == 7));
        promise_6_room: assert (!mine || !in_time_slot || room == 7 - waiting);
        promise_6_empty: assert (!mine || !in_time_slot || empty == (waiting == 0));
        promise_6_runs_as_told: assert (!mine || !in_time_slot || {running, moves, too_fast} == {on, fine, on & !fine});
        promise_6_goes_on: assert (!ends || goes_on == (fine & !rests));
        promise_6_discarded_are_written_off: assert (!asked || lost == (was_unseen && !on));
        promise_6_none_written_off_twice: assert (given_up - written_off <= 7);

        promise_7_never_far_behind: assert (!samples || behind >= -3 && behind <= 3);
        promise_7_told_as_pulsed: assert (!asked || {up, down} == {was_behind > 0, was_behind < 0});

        promise_10_dry_is_told: assert (!ends || dry == (fine & !ramp & ended & !mark & waiting == 0));
        promise_10_ramp_as_defined: assert (!mine || !in_time_slot || slows == (ramp & known) && steady == (ramp & !known)
            && (!slows || upward == known_back));

        promise_12_only_its_own_time_slot: assert (control == was_control || was_ends);
        promise_12_no_word_used_that_was_written: assert (!was_clash || !in_time_slot);
        promise_12_no_mark_read_as_it_is_written: assert (!mark_writes || mark_write_at != mark_read_at);

        promise_13_inactive: assert (!first_clock || {up, down, lost} == 0);

        promise_15_on_way: assert (!mine || !in_time_slot || on_way == ahead[3:0]);
        promise_15_met_in_the_tick_before: assert (!mine || !in_time_slot || met == was_meets);
    end

    reg was_unseen = 0, was_ends = 0, was_mine = 0, was_wrong = 0, was_take = 0;
    reg [23:0] was_control = 0;
    reg signed [31:0] was_behind = 0;
    always @(posedge clock) begin
        was_ends <= ends;
        {was_mine, was_wrong, was_take} <= {mine, take && put_word != due, take};
        was_control <= control;
        if (samples) begin
            was_unseen <= given_up != written_off;
            was_behind <= behind;
        end
    end

    // ---- The invariants that make the promises inductive. `sample` is an additional read port for
    // the words of `who` in memory.

    wire [23:0] control, present;    // of `who`, and of the axis of the time slot
    wire [7:0] lasts;
    memory_probe #("\\dut.control.words", 3, 24) at_present (1'b0, 1'b1, axis, present);
    memory_probe #("\\dut.control.words", 3, 24) at_control (1'b0, 1'b1, who, control);
    genvar slot;
    generate for (slot = 0; slot < 8; slot = slot + 1) begin : each
        memory_probe #("\\dut.lasts.words", 6, 1) at_lasts (1'b0, 1'b1, {who, slot[2:0]}, lasts[slot]);
    end endgenerate

    (* inside = "dut.word" *) wire [23:0] word;
    (* inside = "dut.took" *) wire dut_took;
    (* inside = "dut.filled" *) wire dut_filled;
    (* inside = "dut.fresh_now" *) wire [2:0] fresh_now;
    (* inside = "dut.live_now" *) wire [2:0] live_now;
    (* inside = "dut.control.write_bits" *) wire [23:0] write_bits;
    (* inside = "dut.control.write_address" *) wire [2:0] write_at;
    (* inside = "dut.control.read_address" *) wire [2:0] read_at;
    (* inside = "dut.lasts.write_bits" *) wire mark_writes;
    (* inside = "dut.lasts.write_address" *) wire [5:0] mark_write_at;
    (* inside = "dut.lasts.read_address" *) wire [5:0] mark_read_at;
    (* inside = "dut.lasts_read_data" *) wire mark_read;
    reg was_clash = 0;               // the word that was read was written in the same clock
    always @(posedge clock) was_clash <= write_bits != 0 & write_at == read_at;

    wire signed [31:0] slack = {30'd0, spare};

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (control[6:0] == {runs, committed[2:0], begun[2:0]});
        invariant_2: assert (control[7] == unfit && control[15:14] == {known, known_back});
        invariant_12: assert (control[18:16] == due);
        invariant_15: assert (!in_time_slot || word == present);
        invariant_16: assert (beat[12:1] == 0 || dut_filled == (fresh_now == live_now));
        invariant_14: assert (control[23:20] == ahead[3:0] && control[19] == was_meets);
        invariant_13: assert ((mine && beat[12:1] != 0 ? dut_took == takes : !takes) && (!takes || beat[12:8] != 0));
        invariant_3: assert (control[13:8] == {written_off[2:0], told[2:0]});
        invariant_4: assert (!mine || first_clock || was_ends || word == control);
        invariant_11: assert (!was_ends || first_clock || was_beat[12] && was_axis == who);
        invariant_5: assert (lasts == marks);
        invariant_6: assert (!mine || beat[12:1] == 0 || mark_read == lasts[begun_now[2:0]]);
        invariant_7: assert (adds == (takes && due == 7));
        invariant_8: assert (behind_then <= 3 - slack && behind_then >= slack - 3);
        invariant_9: assert (!adds || waiting < 7);
        invariant_10: assert (!asked || !was_unseen || given_up != written_off);
    end
`endif

    // ---- When the solver searches for a run (covers and planted bugs), `who` is axis 0, and its
    // time slots follow one another as fast as the assumptions permit.

`ifndef INVARIANTS
    reg [3:0] clock_of_time_slot = 14;
    always @(posedge clock) clock_of_time_slot <= clock_of_time_slot >= 13 ? 0 : clock_of_time_slot + 1;
    always_comb begin
        assume (who == 0 && beat == (clock_of_time_slot < 13 ? 17'd1 << clock_of_time_slot : 0));
        assume (axis == (clock_of_time_slot == 13));
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_6_last_is_over: cover (ends && over && fine);
        cover_6_one_begun_one_waits: cover (begun == 1 && committed == 2);
        cover_7_two_behind: cover (behind == 2 && told == 1);
        cover_10_dry: cover (dry && ends);
        cover_15_two_on_way: cover (mine && in_time_slot && on_way == 2);
        cover_15_one_back_on_way: cover (mine && in_time_slot && on_way == 15);
    end
endmodule

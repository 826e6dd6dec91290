// Proves promises 5, 6, 10, 12, 15 and 18 of the queue, without a bound on time: which segment
// runs, which segments wait, and that the control word keeps the step counts.
//
//   parameters   `DUT: the name of the exported queue
//   assumptions  The beats of a time slot follow one another and belong to one axis (proved in
//                time_slot/promises.sv). The inputs for starts and stops do not change within a time
//                slot; a word is taken only in beat 7 and if there is room; an axis starts only if
//                a segment waits. A slot is named only in beat 12, and not while a
//                cut is examined; a queue is emptied only where its axis does not run on
//                (engine/promises.sv). A cut follows the time slot that has examined
//                it and has missed nothing (cut_control/promises.sv).
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
    input wire [3:0] put_word,
    input wire [4:0] put_slot,
    input wire checks,
    input wire cuts,
    input wire closes,
    input wire last,
    input wire ended,
    input wire overflow,
    input wire least,
    input wire turned,
    input wire back,
    input wire meets,
    input wire [6:0] next_counts
);
    (* anyconst *) reg [2:0] who;

    wire [4:0] live, fresh, room;
    wire misses;
    wire misplaced, full, empty, running, sound, slows, upward, steady, moves, goes_on, too_fast, dry, met, advances;
    wire [6:0] counts;
    `DUT dut (.*);

    // ---- The beats of a time slot, and the inputs that do not change within it.

    wire mine = axis == who;
    wire in_time_slot = beat[12:0] != 0;
    wire ends = mine & beat[12];
    reg first_clock = 1, was_running = 0;
    reg [12:0] was_beat = 0;
    reg [2:0] was_next = 0, was_axis = 0;
    reg was_starts = 0, was_halted = 0, was_ramp = 0, was_clear = 0, was_checks = 0, was_cuts = 0, was_closes = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_beat, was_next, was_axis} <= {beat[12:0], axis_next, axis};
        {was_starts, was_halted, was_ramp, was_clear} <= {starts, halted, ramp, clear};
        {was_checks, was_cuts, was_closes} <= {checks, cuts, closes};
    end
    always_comb begin
        assume ((beat[12:0] & (beat[12:0] - 1)) == 0 && beat[12:1] == was_beat[11:0]);
        assume (first_clock ? axis == 0 && !in_time_slot : axis == was_next);
        assume (beat[11:0] == 0 || axis_next == axis);
        assume (!was_beat[12] || axis != was_axis || !in_time_slot);
        assume (was_beat[11:0] == 0 || {starts, halted, ramp, clear} == {was_starts, was_halted, was_ramp, was_clear});
        assume (was_beat[11:0] == 0 || {checks, cuts, closes} == {was_checks, was_cuts, was_closes});
        assume (!clear || halted);
        assume (!cuts || closes && !checks);
        assume (!(beat[12] && empties && goes_on));
    end

    // ---- The numbers of segments of `who` that have been committed and begun, and for each of the
    // eight places of the queue the mark `last of its move`.

    reg [31:0] committed = 0, begun = 0;
    reg [7:0] marks = 0;
    reg adds = 0;                    // a segment has been committed in this time slot
    reg takes = 0;                   // a word has been taken in this time slot
    reg [2:0] due = 0;               // the number of the word that must come next
    wire names = take & put_word[3];
    wire commit = put_word == {1'b0, due} && due == 7;
    wire begins = mine & in_time_slot & starts;
    wire [31:0] begun_now = begun + begins;
    // A cut: the named segment is as far behind the one that has begun last as its slot is.
    reg [2:0] target = 0;
    reg named = 0, passed = 0;       // the last time slot has examined the named segment and kept it
    wire is_cut = mine & in_time_slot & cuts & named;
    wire [2:0] distance = target - begun[2:0];
    wire [2:0] distance_now = target - begun_now[2:0];
    wire [31:0] committed_now = is_cut ? begun + distance : committed;
    wire [31:0] waiting = committed_now - begun_now;
    wire [7:0] place = 8'd1 << (committed_now[2:0] + 3'd1);
    always_comb begin
        assume (!take || (put_word[3] ? beat[12] && !checks : beat[7] && !full));
        assume (!(mine && in_time_slot && cuts) || passed);
        assume (!begins || committed_now != begun && !runs && !halted);
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
        if (mine && take && put_word == {1'b0, due}) takes <= 1;
        if (mine && take && commit) adds <= 1;
        if (mine && take && !put_word[3]) begin
            marks <= last ? marks | place : marks & ~place;
        end
        if (ends) begin
            begun <= clear ? 0 : empties ? committed_now : begun_then;
            committed <= clear ? 0 : committed_now + adds;
            if (names) target <= put_slot[2:0];
            named <= names | named & !closes & !clear;
            passed <= checks & !misses;
            due <= clear ? 0 : due + takes;
            {adds, takes} <= 0;
            runs <= fine & !rests;
            unfit <= fine & !rests & !ramp & !follows & overflow;
            known <= fine & !rests & ramp;
            if (!(ramp & known)) known_back <= back;
        end
    end

    // ---- What the time slot before has left for this one.

    reg was_meets = 0;              // the next words were to be those of a hit
    reg [6:0] kept = 0;             // the step counts
    always @(posedge clock) if (ends) {was_meets, kept} <= {meets, next_counts};

    // ---- The promises.

    always_comb begin
        promise_5_halted_runs_nothing: assert (!halted || !{running, sound, moves, goes_on, too_fast, dry});

        promise_6_words_in_order: assert (!was_mine || misplaced == was_wrong);
        promise_6_misplaced_is_taken: assert (!misplaced || was_take);
        promise_6_never_overtaken: assert (waiting <= 7 && committed - begun <= 7);
        promise_6_in_order: assert (!mine || !in_time_slot || live == begun_now[2:0] && fresh == {2'd0, committed_now[2:0] + 3'd1});
        promise_6_full: assert (!mine || beat[12:1] == 0 || full == (waiting == 7));
        promise_6_room: assert (!mine || beat[12:1] == 0 || room == 7 - waiting);
        promise_6_empty: assert (!mine || !in_time_slot || empty == (waiting == 0));
        promise_6_runs_as_told: assert (!mine || !in_time_slot || {running, moves, too_fast} == {on, fine, on & !fine});
        promise_6_the_next_begins: assert (!ends || advances == (fine & !ramp & follows));
        promise_6_goes_on: assert (!ends || goes_on == (fine & !rests));

        promise_10_dry_is_told: assert (!ends || dry == (fine & !ramp & ended & !mark & waiting == 0));
        promise_10_ramp_as_defined: assert (!mine || !in_time_slot || slows == (ramp & known) && steady == (ramp & !known)
            && (!slows || upward == known_back));

        promise_12_only_its_own_time_slot: assert (control == was_control || was_ends);
        promise_12_no_word_used_that_was_written: assert (!was_clash || !in_time_slot);
        promise_12_no_mark_read_as_it_is_written: assert (!mark_writes || mark_write_at != mark_read_at);

        promise_15_counts_are_kept: assert (!mine || !in_time_slot || counts == kept);
        promise_15_met_in_the_tick_before: assert (!mine || !in_time_slot || met == was_meets);
    end

    // The named segment waits and goes on waiting or begins, or it runs and goes on.
    wire waits = distance_now != 0 && distance_now <= waiting && !empties && !clear;
    wire stays = distance_now == 0 && fine && !rests && !(!ramp && follows);
    wire [2:0] due_then = clear ? 3'd0 : due + takes;
    always_comb begin
        promise_18_refused_unless_kept: assert (!ends || misses == (checks & named & !((waits | stays) & due_then == 0)));
        promise_18_drops_from_the_end: assert (!is_cut || distance <= committed - begun && (distance != 0 || runs));
        promise_18_room_behind_the_named: assert (!is_cut || fresh == {2'd0, target + 3'd1});
    end

    reg was_ends = 0, was_mine = 0, was_wrong = 0, was_take = 0;
    reg [30:0] was_control = 0;
    always @(posedge clock) begin
        was_ends <= ends;
        {was_mine, was_wrong, was_take} <= {mine, take && !put_word[3] && put_word[2:0] != due, take};
        was_control <= control;
    end

    // ---- The invariants that make the promises inductive. `sample` is an additional read port for
    // the words of `who` in memory.

    wire [30:0] control, present;    // of `who`, and of the axis of the time slot
    wire [7:0] lasts;
    memory_probe #("\\dut.control.words", 3, 31) at_present (1'b0, 1'b1, axis, present);
    memory_probe #("\\dut.control.words", 3, 31) at_control (1'b0, 1'b1, who, control);
    genvar slot;
    generate for (slot = 0; slot < 8; slot = slot + 1) begin : each
        memory_probe #("\\dut.lasts.words", 6, 1) at_lasts (1'b0, 1'b1, {slot[2:0], who}, lasts[slot]);
    end endgenerate

    (* inside = "dut.word" *) wire [30:0] word;
    (* inside = "dut.took" *) wire dut_took;
    (* inside = "dut.spare" *) wire [4:0] dut_spare;
    (* inside = "dut.fresh_now" *) wire [4:0] fresh_now;
    (* inside = "dut.live_now" *) wire [4:0] live_now;
    (* inside = "dut.control.write_bits" *) wire [30:0] write_bits;
    (* inside = "dut.control.write_address" *) wire [2:0] write_at;
    (* inside = "dut.control.read_address" *) wire [2:0] read_at;
    (* inside = "dut.lasts.write_bits" *) wire mark_writes;
    (* inside = "dut.lasts.write_address" *) wire [7:0] mark_write_at;
    (* inside = "dut.lasts.read_address" *) wire [7:0] mark_read_at;
    (* inside = "dut.lasts_read_data" *) wire mark_read;
    reg was_clash = 0;               // the word that was read was written in the same clock
    always @(posedge clock) was_clash <= write_bits != 0 & write_at == read_at;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (control[10:0] == {runs, 2'd0, committed[2:0], 2'd0, begun[2:0]});
        invariant_2: assert (control[11] == unfit && control[13:12] == {known, known_back});
        invariant_12: assert (control[16:14] == due);
        invariant_3: assert (control[30:25] == {named, 2'd0, target});
        invariant_8: assert (!(passed && named) || distance <= committed - begun && (distance != 0 || runs));
        invariant_15: assert (!in_time_slot || word == present);
        invariant_16: assert (beat[12:1] == 0 || dut_spare == {2'd0, live_now[2:0] - fresh_now[2:0]});
        invariant_14: assert (control[24:17] == {kept, was_meets});
        invariant_13: assert ((mine && beat[12:1] != 0 ? dut_took == takes : !takes) && (!takes || beat[12:8] != 0));
        invariant_4: assert (!mine || first_clock || was_ends || word == control);
        invariant_11: assert (!was_ends || first_clock || was_beat[12] && was_axis == who);
        invariant_5: assert (lasts == marks);
        invariant_6: assert (!mine || beat[12:1] == 0 || mark_read == lasts[begun_now[2:0]]);
        invariant_7: assert (adds == (takes && due == 7));
        invariant_9: assert (!adds || waiting < 7);
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
        cover_18_cut: cover (is_cut && distance < committed - begun && distance != 0);
        cover_18_cut_behind_the_running_one: cover (is_cut && distance == 0 && committed != begun);
        cover_18_refused: cover (ends && misses && due == 0);
        cover_10_dry: cover (dry && ends);
    end
endmodule

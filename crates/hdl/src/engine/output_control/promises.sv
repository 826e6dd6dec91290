// Proves promises 13 and 17 of the outputs, without a bound on time: an output changes only where a
// segment that says so begins, or where all are turned off.
//
//   parameters   EXIST: the outputs that the build has; HAS_PWM: 1 if it has a PWM
//                `DUT: the name of the exported module `output_control`, built with these values
//   assumptions  The beats of a time slot follow one another (proved in time_slot/promises.sv). A
//                word of a segment is taken only in beat 7 of the time slot of its axis
//                (engine/promises.sv).
//
// This file reads the commit of a segment at the end of the time slot of its first tick; the module
// reads it later.

module promises (
    input wire clock,
    input wire [16:0] beat,
    input wire first,
    input wire take,
    input wire [3:0] put_word,
    input wire [31:0] put_data,
    input wire [4:0] fresh,
    input wire [4:0] live,
    input wire starts,
    input wire follows,
    input wire off
);
    localparam [7:0] EXIST = `EXIST;
    localparam HAS_PWM = `HAS_PWM;
    localparam [31:0] HAS = {HAS_PWM ? 12'hfff : 12'd0, EXIST, EXIST, 2'd0, HAS_PWM ? 1'b1 : 1'b0, 1'b0};

    wire [7:0] pins;
    wire [11:0] duty;
    wire sets_duty, stray;
    `DUT dut (.*);

    // ---- The time slots of axis 0: their first beat is the first clock of a tick.

    wire begins = first & beat[0];
    wire ends = first & beat[12];
    reg first_clock = 1, before_all = 1, between = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        if (begins) before_all <= 0;
        between <= ends | between & !begins;
    end
    always_comb begin
        assume ((beat[12:0] & (beat[12:0] - 1)) == 0);
        assume (!take || beat[7] || put_word[3]);
        assume (!begins || before_all || between);
        assume (!(first & (beat[7] | beat[12])) || !before_all && !between);
    end

    // ---- The commits of axis 0, as docs/clock-by-clock.md specifies them: those that are in their
    // slots, that of the segment that runs in this tick, and that which changes outputs next.

    wire commit = take && put_word == 7;
    reg [255:0] kept = 0;
    reg [31:0] now = 0, next = 0;
    reg follower = 0, has_begun = 0, due = 0;
    wire [31:0] of_live = kept[{live[2:0], 5'd0} +: 32];
    always @(posedge clock) begin
        if (commit & first) kept[{fresh[2:0], 5'd0} +: 32] <= put_data & 32'hfffffff2;
        if (ends) begin
            now <= of_live;
            has_begun <= starts | follower;
            follower <= follows;
        end
        if (begins) {next, due} <= {now, has_begun};
    end
    wire [7:0] mask = next[11:4] & EXIST;
    wire [7:0] levels = next[19:12];

    // ---- The promises.

    always_comb begin
        promise_13_inactive: assert (!first_clock || {pins, sets_duty, stray} == 0);

        promise_17_only_where_named: assert (((pins ^ was_pins) & ~was_changing) == 0);
        promise_17_levels_of_the_commit: assert (was_off || (pins & was_changing) == (was_levels & was_changing));
        promise_17_off: assert (!was_off || pins == 0);
        promise_17_what_the_build_has: assert ((pins & ~EXIST) == 0 && (HAS_PWM || !sets_duty));
        promise_17_duty_of_the_commit: assert (sets_duty == (due & next[1] & HAS_PWM) && (!sets_duty || duty == next[31:20]));
        promise_17_others_are_refused: assert (stray == (was_commit & (HAS != 0)
            & ((was_data & ~(was_first ? HAS | 32'd1 : 32'd1)) != 0)));
    end

    reg was_off = 0, was_commit = 0, was_first = 0;
    reg [7:0] was_pins = 0, was_changing = 0, was_levels = 0;
    reg [31:0] was_data = 0;
    always @(posedge clock) begin
        {was_off, was_commit, was_first, was_data} <= {off, commit, first, put_data};
        {was_pins, was_levels} <= {pins, levels};
        was_changing <= off ? 8'hff : begins & due ? mask : 8'd0;
    end

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.place" *) wire [4:0] place;
    (* inside = "dut.begun" *) wire dut_begun;
    (* inside = "dut.due" *) wire dut_due;
    (* inside = "dut.follower" *) wire dut_follower;
    (* inside = "dut.output_words_read_data" *) wire [15:0] output_word;
    (* inside = "dut.duty_words_read_data" *) wire [12:0] duty_word;
    wire [127:0] output_words;
    wire [103:0] duty_words;
    genvar slot;
    generate for (slot = 0; slot < 8; slot = slot + 1) begin : each
        memory_probe #("\\dut.output_words.words", 3, 16) at_outputs (1'b0, 1'b1, slot[2:0], output_words[16 * slot +: 16]);
        memory_probe #("\\dut.duty_words.words", 3, 13) at_duties (1'b0, 1'b1, slot[2:0], duty_words[13 * slot +: 13]);
    end endgenerate
    reg is_kept;
    integer i;
    always_comb begin
        is_kept = 1;
        for (i = 0; i < 8; i = i + 1)
            is_kept = is_kept && output_words[16 * i +: 16] == kept[32 * i + 4 +: 16]
                && duty_words[13 * i +: 13] == {kept[32 * i + 1], kept[32 * i + 20 +: 12]};
    end

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (is_kept || HAS == 0);
        invariant_2: assert ({dut_begun, dut_due, dut_follower} == {has_begun, due, follower} || HAS == 0);
        invariant_3: assert (before_all || HAS == 0 || output_word == next[19:4] && duty_word == {next[1], next[31:20]});
        invariant_4: assert (!between || now == kept[{place[2:0], 5'd0} +: 32]);
        invariant_5: assert (!before_all || {now, next, kept, has_begun, due, follower, place, between} == 0);
        invariant_6: assert ((pins & ~EXIST) == 0);
    end
`endif

    // ---- When the solver searches for a run, the time slots follow one another.

`ifndef INVARIANTS
    reg [3:0] clock_of_tick = 14;
    always @(posedge clock) clock_of_tick <= clock_of_tick >= 14 ? 0 : clock_of_tick + 1;
    always_comb assume (beat == (clock_of_tick < 13 ? 17'd1 << clock_of_tick : 0) && (first || take));
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_17_switched: cover (pins == 8'h05 && was_pins == 8'h01);
        cover_17_two_in_sequence: cover (begins && due && has_begun && mask != 0 && now[11:4] != 0);
        cover_17_duty: cover (sets_duty && duty == 12'h800);
        cover_17_off: cover (off && pins != 0);
    end
endmodule

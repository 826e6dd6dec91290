// Proves promises 13 and 15 of the readout, without a bound on time: which word of which page is
// output in each beat, and in which tick a snapshot is taken.
//
//   parameters   `DUT: the name of the exported module `readout`
//   assumptions  There is no beat 0 to 12 at a strobe, at most one of them in a clock, and a tick
//   has
//                a time slot of the last axis (proved in time_slot/promises.sv). A source is hit in beat
//                12 (proved in seek_control/promises.sv). `met` is asserted in the time slot of an
//                axis in the tick after `meets` was, and in no other (proved in queue/promises.sv).
//                `latches` follows `comes` at a strobe, or is 0 (proved in edge_latch/promises.sv).

module promises (
    input wire clock,
    input wire strobe,
    input wire [16:0] beat,
    input wire is_last,
    input wire snapshot,
    input wire caught,
    input wire met,
    input wire sweeps,
    input wire comes,
    input wire latches,
    input wire samples,
    input wire [1:0] row,
    input wire earlier,
    input wire level,
    input wire resetting,
    input wire [31:0] word,
    input wire [4:0] live,
    input wire running,
    input wire [4:0] room,
    input wire [3:0] on_way
);
    wire valid, refreshed, meets;
    wire [1:0] page;
    wire [2:0] item;
    wire [31:0] state;
    `DUT dut (.*);

    // ---- Snapshots, as docs/clock-by-clock.md specifies them.

    reg first_clock = 1, asked = 0, takes = 0;
    reg finds = 0;                   // in this tick an axis was to be output for a hit in the next one
    reg found = 0;                   // in the tick before
    reg all = 0;                     // all axes are to be output for the hit of their common source
    wire again = caught | met & latches;
    wire all_again = sweeps | all & latches;
    wire taken = finds | all_again | comes;
    always @(posedge clock) begin
        first_clock <= 0;
        asked <= snapshot | (strobe ? asked & taken : asked);
        if (strobe) takes <= asked & !taken;
        if (strobe) found <= finds;
        if (strobe) all <= all_again;
        finds <= strobe ? 0 : finds | again & beat[12];
    end
    reg latched = 0;                 // `comes` at the strobe before
    always @(posedge clock) if (strobe) latched <= comes;
    always_comb begin
        assume ((beat[12:0] & (beat[12:0] - 1)) == 0 && (!strobe || beat[12:0] == 0));
        assume (!caught || beat[12]);
        assume (!met || found);
        assume (!latches || latched);
    end

    // ---- The page of a whole tick: it may be another one only for an axis at its hit.

    wire captured = met | all;
    wire of_switch = beat[7] & samples & !resetting;
    wire [1:0] page_now = latches ? 3 : captured ? 0 : takes ? 2 : 1;

    // The words of this tick that were output so far: some belong to a snapshot, some do not.

    reg some_of_snapshot = 0, some_others = 0;
    always @(posedge clock) begin
        some_of_snapshot <= !strobe & (some_of_snapshot | valid & !of_switch & page == 2);
        some_others <= !strobe & (some_others | valid & !of_switch & page != 2);
    end

    // ---- The promises.

    always_comb begin
        promise_15_one_page_in_a_tick: assert (!valid || page == (of_switch ? row : page_now));
        promise_15_a_snapshot_is_of_all_axes: assert (!(some_of_snapshot && some_others));
        promise_15_a_hit_waits_for_the_latch: assert (meets == again && (!(strobe && all && latches) || taken));
        promise_15_each_word_once: assert (valid == (beat[4] | (beat[5] & page_now != 0) | beat[6] | of_switch | beat[10] | beat[11]
            | beat[12]));
        promise_15_items: assert (!valid || item == (beat[4] ? 4 : beat[5] ? {2'b00, running} : beat[6] ? 6 : beat[7] ? 2
            : beat[10] ? 5 : beat[11] ? 3 : 7));
        promise_15_words_as_the_memory_has_them: assert (!valid || beat[12] || beat[7] || state == word);
        promise_15_switches: assert (!valid || !beat[7] || state[7:6] == {earlier, level});
        promise_15_status: assert (!beat[12] || live > 7 || room > 7 || state[15:0] == {on_way, 1'b0, 5'd7 - room, running, live});
        promise_15_refreshed: assert (refreshed == (beat[12] && is_last && page_now == 1));
        promise_13_inactive: assert (!first_clock || !valid || of_switch || page == 1);
    end

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.asked" *) wire dut_asked;
    (* inside = "dut.takes" *) wire dut_takes;
    (* inside = "dut.found" *) wire dut_found;
    (* inside = "dut.swept" *) wire dut_swept;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (dut_asked == asked && dut_takes == takes && dut_found == finds && dut_swept == all);
        invariant_2: assert (!(takes && (found || all || latched)));
        invariant_3: assert ((!some_of_snapshot || takes) && (!some_others || !takes));
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_15_snapshot: cover (takes && refreshed == 0 && beat[12]);
        cover_15_waits_for_a_hit: cover (asked && found && beat[4] && met);
        cover_15_hit_behind_the_latch: cover (valid && page == 0 && all && !latched && !beat[7]);
        cover_15_two_in_a_row: cover (takes && asked && strobe);
    end
endmodule

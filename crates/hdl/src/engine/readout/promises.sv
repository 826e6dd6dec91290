// Proves promises 13 and 15 of the readout, without a bound on time: which word of which page is
// output in each beat, and in which tick a snapshot is taken.
//
//   parameters   `DUT: the name of the exported module `readout`
//   assumptions  There is no beat 0 to 12 at a strobe, at most one of them in a clock, and a tick has
//                a time slot of the last axis (proved in time_slot/promises.sv). A limit is found in
//                beat 12 (proved in limits/promises.sv). In the tick after the one in which the limit
//                of an axis was found, `met` is asserted in its time slot, and in no other time slot
//                (proved in queue/promises.sv).

module promises (
    input wire clock,
    input wire strobe,
    input wire [16:0] beat,
    input wire is_last,
    input wire snapshot,
    input wire caught,
    input wire met,
    input wire [31:0] word,
    input wire [2:0] live,
    input wire running,
    input wire [2:0] room,
    input wire [3:0] on_way
);
    wire valid, refreshed;
    wire [1:0] page;
    wire [2:0] item;
    wire [31:0] state;
    `DUT dut (.*);

    // ---- Snapshots, as docs/clock-by-clock.md specifies them.

    reg first_clock = 1, asked = 0, takes = 0;
    reg finds = 0;                   // in this tick a limit was found
    reg found = 0;                   // in the tick before a limit was found
    always @(posedge clock) begin
        first_clock <= 0;
        asked <= snapshot | (strobe ? asked & finds : asked);
        if (strobe) takes <= asked & !finds;
        if (strobe) found <= finds;
        finds <= strobe ? 0 : finds | caught;
    end
    always_comb begin
        assume ((beat[12:0] & (beat[12:0] - 1)) == 0 && (!strobe || beat[12:0] == 0));
        assume (!caught || beat[12]);
        assume (!met || found);
    end

    // ---- The page of a whole tick: it may be another one only for an axis at its limit.

    reg [1:0] page_of_tick = 1;
    always @(posedge clock) if (strobe) page_of_tick <= asked & !finds ? 2 : 1;
    wire in_time_slot = beat[12:0] != 0;

    // ---- The promises.

    always_comb begin
        promise_15_one_page_in_a_tick: assert (!valid || page == (met ? 0 : page_of_tick));
        promise_15_a_snapshot_is_of_all_axes: assert (!(page == 2 && met));
        promise_15_each_word_once: assert (valid == (beat[4] | (beat[5] & !met) | beat[6] | beat[10] | beat[11] | beat[12]));
        promise_15_items: assert (!valid || item == (beat[4] ? 4 : beat[5] ? {2'b00, running} : beat[6] ? 6 : beat[10] ? 5
            : beat[11] ? 3 : 7));
        promise_15_words_as_the_memory_has_them: assert (!valid || beat[12] || state == word);
        promise_15_status: assert (!beat[12] || state[15:0] == {on_way, 3'b000, 3'd7 - room, running, 2'b00, live});
        promise_15_refreshed: assert (refreshed == (beat[12] && is_last && !takes));
        promise_13_inactive: assert (!first_clock || !(page == 2));
    end

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.asked" *) wire dut_asked;
    (* inside = "dut.takes" *) wire dut_takes;
    (* inside = "dut.found" *) wire dut_found;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (dut_asked == asked && dut_takes == takes && dut_found == finds);
        invariant_2: assert (page_of_tick == (takes ? 2 : 1) && !(takes && found));
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_15_snapshot: cover (takes && refreshed == 0 && beat[12]);
        cover_15_waits_for_a_limit: cover (asked && found && beat[4] && met);
        cover_15_two_in_a_row: cover (takes && asked && strobe);
    end
endmodule

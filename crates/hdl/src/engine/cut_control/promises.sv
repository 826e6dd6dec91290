// Proves promises 13 and 18 of the cut's stages, without a bound on time: a cut is executed by all
// axes in the tick after the one that has examined them all, or by none.
//
//   parameters   `DUT: the name of the exported module `cut_control`
//   assumptions  A strobe comes in no time slot (proved in engine/promises.sv). A reset begins with
//                a tick (resets/promises.sv).

module promises (
    input wire clock,
    input wire strobe,
    input wire [16:0] beat,
    input wire request,
    input wire misses,
    input wire resetting
);
    wire checks, cuts, closes, busy, refused;
    `DUT dut (.*);

    reg first_clock = 1, was_strobe = 0, was_resetting = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_strobe, was_resetting} <= {strobe, resetting};
    end
    always_comb begin
        assume (!strobe || beat[12:0] == 0);
        assume (resetting == was_resetting || was_strobe);
    end

    // ---- What docs/clock-by-clock.md specifies: the request, the tick that examines the axes, and
    // whether an axis of this tick has missed its segment.

    reg asked = 0, examines = 0, lacks = 0, denied = 0, decided = 0;
    always @(posedge clock) begin
        asked <= !resetting & (request | asked & !strobe);
        examines <= !resetting & (strobe ? asked : examines);
        lacks <= !strobe & (lacks | beat[12] & misses);
        decided <= strobe ? examines : decided;
        denied <= strobe & resetting ? 0 : strobe & examines ? lacks : denied;
    end

    // ---- The promises.

    always_comb begin
        promise_13_inactive: assert (!first_clock || {checks, cuts, closes, busy, refused} == 0);
        promise_13_reset_forgets: assert (!was_resetting || !busy);

        promise_18_all_or_none: assert (cuts == (decided & !denied));
        promise_18_only_after_a_request: assert (checks == examines && busy == (asked | examines) && closes == decided);
        promise_18_one_tick: assert (first_clock || was_strobe || cuts == was_cuts);
        promise_18_refused_is_told: assert (refused == denied);
    end

    reg was_cuts = 0;
    always @(posedge clock) was_cuts <= cuts;

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.asked" *) wire dut_asked;
    (* inside = "dut.missed" *) wire missed;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (dut_asked == asked && missed == lacks);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_18_cut: cover (cuts);
        cover_18_refused: cover (refused && closes);
        cover_18_one_after_the_other: cover (cuts && checks);
    end
endmodule

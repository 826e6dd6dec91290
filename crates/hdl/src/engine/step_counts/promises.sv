// Proves promises 6, 7, 13 and 15 of the step counts, without a bound on time: how pulses and
// discarded steps reach the counters in memory, and how many steps are on their way.
//
//   parameters   `DUT: the name of the exported module `step_counts`
//   assumptions  The beats of a time slot follow one another and belong to one axis (proved in
//                time_slot/promises.sv). Whether the axis runs does not change within a time slot
//                (proved in engine/promises.sv). What is kept for the next time slot of an axis
//                comes back in it (proved in queue/promises.sv). In beat 6 the memory returns the
//                position, to which `up` and `down` have been added (adder/promises.sv). In any time
//                there are at most three pulses more than time slots, and at most seven discarded
//                steps are not counted in memory yet (docs/promises.md gives the reasons).
//
// All statements are about one axis, `who`; the solver may choose any.

module promises (
    input wire clock,
    input wire [16:0] beat,
    input wire [2:0] axis,
    input wire running,
    input wire moves,
    input wire crosses,
    input wire back,
    input wire clear,
    input wire [2:0] pulses,
    input wire [2:0] losses,
    input wire [2:0] word,
    input wire [6:0] counts,
    input wire rises,        // a pulse of `who` in this clock
    input wire rises_back,
    input wire discards      // one of its steps is discarded
);
    (* anyconst *) reg [2:0] who;

    wire [6:0] next_counts;
    wire [3:0] on_way;
    wire up, down, lost;
    `DUT dut (.*);

    // ---- The beats of a time slot, and what does not change within it.

    wire mine = axis == who;
    wire in_time_slot = beat[12:0] != 0;
    wire sees_loss = mine & beat[4];       // the discarded steps are compared
    wire counts_loss = mine & beat[12:5] != 0;
    wire sees = mine & beat[6];            // the positions are compared
    wire ends = mine & beat[12];
    reg first_clock = 1, was_running = 0;
    reg [12:0] was_beat = 0;
    reg [2:0] was_axis = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_beat, was_axis, was_running} <= {beat[12:0], axis, running};
    end
    always_comb begin
        assume ((beat[12:0] & (beat[12:0] - 1)) == 0 && beat[12:1] == was_beat[11:0]);
        assume (!first_clock || !in_time_slot);
        assume (was_beat[11:0] == 0 || axis == was_axis && running == was_running);
        assume (!was_beat[12] || axis != was_axis || !in_time_slot);
    end

    // ---- The position on the pins (`at`) and the discarded steps (`given_up`) of `who`, and the
    // values that have been transferred to memory (`told` and `written_off`).

    reg [31:0] at = 0, told = 0, given_up = 0, written_off = 0;
    reg [6:0] kept = 0;
    reg [1:0] spare = 3;
    reg added = 0, subtracted = 0;         // what beat 6 of this time slot has found
    wire [31:0] told_then = added ? told + 1 : subtracted ? told - 1 : told;
    wire [31:0] written_off_then = written_off + lost;
    always_comb begin
        assume (!mine || !in_time_slot || {losses, pulses} == {given_up[2:0], at[2:0]});
        assume (!mine || !in_time_slot || counts == kept);
        assume (!sees || word == told[2:0]);
        assume (!rises || spare != 0);
        assume (!discards || given_up - written_off != 7);
    end
    always @(posedge clock) begin
        at <= !rises ? at : rises_back ? at - 1 : at + 1;
        given_up <= given_up + discards;
        spare <= spare - rises + (sees & spare != 3);
        if (sees) {added, subtracted} <= {up, down};
        if (ends) begin
            {told, written_off} <= {told_then, written_off_then};
            {added, subtracted} <= 0;
            kept <= next_counts;
        end
    end

    // ---- The carries of `who` since the last clear, counted from the position at that clear.

    reg [31:0] carried = 0;
    wire [31:0] step = !(moves & crosses) ? 0 : back ? -32'd1 : 32'd1;
    always @(posedge clock) begin
        if (ends) carried <= clear ? told_then : carried + step;
    end
    wire [31:0] ahead = carried - told;
    wire signed [31:0] behind = at - told;
    wire signed [31:0] behind_then = at - told_then;

    // ---- The promises.

    always_comb begin
        promise_6_discarded_are_written_off: assert (!counts_loss || lost == (was_unseen && !running));
        promise_6_none_written_off_twice: assert (given_up - written_off <= 7);

        promise_7_never_far_behind: assert (!sees || behind >= -3 && behind <= 3);
        promise_7_told_as_pulsed: assert (!sees || {up, down} == {behind > 0, behind < 0});

        promise_13_inactive: assert (!first_clock || lost == 0);

        promise_15_on_way: assert (!mine || !in_time_slot || on_way == ahead[3:0]);
    end

    reg was_unseen = 0;
    always @(posedge clock) if (sees_loss) was_unseen <= given_up != written_off;

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.forward" *) wire forward;
    (* inside = "dut.backward" *) wire backward;
    wire signed [31:0] slack = {30'd0, spare};

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (kept == {ahead[3:0], written_off[2:0]});
        invariant_2: assert (!(added | subtracted) || mine && beat[12:7] != 0);
        invariant_3: assert (!(mine && beat[12:7] != 0) || {forward, backward} == {added, subtracted});
        invariant_4: assert (behind_then <= 3 - slack && behind_then >= slack - 3);
        invariant_5: assert (!counts_loss || !was_unseen || given_up != written_off);
        invariant_6: assert (!(added & subtracted));
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
        cover_7_two_behind: cover (behind == 2 && told == 1);
        cover_15_two_on_way: cover (mine && in_time_slot && on_way == 2);
        cover_15_one_back_on_way: cover (mine && in_time_slot && on_way == 15);
    end
endmodule

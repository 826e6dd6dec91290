// Proves promises 5, 12 and 13 of the module that brings the causes of a time slot's axes to the
// stop control, without a bound on time: none is lost, and the axis with the lowest number is told.
//
//   parameters   AXES: number of axes
//                LANES: number of adders
//                `DUT: the name of the exported module `findings`
//   assumptions  Two time slots do not end within three clocks, and the axes of a time slot are
//                those of the lanes, the first of them a multiple of LANES (proved in
//                ../lane_slots/promises.sv).

module promises (
    input wire clock,
    input wire time_slot_ends,
    input wire [2:0] axis,   // the axis of lane 0
    input wire runs,
    input wire [`LANES-1:0] too_fast,
    input wire [`LANES-1:0] limit,
    input wire [`LANES-1:0] dry
);
    // Four bits wide, because a remainder of 32 bits takes yosys some seconds.
    localparam [3:0] AXES = `AXES, LANES = `LANES;
    wire [`AXES-1:0] axis_one_hot = 32'd1 << axis;
    wire tells, some_run, is_too_fast, is_limit, is_dry;
    wire [`AXES-1:0] culprit;
    `DUT dut (.*);

    // ---- What the last time slot has found, and the clocks since it ended: 0 is three or more.

    reg first_clock = 1;
    reg [1:0] since = 0;
    reg [`LANES-1:0] fast = 0, limits = 0, dries = 0;
    reg [2:0] first = 0;
    reg ran = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        since <= time_slot_ends ? 1 : since == 0 || since == 2 ? 0 : since + 1;
        if (time_slot_ends) {fast, limits, dries, first, ran} <= {too_fast, limit, dry, axis, runs};
    end
    always_comb begin
        assume (axis % LANES == 0 && axis + LANES <= AXES);
        assume (!time_slot_ends || since == 0);
    end

    // ---- The lowest lane that has found a cause.

    reg [3:0] lowest;
    integer lane;
    always_comb begin
        lowest = `LANES;
        for (lane = `LANES - 1; lane >= 0; lane = lane - 1)
            if (fast[lane] | limits[lane] | dries[lane]) lowest = lane;
    end
    wire found = lowest < `LANES;
    wire [2:0] its_causes = {fast[lowest], limits[lowest], dries[lowest]};
    wire [2:0] causes = {is_too_fast, is_limit, is_dry};

    // ---- The promises. A limit may freeze the axes and an excessive V always does: both are told
    // of any axis. A queue that is dry calls for a ramp, for which any cause does.

    always_comb begin
        promise_12_told_in_two_clocks: assert (tells == (since != 0));
        promise_12_no_cause_is_lost: assert (since != 1 || found == (causes != 0));
        promise_12_nothing_is_told_between: assert (tells || causes == 0);
        promise_12_cause_of_the_lowest_axis: assert (since != 1 || !found || causes == its_causes);
        promise_12_culprit_is_the_lowest_axis: assert (since == 0 || culprit == (found ? 32'd1 << (first + lowest) : 0));
        promise_12_told_whether_an_axis_runs: assert (since == 0 || some_run == ran);
        promise_5_freezing_cause_of_any_axis: assert (since != 2 || causes == {fast != 0, limits != 0, 1'b0});
        promise_13_inactive: assert (!first_clock || !tells && causes == 0 && culprit == 0);
    end

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.ended" *) wire ended;
    (* inside = "dut.again" *) wire again;
    (* inside = "dut.slot" *) wire [`AXES-1:0] slot;
    (* inside = "dut.ran" *) wire dut_ran;
    (* inside = "dut.fast" *) wire [`LANES-1:0] dut_fast;
    (* inside = "dut.limits" *) wire [`LANES-1:0] dut_limits;
    (* inside = "dut.dries" *) wire [`LANES-1:0] dut_dries;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert ({ended, again} == {since == 1, since == 2} && since != 3);
        invariant_2: assert ({dut_fast, dut_limits, dut_dries, dut_ran} == {fast, limits, dries, ran});
        invariant_3: assert (since == 0 || slot == 32'd1 << first);
        invariant_4: assert (first % LANES == 0 && first + LANES <= AXES);
        invariant_5: assert (!first_clock || since == 0 && {fast, limits, dries} == 0);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_5_freezes_behind_one_that_does_not: cover (since == 2 && is_too_fast && its_causes == 3'b001);
        cover_12_highest_axis: cover (since == 1 && culprit[`AXES-1]);
        cover_12_nobody: cover (since == 1 && !found && some_run);
    end
endmodule

// Proves promises 12, 13 and 19 of the seek of an engine with several adders, without a bound on
// time: the hit of a source ramps the axes that wait for it, and no other, whichever lanes they
// belong to.
//
//   parameters   AXES: number of axes
//                LANES: number of adders
//                `DUT: the name of the exported module `lane_seek`
//   assumptions  The axes of a time slot are those of the lanes; two time slots do not end in
//                adjacent clocks; at a strobe no time slot ends, and the axes are the first ones
//                (proved in ../lane_slots/promises.sv).

module promises (
    input wire clock,
    input wire strobe,
    input wire set_source,
    input wire [6:0] source,
    input wire set,
    input wire [`AXES-1:0] mask,
    input wire time_slot_ends,
    input wire [2:0] axis,   // the axis of lane 0
    input wire [1:0] row,
    input wire samples,
    input wire [`LANES-1:0] state,
    input wire [`LANES-1:0] goes_on,
    input wire resetting
);
    wire [`AXES-1:0] axis_one_hot = 32'd1 << axis;
    wire [`AXES-1:0] seeking, hits;
    wire [`LANES-1:0] slows, forgives, caught;
    wire sweeps;
    `DUT dut (.*);

    reg first_clock = 1, was_time_slot_ends = 0, was_resetting = 0;
    reg [2:0] was_axis = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_time_slot_ends, was_axis, was_resetting} <= {time_slot_ends, axis, resetting};
    end
    wire [2:0] follower = was_axis == `AXES - `LANES ? 3'd0 : was_axis + `LANES;
    always_comb begin
        assume (axis == (first_clock ? 3'd0 : was_time_slot_ends ? follower : was_axis));
        assume (!time_slot_ends || !was_time_slot_ends && !first_clock);
        assume (!strobe || !time_slot_ends && axis == 0);
    end

    // ---- The seek as docs/clock-by-clock.md specifies it, with the bits of all axes side by side.

    wire [`LANES-1:0] all_lanes = ~0;
    wire [`AXES-1:0] of_time_slot = {24'd0, all_lanes} << axis;
    wire [`AXES-1:0] its_state = {24'd0, state} << axis, its_goes_on = {24'd0, goes_on} << axis;
    wire [`AXES-1:0] its_slows = {24'd0, slows} << axis;

    reg [`AXES-1:0] waiting = 0, slowing = 0;
    reg released = 0, swept = 0, own = 0, level = 0;
    reg [2:0] of_axis = 0;
    reg [1:0] of_row = 0;
    wire [`AXES-1:0] sources = row != of_row ? 0 : own ? of_time_slot : of_time_slot & 32'd1 << of_axis;
    wire [`AXES-1:0] hit = time_slot_ends & samples ? sources & (level ? its_state : ~its_state) : 0;
    wire [`AXES-1:0] meets = own ? hit & waiting : 0;
    wire all_meet = strobe & swept;
    wire [`AXES-1:0] rests = time_slot_ends & released ? its_slows & ~its_goes_on : 0;
    always @(posedge clock) begin
        if (set_source) {level, own, of_row, of_axis} <= source;
        waiting <= resetting ? 0 : set ? mask : all_meet ? 0 : waiting & ~meets;
        released <= !resetting & (set | released & !all_meet & meets == 0);
        swept <= !resetting & !strobe & (swept | hit != 0 & !own & waiting != 0);
        slowing <= resetting ? 0 : all_meet ? slowing | waiting : slowing & ~rests | meets;
    end

    // ---- Values of the clock before.

    reg [`AXES-1:0] was_hits = 0, was_seeking = 0, was_meets = 0, was_rests = 0;
    reg was_all_meet = 0, was_released = 0;
    always @(posedge clock) begin
        {was_hits, was_seeking, was_meets, was_rests} <= {hits, seeking, meets, rests};
        {was_all_meet, was_released} <= {all_meet, released};
    end
    wire [`AXES-1:0] new_hits = hits & ~was_hits;
    wire [`AXES-1:0] old_hits = was_hits & ~hits;
    wire [`AXES-1:0] its_meets = meets >> axis, its_hits = slowing >> axis;
    wire [`AXES-1:0] forgiven = (sources & (waiting | slowing)) >> axis;

    // ---- The promises. `slows` is a register, which follows one clock after the end of a time
    // slot and after the first clock of a reset. With one time slot, the clock after it belongs to
    // the same axes again and is left out.

    wire known = (`AXES > `LANES || !was_time_slot_ends) && !was_resetting;
    always_comb begin
        promise_12_waits_as_asked: assert (seeking == waiting);
        promise_12_told_of_its_own_hit: assert (caught == its_meets[`LANES-1:0] && sweeps == swept);
        promise_12_slows_after_its_hit: assert (hits == slowing && (!known || slows == its_hits[`LANES-1:0]));
        promise_12_forgives_the_limit_of_its_seek: assert (!known || forgives == forgiven[`LANES-1:0]);
        promise_19_a_hit_ramps_those_that_wait: assert ((new_hits & ~was_seeking) == 0
            && (new_hits == 0 || was_all_meet || new_hits == (was_meets & ~was_hits)));
        promise_19_all_that_wait_ramp_at_one_strobe: assert (!was_all_meet || was_resetting || (was_seeking & ~hits) == 0);
        promise_19_a_hit_stays_until_a_mask_and_rest: assert (old_hits == 0 || was_resetting
            || was_released && (old_hits & ~was_rests) == 0);
        promise_13_inactive: assert (!first_clock || {slows, seeking, hits, sweeps} == 0);
        promise_13_reset_forgets: assert (!was_resetting || {seeking, hits, sweeps} == 0);
    end

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.origin" *) wire [6:0] origin;
    (* inside = "dut.released" *) wire dut_released;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (axis % `LANES == 0 && axis + `LANES <= `AXES && was_axis % `LANES == 0 && was_axis + `LANES <= `AXES);
        invariant_2: assert (origin == {level, own, of_row, of_axis} && dut_released == released);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_12_slows: cover (slows[`LANES-1] && axis == `AXES - `LANES);
        cover_19_two_in_one_clock: cover (was_meets != 0 && (was_meets & (was_meets - 1)) != 0);
        cover_19_one_hits_and_one_is_freed: cover (new_hits != 0 && old_hits != 0 && !was_resetting);
        cover_19_common_hit: cover (was_all_meet && hits == 3);
        cover_19_released: cover (old_hits != 0 && !was_resetting);
    end
endmodule

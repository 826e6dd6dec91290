// Proves promises 12, 13 and 19 of the seek, without a bound on time: the hit of a source ramps the
// axes that wait for it, and no other.
//
//   parameters   AXES: number of axes
//                `DUT: the name of the exported module `seek_control`
//   assumptions  A time slot belongs to one axis, whose bit is set in `axis_one_hot`; two time slots do
//                not end in adjacent clocks; at a strobe no time slot ends, and the axis is the first
//                one (proved in time_slot/promises.sv).

module promises (
    input wire clock,
    input wire strobe,
    input wire set_source,
    input wire [6:0] source,
    input wire set,
    input wire [`AXES-1:0] mask,
    input wire time_slot_ends,
    input wire [2:0] axis,   // the axis of the time slot
    input wire [1:0] row,
    input wire samples,
    input wire state,
    input wire goes_on,
    input wire resetting
);
    wire [`AXES-1:0] axis_one_hot = 32'd1 << axis;
    wire [`AXES-1:0] seeking, hits;
    wire slows, forgives, caught, sweeps;
    `DUT dut (.*);

    reg first_clock = 1, was_time_slot_ends = 0, was_resetting = 0;
    reg [2:0] was_axis = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_time_slot_ends, was_axis, was_resetting} <= {time_slot_ends, axis, resetting};
    end
    wire [2:0] follower = was_axis == `AXES - 1 ? 3'd0 : was_axis + 3'd1;
    always_comb begin
        assume (axis == (first_clock ? 3'd0 : was_time_slot_ends ? follower : was_axis));
        assume (!time_slot_ends || !was_time_slot_ends && !first_clock);
        assume (!strobe || !time_slot_ends && axis == 0);
    end

    // ---- The seek as docs/clock-by-clock.md specifies it.

    reg [`AXES-1:0] waiting = 0, slowing = 0;
    reg released = 0, swept = 0, own = 0, level = 0;
    reg [2:0] of_axis = 0;
    reg [1:0] of_row = 0;
    wire mine = (waiting >> axis) & 1;
    wire slowed = (slowing >> axis) & 1;
    wire is_source = row == of_row & (own | axis == of_axis);
    wire hit = time_slot_ends & samples & is_source & state == level;
    wire meets = hit & own & mine;
    wire all_meet = strobe & swept;
    wire rests = time_slot_ends & slows & !goes_on & released;
    always @(posedge clock) begin
        if (set_source) {level, own, of_row, of_axis} <= source;
        waiting <= resetting ? 0 : set ? mask : all_meet ? 0 : meets ? waiting & ~axis_one_hot : waiting;
        released <= !resetting & (set | released & !all_meet & !meets);
        swept <= !resetting & !strobe & (swept | hit & !own & waiting != 0);
        slowing <= resetting ? 0 : all_meet ? slowing | waiting : meets ? slowing | axis_one_hot
            : rests ? slowing & ~axis_one_hot : slowing;
    end

    // ---- Values of the clock before.

    reg [`AXES-1:0] was_hits = 0, was_seeking = 0, was_one_hot = 0;
    reg was_meets = 0, was_all_meet = 0, was_released = 0, was_rests = 0;
    always @(posedge clock) begin
        {was_hits, was_seeking, was_one_hot} <= {hits, seeking, axis_one_hot};
        {was_meets, was_all_meet, was_released, was_rests} <= {meets, all_meet, released, rests};
    end
    wire [`AXES-1:0] new_hits = hits & ~was_hits;
    wire [`AXES-1:0] old_hits = was_hits & ~hits;

    // ---- The promises. `slows` is a register, which follows one clock after the end of a time slot
    // and after the first clock of a reset. With one axis, the clock after its time slot belongs to
    // this axis again and is left out.

    wire known = (`AXES > 1 || !was_time_slot_ends) && !was_resetting;
    always_comb begin
        promise_12_waits_as_asked: assert (seeking == waiting);
        promise_12_told_of_its_own_hit: assert (caught == meets && sweeps == swept);
        promise_12_slows_after_its_hit: assert (hits == slowing && (!known || slows == slowed));
        promise_12_forgives_the_limit_of_its_seek: assert (!known || forgives == (is_source & (mine | slowed)));
        promise_19_a_hit_ramps_those_that_wait: assert ((new_hits & ~was_seeking) == 0
            && (new_hits == 0 || was_all_meet || was_meets && new_hits == was_one_hot));
        promise_19_all_that_wait_ramp_at_one_strobe: assert (!was_all_meet || was_resetting || (was_seeking & ~hits) == 0);
        promise_19_a_hit_stays_until_a_mask_and_rest: assert (old_hits == 0 || was_resetting
            || was_released && was_rests && old_hits == was_one_hot);
        promise_13_inactive: assert (!first_clock || !slows && {seeking, hits, sweeps} == 0);
        promise_13_reset_forgets: assert (!was_resetting || {seeking, hits, sweeps} == 0);
    end

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.origin" *) wire [6:0] origin;
    (* inside = "dut.released" *) wire dut_released;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (axis < `AXES && was_axis < `AXES);
        invariant_2: assert (origin == {level, own, of_row, of_axis} && dut_released == released);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_12_slows: cover (slows && axis == `AXES - 1);
        cover_19_own_hit: cover (was_meets && waiting != 0);
        cover_19_common_hit: cover (was_all_meet && hits == 3);
        cover_19_released: cover (old_hits != 0 && !was_resetting);
    end
endmodule

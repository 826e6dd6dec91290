// Proves the exception of promise 12 for homing, and promise 13, without a bound on time: the limit
// for which an axis waits slows down this axis and no other.
//
//   parameters   AXES: number of axes
//                `DUT: the name of the exported module `homes`
//   assumptions  A time slot belongs to one axis, whose bit is set in `axis_one_hot`, and two time slots do
//                not end in adjacent clocks (proved in time_slot/promises.sv). Hits occur in the last
//                beat of a time slot (proved in limits/promises.sv).
//
// All statements are about one axis, `who`; the solver may choose any.

module promises (
    input wire clock,
    input wire set,
    input wire [`AXES-1:0] mask,
    input wire time_slot_ends,
    input wire [2:0] axis,   // the axis of the time slot
    input wire hit,
    input wire goes_on,
    input wire resetting
);
    (* anyconst *) reg [2:0] who;

    wire [`AXES-1:0] axis_one_hot = 32'd1 << axis;
    wire [`AXES-1:0] axes;
    wire waits, slows, caught;
    `DUT dut (.*);

    reg first_clock = 1, was_time_slot_ends = 0;
    reg [2:0] was_axis = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_time_slot_ends, was_axis} <= {time_slot_ends, axis};
    end
    wire [2:0] follower = was_axis == `AXES - 1 ? 3'd0 : was_axis + 3'd1;
    always_comb begin
        assume (who < `AXES && (!hit || time_slot_ends));
        assume (axis == (first_clock ? 3'd0 : was_time_slot_ends ? follower : was_axis));
        assume (!time_slot_ends || !was_time_slot_ends && !first_clock);
    end

    // ---- Homing as docs/clock-by-clock.md specifies it.

    reg waiting = 0, slowing = 0;
    wire ends = time_slot_ends & axis == who;
    wire meets = ends & hit & waiting;
    always @(posedge clock) begin
        waiting <= resetting ? 0 : set ? (mask >> who) & 1 : waiting & !meets;
        if (ends) slowing <= meets | slowing & goes_on;
    end

    // ---- The promises. `slows` is a register, which follows one clock after the end of a time
    // slot. With one axis, that clock belongs to this axis again and is left out (`known`).

    wire known = `AXES > 1 || !was_time_slot_ends;
    always_comb begin
        promise_12_waits_as_asked: assert (((axes >> who) & 1) == waiting);
        promise_12_waits_in_its_time_slot: assert (axis != who || waits == waiting);
        promise_12_told_of_its_own_hit: assert (axis != who || caught == meets);
        promise_12_slows_after_its_own_hit: assert (axis != who || !known || slows == slowing);
        promise_13_inactive: assert (!first_clock || !slows && axes == 0);
    end

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.slowing" *) wire [`AXES-1:0] dut_slowing;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (axis < `AXES && was_axis < `AXES);
        invariant_2: assert (((dut_slowing >> who) & 1) == slowing);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_12_slows: cover (slows && axis == who);
        cover_12_slowed: cover (ends && slowing && !goes_on && !meets);
    end
endmodule

// Proves promises 5, 6, 8, 12 and 13 on the ports of the parallel core, and what the proofs of its
// modules assume, without a bound on time.
//
//   parameters   AXES: number of axes
//                `DUT: the name of the exported core, which is proved as a whole
//   assumptions  none
//
// This file names every input of an axis and of a shaper that comes from outside of them. None of
// these inputs comes from another axis, except the freeze, the clear that follows it and the common
// start. So in motion no axis changes the edges of another one.

module promises (
    input wire clock,
    input wire seg_valid,
    input wire [2:0] seg_axis,
    input wire [31:0] seg_ticks,
    input wire [63:0] seg_v,
    input wire [63:0] seg_a,
    input wire [63:0] seg_j,
    input wire seg_last,
    input wire start_valid,
    input wire [`AXES-1:0] start_mask,
    input wire clear
);
    localparam [`AXES-1:0] FIRST = 1;
    wire seg_ready, start_ready, idle, fault, protocol, started;
    wire [`AXES-1:0] step, dir, overrun, overspeed, underrun;
    wire [32*`AXES-1:0] position, discarded;
    `DUT dut (.*);

    // ---- Signals inside the core, for all axes. Axis 0 has the lowest bits.

    (* inside = "dut.axis_*.waiting" *) wire [`AXES-1:0] waiting;
    (* inside = "dut.axis_*.drained" *) wire [`AXES-1:0] drained;
    (* inside = "dut.axis_*.in_flight" *) wire [`AXES-1:0] in_flight;
    (* inside = "dut.axis_*.startable" *) wire [`AXES-1:0] startable;
    (* inside = "dut.axis_*.sequencer_load" *) wire [`AXES-1:0] load;
    (* inside = "dut.shaper_*.held_back" *) wire [`AXES-1:0] held_back;

    (* inside = "dut.axis_*.strobe" *) wire [`AXES-1:0] strobes;
    (* inside = "dut.axis_*.phase_start" *) wire [`AXES-1:0] phase_starts;
    (* inside = "dut.axis_*.phase" *) wire [4*`AXES-1:0] phases;
    (* inside = "dut.axis_*.frozen" *) wire [`AXES-1:0] axis_frozen;
    (* inside = "dut.axis_*.clear" *) wire [`AXES-1:0] axis_clear;
    (* inside = "dut.axis_*.go" *) wire [`AXES-1:0] go;
    (* inside = "dut.axis_*.push" *) wire [`AXES-1:0] push;
    (* inside = "dut.axis_*.seg_ticks" *) wire [32*`AXES-1:0] ticks;
    (* inside = "dut.axis_*.seg_v" *) wire [64*`AXES-1:0] v;
    (* inside = "dut.axis_*.seg_a" *) wire [64*`AXES-1:0] a;
    (* inside = "dut.axis_*.seg_j" *) wire [64*`AXES-1:0] j;
    (* inside = "dut.axis_*.seg_last" *) wire [`AXES-1:0] last;

    (* inside = "dut.shaper_*.frozen" *) wire [`AXES-1:0] shaper_frozen;
    (* inside = "dut.shaper_*.clear" *) wire [`AXES-1:0] shaper_clear;
    (* inside = "dut.shaper_*.request" *) wire [`AXES-1:0] shaper_request;
    (* inside = "dut.shaper_*.request_back" *) wire [`AXES-1:0] shaper_back;
    (* inside = "dut.shaper_*.want_fwd" *) wire [`AXES-1:0] shaper_want_fwd;
    (* inside = "dut.shaper_*.want_back" *) wire [`AXES-1:0] shaper_want_back;
    (* inside = "dut.axis_*.request" *) wire [`AXES-1:0] axis_request;
    (* inside = "dut.axis_*.request_back" *) wire [`AXES-1:0] axis_back;
    (* inside = "dut.axis_*.want_fwd" *) wire [`AXES-1:0] axis_want_fwd;
    (* inside = "dut.axis_*.want_back" *) wire [`AXES-1:0] axis_want_back;

    (* inside = "dut.tick.strobe" *) wire strobe;
    (* inside = "dut.tick.phase_start" *) wire phase_start;
    (* inside = "dut.tick.phase" *) wire [3:0] phase;
    (* inside = "dut.armed" *) wire armed;

    // ---- What the core has taken from the host, and whether the host has kept the protocol.

    wire seg_taken = seg_valid & seg_ready;
    wire seg_fine = seg_axis < `AXES && seg_ticks != 0;
    wire start_taken = start_valid & start_ready;
    wire start_fine = (start_mask & ~waiting) == 0;
    wire [`AXES-1:0] selected = FIRST << seg_axis;

    reg first_clock = 1, expected = 0, was_fault = 0, was_broken = 0, was_clear = 0;
    reg [`AXES-1:0] was_step = 0, mask = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        was_fault <= fault;
        was_step <= step;
        was_clear <= clear;
        was_broken <= seg_taken & !seg_fine | start_taken & !start_fine;
        expected <= start_taken & start_fine | expected & !started & !fault;
        if (start_taken && start_fine) mask <= start_mask;
    end

    // ---- The promises.

    always_comb begin
        promise_5_no_new_edge: assert (!was_fault || (step & ~was_step) == 0);
        promise_5_stays_frozen: assert (!was_fault || fault || was_clear);

        promise_6_ready: assert (seg_ready == (!fault && (selected & waiting) == 0));
        promise_6_taken_by_its_axis: assert (push == (seg_taken && seg_fine ? selected : 0));
        promise_6_broken_is_told: assert (!was_broken || protocol);
        promise_6_start_ready: assert (start_ready == (!fault && !expected));
        promise_6_start_on_one_tick: assert (!started || strobe && (mask & ~load) == 0);
        promise_6_no_start_is_missed: assert (started == (expected && !fault && strobe && (mask & ~startable) == 0));

        promise_8_idle: assert (idle == (!armed && &drained && held_back == 0 && step == 0));

        promise_12_any_fault_stops_all: assert (fault == (protocol || {overrun, overspeed, underrun} != 0));
        promise_12_all_at_once: assert (axis_frozen == {`AXES{fault}} && shaper_frozen == {`AXES{fault}});
        promise_12_one_beat: assert (strobes == {`AXES{strobe}} && phase_starts == {`AXES{phase_start}}
            && phases == {`AXES{phase}});
        promise_12_one_clear: assert (axis_clear == shaper_clear && (axis_clear == 0 || &axis_clear));
        promise_12_cleared_at_rest: assert (axis_clear == 0 || clear && fault && in_flight == 0 && step == 0);
        promise_12_go_is_the_start: assert (go == (started ? mask : 0));
        promise_12_segment_as_offered: assert (ticks == {`AXES{seg_ticks}} && v == {`AXES{seg_v}} && a == {`AXES{seg_a}}
            && j == {`AXES{seg_j}} && last == {`AXES{seg_last}});
        promise_12_own_requests: assert (shaper_request == axis_request && shaper_back == axis_back);
        promise_12_own_direction: assert (shaper_want_fwd == axis_want_fwd && shaper_want_back == axis_want_back);

        promise_13_inactive: assert (!first_clock || {step, dir, position, discarded, fault, started} == 0 && idle);
    end

    // ---- What the proofs of the modules assume about the core.

    always_comb begin
        assumed_by_axis_push: assert ((push & waiting) == 0 && (push == 0 || !fault && seg_ticks != 0));
        assumed_by_axis_go: assert (go == 0 || !fault && strobe);
        assumed_by_axis_clear: assert (axis_clear == 0 || fault && in_flight == 0);
        assumed_by_shaper: assert ((overrun == 0 || &shaper_frozen) && (shaper_clear == 0 || fault));
    end

    // ---- The invariant that makes the promises inductive: the start that is armed is the one that
    // was taken.

    (* inside = "dut.mask" *) wire [`AXES-1:0] armed_mask;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (fault || armed == expected && (!armed || armed_mask == mask));
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_6_two_start_as_one: cover (started && mask == (FIRST | FIRST << (`AXES - 1)));
        cover_5_protocol_fault: cover (fault && was_fault && protocol);
        cover_12_cleared: cover (axis_clear != 0);
        cover_8_idle_again: cover (was_fault && idle && !fault);
    end
endmodule

// Proves promises 5, 10, 12 and 13 of the module that stops the axes, for any inputs and without a
// bound on time.
//
//   parameters   AXES: number of axes
//                LIMIT_FREEZES: 1 if a limit freezes the axes, 0 if it ramps them down
//                CAUSES: the numbers of the causes, as `NAME=number,...`
//                `DUT: the name of the exported module `stops`
//   assumptions  No time slot ends at a strobe, and no axis runs in a time slot that ends while
//                `halted` is 1 (proved in engine/promises.sv and engine/wide/promises.sv).
//
// The signals of a stop are single bits for all axes, so every statement here holds for each axis.

module promises (
    input wire clock,
    input wire strobe,
    input wire time_slot_ends,
    input wire [`AXES-1:0] axis_one_hot,
    input wire runs,
    input wire too_fast,
    input wire limit,
    input wire dry,
    input wire [`AXES-1:0] late,
    input wire pressed,
    input wire breaks,
    input wire missed,
    input wire interlock,
    input wire asked,
    input wire clear,
    input wire pins_busy,
    input wire ending,
    input wire stage_2,
    input wire completes
);
    localparam [3:0] `CAUSES;

    wire fault, finds, frozen, ramp, halted, settles, clearing;
    wire [3:0] cause;
    wire [`AXES-1:0] culprits;
    `DUT dut (.*);

    always_comb begin
        assume (!strobe || !time_slot_ends);
        assume (!halted || !time_slot_ends || !runs);
        assume (!completes || strobe && ending && stage_2);
    end

    // ---- What this tick has found so far. If several axes have found a cause, that of the first
    // of them counts.

    reg tick_found = 0, tick_freezes = 0, tick_ran = 0;
    reg [3:0] tick_cause = 0;
    reg [`AXES-1:0] tick_axis = 0;
    wire finds_now = time_slot_ends & (too_fast | limit | dry);
    always @(posedge clock) begin
        if (strobe) {tick_found, tick_freezes, tick_ran} <= 0;
        if (time_slot_ends && runs) tick_ran <= 1;
        if (time_slot_ends && (too_fast || limit && `LIMIT_FREEZES)) tick_freezes <= 1;
        if (finds_now && !tick_found) begin
            tick_found <= 1;
            tick_cause <= too_fast ? OVERSPEED : limit ? LIMIT : UNDERRUN;
            tick_axis <= axis_one_hot;
        end
    end

    // ---- The calls for a stop, in the order of their priority, and their expected effect.

    wire overrun = late != 0;
    wire e_stop = strobe & pressed;
    wire found = strobe & tick_found;
    wire watchdog = strobe & missed;
    wire opened = strobe & interlock;
    wire called = overrun | e_stop | breaks | found | watchdog | opened | asked | ending;
    wire freezes = overrun | e_stop | breaks | strobe & tick_freezes | ending;
    wire [3:0] call = overrun ? OVERRUN : e_stop ? E_STOP : breaks ? PROTOCOL : found ? tick_cause
        : watchdog ? WATCHDOG : opened ? INTERLOCK : STOP;
    wire [`AXES-1:0] caller = overrun ? late : !e_stop & !breaks & found ? tick_axis : 0;
    // `clear` clears the stop in this tick.
    (* inside = "dut.wiping" *) wire wiping;
    wire cleared = strobe & wiping | completes;

    // ---- Values of the clock before, and of the last strobe.

    reg first_clock = 1, was_called = 0, was_freezes = 0, was_cleared = 0, was_strobe = 0;
    reg was_fault = 0, was_frozen = 0, was_ramp = 0, was_halted = 0, was_wiping = 0;
    reg was_watchdog = 0, was_asked = 0, was_ending = 0;
    reg [3:0] was_call = 0, was_cause = 0;
    reg [`AXES-1:0] was_caller = 0, was_culprits = 0;
    reg ran = 0, found_before = 0, found_freezing = 0, told = 0, quiet = 0;
    reg halted_at_strobe = 0;        // `halted` was 1 at the last strobe
    // `halted` was 1 in the clock before, and at the strobe before that clock.
    reg was_at_rest = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_called, was_freezes, was_cleared, was_strobe} <= {called, freezes, cleared, strobe};
        {was_fault, was_frozen, was_ramp, was_halted, was_wiping} <= {fault, frozen, ramp, halted, wiping};
        {was_watchdog, was_asked, was_ending} <= {watchdog, asked, ending};
        {was_call, was_cause, was_caller, was_culprits} <= {call, cause, caller, culprits};
        {ran, found_before, found_freezing} <= {tick_ran, tick_found, tick_freezes};
        told <= clear;
        quiet <= !pins_busy & !pressed & !interlock;
        if (strobe) halted_at_strobe <= halted & !cleared;
        was_at_rest <= halted & halted_at_strobe;
    end

    // ---- The promises.

    always_comb begin
        promise_5_freezing_call_freezes: assert (!was_freezes || frozen || was_cleared);
        promise_5_only_such_a_call_freezes: assert (!frozen || was_frozen || was_freezes);
        promise_5_frozen_until_clear: assert (!was_frozen || frozen || was_cleared);
        promise_5_frozen_is_fault: assert (!frozen || fault);

        promise_10_silence_stops: assert (!was_watchdog || fault || was_cleared);
        promise_10_host_stops: assert (!was_asked || fault || was_cleared);
        promise_10_stopped_until_clear: assert (!was_fault || fault || was_cleared);
        promise_10_first_cause_stays: assert (!was_fault || !fault || {cause, culprits} == {was_cause, was_culprits});
        promise_10_first_cause: assert (was_fault || !fault || {cause, culprits} == {was_call, was_caller});
        promise_10_ramp_from_the_next_strobe: assert (was_strobe && !was_cleared ? ramp == (was_fault | found_before)
            : was_cleared ? !ramp : ramp == was_ramp);
        promise_10_ramps_until_clear: assert (!was_ramp || ramp || was_cleared);
        promise_10_halts_when_nothing_ran: assert (was_halted || !halted
            || was_strobe && (was_frozen | found_freezing | was_ramp & !ran));
        promise_10_halts_then: assert (halted || !was_strobe || was_cleared
            || !(was_frozen | found_freezing | was_ramp & !ran));
        promise_10_halted_until_clear: assert (!was_halted || halted || was_cleared);
        promise_10_clear_is_asked_for: assert (was_wiping || !wiping || was_strobe && told && quiet && !was_ending);
        promise_10_clear_after_a_tick_at_rest: assert (was_wiping || !wiping || was_at_rest && was_fault);
        promise_10_clear_ends: assert (!was_strobe || !was_wiping || !wiping);
        promise_13_reset_clears_too: assert (clearing == (wiping | stage_2) && (!settles || halted && !wiping));

        promise_12_any_call_stops_all: assert (!was_called || fault || was_cleared);
        promise_12_no_stop_without_a_call: assert (!fault || was_fault || was_called);
        promise_12_found_before_the_strobe: assert (finds == tick_found);
        promise_12_clear_is_whole: assert (!was_cleared || {fault, frozen, ramp, halted, wiping, finds} == 0);

        promise_13_inactive: assert (!first_clock || {fault, finds, frozen, ramp, halted, wiping} == 0);
    end

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.kind" *) wire [3:0] kind;
    (* inside = "dut.settled" *) wire settled;
    (* inside = "dut.ran" *) wire dut_ran;
    (* inside = "dut.found_freezing" *) wire dut_found_freezing;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert ({dut_ran, dut_found_freezing} == {tick_ran, tick_freezes});
        invariant_2: assert (!tick_found || kind == tick_cause && (fault || culprits == tick_axis));
        invariant_3: assert ((!halted || ramp || frozen) && (!tick_freezes || tick_found));
        invariant_4: assert (!halted || !tick_ran);
        invariant_5: assert (!(ramp || frozen || halted) || fault);
        invariant_6: assert (settled == halted_at_strobe && (!settled || halted));
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_5_frozen_in_a_ramp: cover (frozen && !was_frozen && cause == WATCHDOG);
        cover_10_halted_by_a_ramp: cover (halted && !frozen && cause == UNDERRUN && culprits == 2);
        cover_10_cleared: cover (was_cleared);
        cover_10_interlock: cover (halted && !frozen && cause == INTERLOCK);
        cover_12_two_in_one_clock: cover (fault && !was_fault && was_call == OVERRUN && found_before);
    end
endmodule

// Proves promises 5, 6, 8, 12 to 15 and 17 to 19 on the ports of the engine, and what the proofs of
// its modules assume, without a bound on time.
//
//   parameters   AXES: number of axes
//                CLOCKS, PHASES: clocks and phases in a tick
//                `DUT: the name of the exported engine, which is proved as a whole
//   assumptions  none
//
// Statements about an axis are about one axis, `who`; the solver may choose any.

module promises (
    input wire clock,
    input wire put_valid,
    input wire [2:0] put_axis,
    input wire [3:0] put_word,
    input wire [31:0] put_data,
    input wire start_valid,
    input wire [`AXES-1:0] start_mask,
    input wire cut,
    input wire clear,
    input wire reset,
    input wire stop,
    input wire broken,
    input wire seek_source_valid,
    input wire [6:0] seek_source,
    input wire seek_valid,
    input wire [`AXES-1:0] seek_mask,
    input wire latch_arm,
    input wire kick,
    input wire enable,
    input wire estop,
    input wire [`AXES-1:0] limit_min,
    input wire [`AXES-1:0] limit_max,
    input wire [`AXES-1:0] inputs_0,
    input wire [`AXES-1:0] inputs_1,
    input wire latch,
    input wire snapshot
);
    localparam [7:0] CLOCKS = `CLOCKS, PHASES = `PHASES, PHASE_CLOCKS = CLOCKS / PHASES, TIME_SLOT_CLOCKS = 13, ALL_TIME_SLOTS = TIME_SLOT_CLOCKS * `AXES;
    localparam [3:0] `CAUSES;
    (* anyconst *) reg [2:0] who;

    wire put_ready, start_ready, state_valid, refreshed, room_valid, enabled, idle, fault, halted, resetting, armed, ready, started, latch_armed;
    wire [31:0] state;
    wire [7:0] outputs;
    wire pwm, cut_busy, cut_refused;
    wire [1:0] state_page;
    wire [`AXES-1:0] step, dir, culprits, seeking, hits;
    wire [2:0] state_axis, state_item;
    wire [4:0] room;
    wire [3:0] cause, latch_edges;
    `DUT dut (.*);

    always_comb begin
        assume (who < `AXES);
    end

    // The words that the memory of the segments delivers do not matter here: the solver may choose
    // any word in any clock.
    // (* free = "dut.store.segments_read_data" *)

    // ---- Signals inside the engine. In those with one bit per axis, bit i belongs to axis i.

    (* inside = "dut.pulser_*.frozen" *) wire [`AXES-1:0] pulser_frozen;
    (* inside = "dut.pulser_*.request" *) wire [`AXES-1:0] requests;
    (* inside = "dut.pulser_*.request_back" *) wire [`AXES-1:0] requests_back;
    (* inside = "dut.pulser_*.has_sign" *) wire [`AXES-1:0] signs;
    (* inside = "dut.pulser_*.sign_back" *) wire [`AXES-1:0] signs_back;
    (* inside = "dut.pulser_*.held_back" *) wire [`AXES-1:0] held_back;
    (* inside = "dut.event_wheel_events" *) wire [`AXES-1:0] events;
    (* inside = "dut.event_wheel_backward" *) wire [`AXES-1:0] backward;
    (* inside = "dut.event_wheel_phase_start" *) wire phase_start;
    (* inside = "dut.strobe" *) wire strobe;
    (* inside = "dut.time_slot_beat" *) wire [16:0] beat;
    (* inside = "dut.time_slot_axis" *) wire [2:0] axis;
    (* inside = "dut.time_slot_axis_one_hot" *) wire [`AXES-1:0] axis_one_hot;
    (* inside = "dut.stops_frozen" *) wire frozen;
    (* inside = "dut.queue.ramp" *) wire ramp;
    (* inside = "dut.stops_ramp" *) wire all_ramp;
    (* inside = "dut.seek_control_slows" *) wire slows;
    (* inside = "dut.queue.empties" *) wire empties;
    (* inside = "dut.queue_goes_on" *) wire queue_goes_on;
    (* inside = "dut.seek_control_forgives" *) wire forgives;
    (* inside = "dut.switches_found" *) wire limit_found;
    (* inside = "dut.stops.limit" *) wire limit;
    (* inside = "dut.stops_clearing" *) wire clearing;
    (* inside = "dut.stops.breaks" *) wire breaks;
    (* inside = "dut.queue_misplaced" *) wire misplaced;
    (* inside = "dut.output_control_stray" *) wire stray;
    (* inside = "dut.output_control.off" *) wire outputs_off;
    (* inside = "dut.pulse_width.off" *) wire pwm_off;
    (* inside = "dut.resets_ending" *) wire ending;
    (* inside = "dut.resets.first" *) wire stage_1;
    (* inside = "dut.resets_stage_2" *) wire stage_2;
    (* inside = "dut.resets_completes" *) wire completes;
    (* inside = "dut.resets_restarts_round" *) wire restarts_round;
    (* inside = "dut.supervisor_warm" *) wire warm;
    (* inside = "dut.supervisor_row" *) wire [1:0] row;
    (* inside = "dut.supervisor_begins_round" *) wire begins_round;
    (* inside = "dut.edge_latch_comes" *) wire comes;
    (* inside = "dut.edge_latch_latches" *) wire latches;
    (* inside = "dut.mask" *) wire [`AXES-1:0] mask;
    (* inside = "dut.take" *) wire take;
    (* inside = "dut.queue.starts" *) wire starts;
    (* inside = "dut.queue_full" *) wire full;
    (* inside = "dut.queue_empty" *) wire empty;
    (* inside = "dut.queue_running" *) wire running;

    // ---- Values of the clock before.

    reg found_before = 0;            // in the tick before an axis was to be output for its own hit
    reg latched = 0;                 // at the strobe before, the latch took its edge
    reg asked = 0;                   // the start that was taken last includes `who`
    reg first_clock = 1, was_frozen = 0, was_fault = 0, was_enabled = 0, was_breaking = 0, was_cleared = 0;
    reg was_strobe = 0, was_start = 0, was_armed = 0, was_started = 0, was_starts = 0, was_halted = 0, was_ramp = 0;
    reg was_wrong = 0, was_right = 0, was_ending = 0, was_clearing = 0, was_begins_round = 0;
    reg was_dropped = 0, was_resetting = 0, before_resetting = 0;
    reg [1:0] was_row = 0;
    reg [`AXES-1:0] was_step = 0;
    reg [12:0] was_beat = 0;
    wire start = start_valid & start_ready;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_frozen, was_fault, was_enabled, was_step, was_beat} <= {frozen, fault, enabled, step, beat[12:0]};
        {was_strobe, was_start, was_armed, was_started} <= {strobe, start, armed, started};
        {was_starts, was_halted, was_ramp, was_clearing} <= {starts, halted, ramp, clearing};
        {was_begins_round, was_row, was_resetting} <= {begins_round, row, resetting};
        was_dropped <= strobe & drops;
        before_resetting <= was_resetting;
        latched <= strobe ? comes : latched;
        found_before <= strobe ? found_now : found_before;
        if (start) asked <= (start_mask >> who) & 1;
        was_breaking <= (put_valid & put_axis >= `AXES | broken | misplaced | stray) & !fault;
        was_cleared <= strobe & clearing;
        was_ending <= ending;
        was_wrong <= take && mine && !put_word[3] && put_word[2:0] != word[16:14];
        was_right <= take && mine && put_word == {1'b0, word[16:14]};
    end
    wire mine = axis == who & beat[12:0] != 0;

    // ---- The promises.

    always_comb begin
        promise_5_no_new_edge: assert (!was_frozen || (step & ~was_step) == 0);
        promise_5_every_axis_frozen: assert (pulser_frozen == {`AXES{frozen}});

        promise_6_taken_in_its_time_slot: assert (!take || put_valid && put_ready && axis == put_axis
            && (put_word[3] ? beat[12] : beat[7] && !full));
        promise_18_none_named_while_one_is_examined: assert (!(take && put_word[3] && checks));
        promise_6_words_in_order: assert ((!was_wrong || misplaced) && (!was_right || !misplaced));
        promise_6_nothing_taken_in_a_fault: assert (!fault || !put_ready && !start_ready && !started);
        promise_6_no_such_axis_is_told: assert (!was_breaking || fault || was_cleared);
        promise_6_start_of_nothing_is_told: assert (!started || !breaks || broken || misplaced || stray || put_valid && put_axis >= `AXES);
        promise_6_a_start_is_kept: assert (!was_armed || armed || was_started || was_fault || was_dropped);
        promise_6_no_start_of_an_axis_at_its_hit: assert (!started || !drops);
        promise_6_something_to_start: assert (!(mine && starts) || !word[10] && word[9:5] != word[4:0]);

        promise_8_idle: assert (!idle || !armed && held_back == 0 && step == 0);
        promise_8_idle_is_empty: assert (!idle || !word[10] && word[9:5] == word[4:0]);

        promise_12_own_requests: assert (requests == (phase_start ? events : 0) && requests_back == backward);
        promise_12_own_direction: assert (signs == (strobe ? events : 0) && signs_back == backward);
        promise_12_starts_who_is_asked_to: assert (!mine || starts == (going & asked));
        promise_17_off_at_stops: assert ((!frozen && enabled || outputs_off) && (frozen || fault || !enabled || !outputs_off)
            && pwm_off == outputs_off);
        promise_19_a_hit_ramps_its_own_axis: assert (ramp == (all_ramp | slows) && empties == (slows & !queue_goes_on));
        promise_12_a_limit_of_a_seek_stops_no_other: assert (limit == (limit_found & !forgives));
        promise_12_on_one_tick: assert (!started || strobe && armed);

        promise_13_inactive: assert (!first_clock || {step, dir, outputs, pwm, enabled, fault, halted, started, culprits} == 0 && idle);

        promise_13_reset_freezes: assert (!was_ending || frozen || was_cleared);
        promise_13_reset_of_an_engine_at_rest: assert (!resetting || halted && held_back == 0 && step == 0 && !armed);

        promise_14_start_only_warm: assert (!start || enable && enabled && warm && strobe);
        promise_14_nothing_moves_unasked: assert (!armed || was_armed || was_start);
    end

    always_comb begin
        promise_15_words_of_the_axis_of_the_time_slot: assert (!state_valid || state_axis == axis && beat[12:0] != 0);
        promise_15_a_snapshot_is_of_all_axes: assert (!(mine && takes && word_read[17]));
        promise_15_a_tick_is_live_or_a_snapshot: assert (!state_valid || beat[7] || state_page != 0 || word_read[17] || swept);
    end

    // ---- What the proofs of the modules assume about the engine.

    always_comb begin
        assumed_by_stops: assert ((!strobe || !beat[12]) && (!halted || !running));
        assumed_by_queue: assert (was_beat[11:0] == 0
            || {starts, halted, ramp, clearing} == {was_starts, was_halted, was_ramp, was_clearing});
        assumed_by_queue_clear: assert (!clearing || halted);
        assumed_by_queue_starts: assert (!(mine && starts) || !halted);
        assumed_by_stops_completes: assert (!completes || strobe && ending && stage_2);
        assumed_by_supervisor: assert ((ending || !resetting && !restarts_round) && (strobe || !restarts_round));
        assumed_by_switches: assert (!beat[12]
            || {begins_round, row, resetting} == {was_begins_round, was_row, was_resetting});
        assumed_by_seek_control: assert (!strobe || axis == 0);
        assumed_by_time_slot: assert (!strobe || at == CLOCKS - 1);
        assumed_by_readout: assert (!(mine && word_read[17]) || found_before);
        assumed_by_readout_latch: assert ((!latches || latched) && (!comes || strobe));
    end

    // ---- The invariants that make the promises inductive. They are about the beats, about the
    // control word of `who`, and about the results of this tick's time slots.

    reg turning = 0;
    reg [7:0] at = 0;
    wire [7:0] next = at == CLOCKS - 1 ? 0 : at + 1;
    always @(posedge clock) begin
        at <= next;
        if (at == CLOCKS - 1) turning <= 1;
    end
    wire in_time_slot = turning & at < ALL_TIME_SLOTS;
    wire had_time_slot = turning & at >= TIME_SLOT_CLOCKS * ({5'd0, who} + 1);

    wire [30:0] word;
    memory_probe #("\\dut.queue.control.words", 3, 31) at_control (1'b0, 1'b1, who, word);
    (* inside = "dut.queue.word" *) wire [30:0] word_read;
    (* inside = "dut.queue.took" *) wire took;
    wire committed = took && word_read[16:14] == 7;
    (* inside = "dut.event_wheel.tick.sub" *) wire [15:0] sub;
    (* inside = "dut.event_wheel.tick.phases" *) wire [3:0] phases;
    (* inside = "dut.time_slot.beats" *) wire [16:0] beats;
    (* inside = "dut.going" *) wire going;
    (* inside = "dut.unfed" *) wire unfed;
    (* inside = "dut.held" *) wire held;
    (* inside = "dut.drops" *) wire drops;
    (* inside = "dut.active" *) wire active;
    (* inside = "dut.rest_1" *) wire rest_1;
    (* inside = "dut.rest_2" *) wire rest_2;
    (* inside = "dut.stops.settled" *) wire settled;
    (* inside = "dut.stops.wiping" *) wire wiping;
    (* inside = "dut.stops.ran" *) wire ran;
    (* inside = "dut.stops.found" *) wire found;
    (* inside = "dut.stops.found_freezing" *) wire found_freezing;
    (* inside = "dut.seek_control.slowing" *) wire [`AXES-1:0] slowing;
    (* inside = "dut.supervisor.round" *) wire [9:0] round;
    (* inside = "dut.readout.takes" *) wire takes;
    (* inside = "dut.readout.found" *) wire found_now;
    (* inside = "dut.readout.swept" *) wire swept;
    (* inside = "dut.cut_control.asked" *) wire cut_asked;
    (* inside = "dut.cut_control.checking" *) wire checking;
    (* inside = "dut.cut_control.closing" *) wire closing;
    (* inside = "dut.cut_control.missed" *) wire missed;
    (* inside = "dut.cut_control.denied" *) wire denied;
    (* inside = "dut.queue.cuts" *) wire cuts;
    (* inside = "dut.queue.checks" *) wire checks;
    // The newest segment, after the cut of this tick; and whether the named segment is in the
    // queue.
    wire [2:0] newest = cuts & word[30] ? word[27:25] : word[7:5];
    wire [2:0] behind_live = word[27:25] - word[2:0], waiting = word[7:5] - word[2:0];
    wire is_there = !word[30] | (behind_live <= waiting & (behind_live != 0 | word[10]));
    wire quiet = !word[10] & word[9:5] == word[4:0];
    // The engine rotates the mask with the time slots: bit `round_by` of it belongs to `who` now.
    wire [3:0] round_by = who >= axis ? who - axis : who + `AXES - axis;
    wire masked = (mask >> round_by) & 1;
    reg taken = 0;                   // a word of a segment has been taken in this tick
    always @(posedge clock) taken <= take & !put_word[3] | taken & !strobe;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (at < CLOCKS && sub < PHASE_CLOCKS && phases < PHASES && phases * PHASE_CLOCKS + sub == next);
        invariant_2: assert (strobe == (at == CLOCKS - 1) && (phase_start == (at % PHASE_CLOCKS == 0) || first_clock));
        invariant_3: assert (beats[12:0] == (in_time_slot ? 13'd1 << (at % TIME_SLOT_CLOCKS) : 0)
            && axis == (in_time_slot ? at / TIME_SLOT_CLOCKS : 0) && axis_one_hot == 32'd1 << axis);
        invariant_4: assert (was_beat[11:0] == 0 || at % TIME_SLOT_CLOCKS != 0);
        invariant_5: assert (axis != who || !in_time_slot || word_read == word);
        invariant_6: assert (!in_time_slot || at % TIME_SLOT_CLOCKS == 0 || !(took && at % TIME_SLOT_CLOCKS < 8));
        invariant_7: assert (!(took && in_time_slot && at % TIME_SLOT_CLOCKS != 0) || taken);
        invariant_8: assert (!taken || !rest_1 && !rest_2);
        invariant_9: assert (!rest_2 || rest_1 && quiet);
        invariant_10: assert (!(had_time_slot && !active && !taken) || quiet);
        invariant_11: assert (!(armed && had_time_slot && asked && !unfed && !held && !drops) || !word[10] && word[9:5] != word[4:0]);
        invariant_12: assert (!(going && asked && !had_time_slot) || !word[10] && word[9:5] != word[4:0]);
        invariant_20: assert (masked == asked || !armed && !going);
        invariant_13: assert (!going || !halted && !armed);
        invariant_14: assert ((!(halted || all_ramp || frozen) || fault) && (!found_freezing || found));
        invariant_15: assert (!clearing || settled && halted);
        invariant_16: assert ((!settled || halted) && (!halted || all_ramp));
        invariant_17: assert (!halted || !ran);
        invariant_19: assert (!(mine && committed && at % TIME_SLOT_CLOCKS >= 8) || newest + 3'd1 != word[2:0] + {2'd0, starts});
        invariant_21: assert (slows == |(slowing & axis_one_hot) || (`AXES == 1 && was_beat[12]) || was_resetting && !before_resetting);
        invariant_22: assert (!was_beat[12] || at % TIME_SLOT_CLOCKS == 0 && at != 0 && at <= ALL_TIME_SLOTS);
        invariant_23: assert (!(stage_1 | stage_2) || ending && settled && halted && frozen && !wiping && !armed
            && !(stage_1 && stage_2));
        invariant_24: assert (!(stage_2 && had_time_slot) || quiet);
        invariant_25: assert (turning || !stage_1 && !stage_2 && !settled);
        invariant_28: assert (!mine || beat[0] || full == (newest + 3'd1 == word[2:0] + {2'd0, starts}));
        invariant_29: assert ((!was_resetting || before_resetting || at == 1 && resetting)
            && (!resetting || was_resetting || at == 0));
        invariant_30: assert (!was_resetting || slowing == 0 && seeking == 0);
        invariant_26: assert (!(takes && found_before));
        invariant_27: assert (!word[17] || (had_time_slot ? found_now : found_before));
        invariant_31: assert (!(checking && had_time_slot && !missed) || is_there);
        invariant_32: assert (!(closing && !denied && !had_time_slot) || is_there);
        invariant_33: assert ({word[29:28], word[9:8], word[4:3]} == 0 && !(checking && !turning) && !(closing && !turning));
        invariant_34: assert (!was_resetting || !cut_asked && !checking);
        invariant_35: assert (`CUTS || {word[30], cut_asked, checking, closing} == 0);
        invariant_18: assert (turning || !{going, taken, armed, active, unfed, held, drops, word[17]} && quiet);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_6_started: cover (started);
        cover_14_enabled: cover (enabled && idle);
        cover_13_reset: cover (stage_2 && completes);
        cover_15_snapshot: cover (takes && refreshed == 0 && beat[12]);
        cover_12_protocol: cover (fault && was_fault && cause == PROTOCOL);
    end
endmodule

// Proves promises 5 to 8, 12 to 15 and 17 to 19 on the ports of the engine with several adders, how
// it connects its parts, and what the proofs of its modules assume, without a bound on time.
//
//   parameters   AXES: number of axes
//                LANES: number of adders
//                CLOCKS, PHASES: clocks and phases in a tick
//                `DUT: the name of the exported engine, which is proved as a whole
//   assumptions  none
//
// Statements about an axis are about one axis, `who`, and its lane; the solver may choose any axis.
// The statements are those of ../promises.sv, and those about the connections of lanes.

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
    localparam [7:0] CLOCKS = `CLOCKS, PHASES = `PHASES, PHASE_CLOCKS = CLOCKS / PHASES, TIME_SLOT_CLOCKS = 13, LANES = `LANES,
        TIME_SLOTS = `AXES / LANES, ALL_TIME_SLOTS = TIME_SLOT_CLOCKS * TIME_SLOTS;
    localparam [3:0] `CAUSES;
    (* anyconst *) reg [2:0] who;

    wire put_ready, start_ready, refreshed, room_valid, enabled, idle, fault, halted, resetting, armed, ready, started, latch_armed;
    wire [7:0] outputs;
    wire pwm, cut_busy, cut_refused;
    wire [`AXES-1:0] step, dir, culprits, seeking, hits;
    wire [4:0] room;
    wire [3:0] cause, latch_edges;
    // The words of state of lane k are in bit k, or in field k.
    wire [`LANES-1:0] state_valid;
    wire [2*`LANES-1:0] state_page;
    wire [3*`LANES-1:0] state_axis, state_item;
    wire [32*`LANES-1:0] state;
    `DUT dut (.*);

    always_comb begin
        assume (who < `AXES);
    end
    wire [2:0] lane = who % LANES, time_slot_of_who = who / LANES;

    // The words that the memories of the segments deliver do not matter here: the solver may choose
    // any word in any clock.
    // (* free = "dut.store_#.segments_read_data" *)

    // ---- Signals inside the engine. In those with one bit per axis, bit i belongs
    // to axis i; in those with one element per lane, element k belongs to lane k.

    (* inside = "dut.pulser_*.frozen" *) wire [`AXES-1:0] pulser_frozen;
    (* inside = "dut.pulser_*.request" *) wire [`AXES-1:0] requests;
    (* inside = "dut.pulser_*.request_back" *) wire [`AXES-1:0] requests_back;
    (* inside = "dut.pulser_*.has_sign" *) wire [`AXES-1:0] signs;
    (* inside = "dut.pulser_*.sign_back" *) wire [`AXES-1:0] signs_back;
    (* inside = "dut.pulser_*.held_back" *) wire [`AXES-1:0] held_back;
    (* inside = "dut.events" *) wire [`AXES-1:0] events;
    (* inside = "dut.backward" *) wire [`AXES-1:0] backward;
    (* inside = "dut.phase_start" *) wire phase_start;
    (* inside = "dut.strobe" *) wire strobe;
    (* inside = "dut.lane_slots_beat" *) wire [16:0] beat;
    (* inside = "dut.lane_slots_axis" *) wire [2:0] first_axis;
    (* inside = "dut.lane_slots_axis_one_hot" *) wire [`AXES-1:0] axis_one_hot;
    (* inside = "dut.stops_frozen" *) wire frozen;
    (* inside = "dut.queue_#.ramp" *) wire [`LANES-1:0] each_ramp;
    wire ramp = each_ramp[lane];
    (* inside = "dut.stops_ramp" *) wire all_ramp;
    (* inside = "dut.lane_seek_slows" *) wire [`LANES-1:0] each_slows;
    wire slows = each_slows[lane];
    (* inside = "dut.queue_#.empties" *) wire [`LANES-1:0] each_empties;
    wire empties = each_empties[lane];
    (* inside = "dut.queue_#_goes_on" *) wire [`LANES-1:0] each_queue_goes_on;
    wire queue_goes_on = each_queue_goes_on[lane];
    (* inside = "dut.lane_seek_forgives" *) wire [`LANES-1:0] forgives;
    (* inside = "dut.switches_#_found" *) wire [`LANES-1:0] each_limit_found;
    wire limit_found = each_limit_found[lane];
    (* inside = "dut.findings.limit" *) wire [`LANES-1:0] limit;
    (* inside = "dut.stops_clearing" *) wire clearing;
    (* inside = "dut.stops.breaks" *) wire breaks;
    (* inside = "dut.queue_#_misplaced" *) wire [`LANES-1:0] each_misplaced;
    wire misplaced = each_misplaced[lane];
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
    (* inside = "dut.take" *) wire some_take;
    (* inside = "dut.queue_#.take" *) wire [`LANES-1:0] each_take;
    wire take = each_take[lane];
    // The axes of the lanes, and how they and the parts that they share are connected.
    wire [2:0] axis = first_axis + lane;
    (* inside = "dut.queue_#.axis" *) wire [3*`LANES-1:0] axis_of_queue;
    (* inside = "dut.store_#.axis" *) wire [3*`LANES-1:0] axis_of_store;
    (* inside = "dut.switches_#.axis" *) wire [3*`LANES-1:0] axis_of_switches;
    (* inside = "dut.store_#.put" *) wire [`LANES-1:0] stores;
    (* inside = "dut.event_wheel_#_events" *) wire [`AXES*`LANES-1:0] events_of_wheels;
    (* inside = "dut.event_wheel_#.whose" *) wire [`AXES*`LANES-1:0] whose;
    (* inside = "dut.step_counts_#.pulses" *) wire [3*`LANES-1:0] pulses;
    (* inside = "dut.step_counts_#.losses" *) wire [3*`LANES-1:0] losses;
    (* inside = "dut.pulser_*_counts" *) wire [6*`AXES-1:0] counts;
    (* inside = "dut.queue_#_too_fast" *) wire [`LANES-1:0] too_fast;
    (* inside = "dut.queue_#_dry" *) wire [`LANES-1:0] dry;
    (* inside = "dut.findings.too_fast" *) wire [`LANES-1:0] told_too_fast;
    (* inside = "dut.findings.dry" *) wire [`LANES-1:0] told_dry;
    (* inside = "dut.findings.runs" *) wire told_runs;
    (* inside = "dut.findings_tells" *) wire tells;
    (* inside = "dut.findings_some_run" *) wire some_run;
    (* inside = "dut.stops.time_slot_ends" *) wire stops_tells;
    (* inside = "dut.meeting" *) wire meeting;
    (* inside = "dut.output_control.first" *) wire first;
    (* inside = "dut.output_control.live,\dut.output_control.fresh" *) wire [9:0] output_slots;
    (* inside = "dut.output_control.starts,\dut.output_control.follows" *) wire [1:0] output_steps;
    (* inside = "dut.queue_#_live" *) wire [5*`LANES-1:0] live_slots;
    (* inside = "dut.queue_#_fresh" *) wire [5*`LANES-1:0] fresh_slots;
    (* inside = "dut.queue_#_advances" *) wire [`LANES-1:0] each_advances;
    (* inside = "dut.switches_#_interlock" *) wire [`LANES-1:0] each_interlock;
    (* inside = "dut.stops.interlock" *) wire interlock;
    reg [`AXES-1:0] events_of_some_wheel;
    integer wheel;
    always_comb begin
        events_of_some_wheel = 0;
        for (wheel = 0; wheel < `LANES; wheel = wheel + 1)
            events_of_some_wheel = events_of_some_wheel | events_of_wheels[`AXES*wheel +: `AXES];
    end
    (* inside = "dut.queue_#.starts" *) wire [`LANES-1:0] each_starts;
    wire starts = each_starts[lane];
    (* inside = "dut.queue_#_full" *) wire [`LANES-1:0] each_full;
    wire full = each_full[lane];
    (* inside = "dut.queue_#_empty" *) wire [`LANES-1:0] each_empty;
    wire empty = each_empty[lane];
    (* inside = "dut.queue_#_running" *) wire [`LANES-1:0] each_running;
    wire running = each_running[lane];

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
        was_breaking <= (put_valid & put_axis >= `AXES | broken | each_misplaced != 0 | stray) & !fault;
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
        promise_6_taken_by_one_lane: assert ((each_take & (each_take - 1)) == 0 && some_take == (each_take != 0));
        promise_18_none_named_while_one_is_examined: assert (!(take && put_word[3] && checks));
        promise_6_stored_in_the_memory_of_its_axis: assert (stores == kept_put);
        promise_6_words_in_order: assert ((!was_wrong || misplaced) && (!was_right || !misplaced));
        promise_6_nothing_taken_in_a_fault: assert (!fault || !put_ready && !start_ready && !started);
        promise_6_no_such_axis_is_told: assert (!was_breaking || fault || was_cleared);
        promise_6_start_of_nothing_is_told: assert (!started || !breaks || broken || each_misplaced != 0 || stray || put_valid && put_axis >= `AXES);
        promise_6_a_start_is_kept: assert (!was_armed || armed || was_started || was_fault || was_dropped);
        promise_6_no_start_of_an_axis_at_its_hit: assert (!started || !drops);
        promise_6_something_to_start: assert (!(mine && starts) || !word[10] && word[9:5] != word[4:0]);

        promise_8_idle: assert (!idle || !armed && held_back == 0 && step == 0);
        promise_8_idle_is_empty: assert (!idle || !word[10] && word[9:5] == word[4:0]);

        promise_12_events_of_all_wheels: assert (events == events_of_some_wheel);
        promise_12_own_requests: assert (requests == (phase_start ? events : 0) && requests_back == backward);
        promise_12_own_direction: assert (signs == (strobe ? events : 0) && signs_back == backward);
        promise_12_starts_who_is_asked_to: assert (!mine || starts == (going & asked));
        promise_17_commits_of_the_first_axis: assert (first == (first_axis == 0 && (!beat[7] || put_axis == 0)));
        promise_17_segments_of_the_first_axis: assert (output_slots == {live_slots[4:0], fresh_slots[4:0]}
            && output_steps == {each_starts[0], each_advances[0]} && interlock == each_interlock[0]);
        promise_17_off_at_stops: assert ((!frozen && enabled || outputs_off) && (frozen || fault || !enabled || !outputs_off)
            && pwm_off == outputs_off);
        promise_19_a_hit_ramps_its_own_axis: assert (ramp == (all_ramp | slows) && empties == (slows & !queue_goes_on));
        promise_12_a_limit_of_a_seek_stops_no_other: assert (limit == (each_limit_found & ~forgives));
        promise_12_every_lane_tells_its_causes: assert ({told_too_fast, told_dry, told_runs} == {too_fast, dry, each_running != 0}
            && stops_tells == tells);
        promise_12_lanes_have_their_axes: assert (axis_of_queue[3*lane +: 3] == axis && axis_of_store[3*lane +: 3] == axis
            && axis_of_switches[3*lane +: 3] == axis);
        promise_12_a_wheel_has_the_axes_of_its_lane: assert (whose[`AXES*lane +: `AXES] == 32'd1 << axis_before);
        promise_7_counts_of_its_own_pulser: assert (!mine || {losses[3*lane +: 3], pulses[3*lane +: 3]} == counts[6*who +: 6]);
        promise_12_on_one_tick: assert (!started || strobe && armed);

        promise_13_inactive: assert (!first_clock || {step, dir, outputs, pwm, enabled, fault, halted, started, culprits} == 0 && idle);

        promise_13_reset_freezes: assert (!was_ending || frozen || was_cleared);
        promise_13_reset_of_an_engine_at_rest: assert (!resetting || halted && held_back == 0 && step == 0 && !armed);

        promise_14_start_only_warm: assert (!start || enable && enabled && warm && strobe);
        promise_14_nothing_moves_unasked: assert (!armed || was_armed || was_start);
    end

    always_comb begin
        promise_15_words_of_the_axis_of_the_time_slot: assert (!state_valid[lane] || state_axis[3*lane +: 3] == axis && beat[12:0] != 0);
        promise_15_a_snapshot_is_of_all_axes: assert (!(mine && takes && word_read[17]) && each_takes == {`LANES{takes}});
        promise_15_a_tick_is_live_or_a_snapshot: assert (beat[7] || !some_page_of_no_hit);
    end

    // ---- What the proofs of the modules assume about the engine.

    always_comb begin
        assumed_by_stops: assert ((!strobe || !tells) && (!halted || !tells || !some_run));
        assumed_by_queue: assert (was_beat[11:0] == 0
            || {starts, halted, ramp, clearing} == {was_starts, was_halted, was_ramp, was_clearing});
        assumed_by_queue_clear: assert (!clearing || halted);
        assumed_by_queue_starts: assert (!(mine && starts) || !halted);
        assumed_by_stops_completes: assert (!completes || strobe && ending && stage_2);
        assumed_by_supervisor: assert ((ending || !resetting && !restarts_round) && (strobe || !restarts_round));
        assumed_by_switches: assert (!beat[12]
            || {begins_round, row, resetting} == {was_begins_round, was_row, was_resetting});
        assumed_by_output_control: assert (!some_take || beat[7] || put_word[3]);
        assumed_by_findings: assert (!(beat[12] && tells));
        assumed_by_lane_seek: assert (!strobe || first_axis == 0);
        assumed_by_lane_slots: assert (!strobe || at == CLOCKS - 1);
        assumed_by_readout: assert (!(mine && word_read[17]) || found_before);
        assumed_by_readout_latch: assert (!latches || latched);
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
    wire [7:0] number = at / TIME_SLOT_CLOCKS;
    wire had_time_slot = turning & at >= TIME_SLOT_CLOCKS * ({5'd0, time_slot_of_who} + 1);
    wire [3:0] axis_before = first_axis == 0 ? `AXES - `LANES + lane : axis - `LANES;

    wire [30:0] word;
    wire [31*`LANES-1:0] words;
    generate
        for (genvar k = 0; k < `LANES; k = k + 1) begin
            localparam [7:0] DIGIT = 48 + k;
            memory_probe #({"\\dut.queue_", DIGIT, ".control.words"}, 3, 31) at_control (1'b0, 1'b1, who, words[31*k +: 31]);
        end
    endgenerate
    assign word = words[31*lane +: 31];
    (* inside = "dut.queue_#.word" *) wire [31*`LANES-1:0] words_read;
    wire [30:0] word_read = words_read[31*lane +: 31];
    (* inside = "dut.queue_#.took" *) wire [`LANES-1:0] each_took;
    wire took = each_took[lane];
    wire committed = took && word_read[16:14] == 7;
    (* inside = "dut.event_wheel_#.tick.sub" *) wire [16*`LANES-1:0] subs;
    wire [15:0] sub = subs[16*lane +: 16];
    (* inside = "dut.event_wheel_#.tick.phases" *) wire [4*`LANES-1:0] each_phases;
    wire [3:0] phases = each_phases[4*lane +: 4];
    (* inside = "dut.lane_slots.beats" *) wire [16:0] beats;
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
    (* inside = "dut.lane_seek.slowing" *) wire [`AXES-1:0] slowing;
    (* inside = "dut.supervisor.round" *) wire [9:0] round;
    (* inside = "dut.readout_#.takes" *) wire [`LANES-1:0] each_takes;
    wire takes = each_takes[lane];
    (* inside = "dut.readout_#.found" *) wire [`LANES-1:0] each_found_now;
    wire found_now = each_found_now[lane];
    (* inside = "dut.readout_#.swept" *) wire [`LANES-1:0] each_swept;
    wire swept = each_swept[lane];
    (* inside = "dut.readout_#.asked" *) wire [`LANES-1:0] each_asked;
    (* inside = "dut.cut_control.asked" *) wire cut_asked;
    (* inside = "dut.cut_control.checking" *) wire checking;
    (* inside = "dut.cut_control.closing" *) wire closing;
    (* inside = "dut.cut_control.missed" *) wire missed;
    (* inside = "dut.cut_control.denied" *) wire denied;
    (* inside = "dut.queue_0.cuts" *) wire cuts;
    (* inside = "dut.queue_0.checks" *) wire checks;
    (* inside = "dut.findings.ended" *) wire ended;
    (* inside = "dut.findings.again" *) wire again;
    (* inside = "dut.taken" *) wire [`LANES-1:0] dut_taken;
    // A lane outputs a word of the page of hits, although none is to be output.
    reg some_page_of_no_hit;
    integer reader;
    always_comb begin
        some_page_of_no_hit = 0;
        for (reader = 0; reader < `LANES; reader = reader + 1)
            if (state_valid[reader] && state_page[2*reader +: 2] == 0 && !words_read[31*reader + 17] && !each_swept[reader])
                some_page_of_no_hit = 1;
    end
    // The newest segment, after the cut of this tick; and whether the named segment is in the
    // queue.
    wire [2:0] newest = cuts & word[30] ? word[27:25] : word[7:5];
    wire [2:0] behind_live = word[27:25] - word[2:0], waiting = word[7:5] - word[2:0];
    wire is_there = !word[30] | (behind_live <= waiting & (behind_live != 0 | word[10]));
    wire quiet = !word[10] & word[9:5] == word[4:0];
    // The engine rotates the mask with the time slots: bit `round_by` of it belongs to `who` now.
    wire [3:0] round_by = who >= first_axis ? who - first_axis : who + `AXES - first_axis;
    wire masked = (mask >> round_by) & 1;
    reg taken = 0;                   // a word of a segment has been taken in this tick
    always @(posedge clock) taken <= take & !put_word[3] | taken & !strobe;
    // The lane of the word, other than a commit, that was taken in this time slot.
    reg [`LANES-1:0] kept_put = 0;
    always @(posedge clock) kept_put <= some_take ? (put_word < 7 ? each_take : 0) : beat[9] ? 0 : kept_put;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (at < CLOCKS && sub < PHASE_CLOCKS && phases < PHASES && phases * PHASE_CLOCKS + sub == next);
        invariant_2: assert (strobe == (at == CLOCKS - 1) && (phase_start == (at % PHASE_CLOCKS == 0) || first_clock));
        invariant_3: assert (beats[12:0] == (in_time_slot ? 13'd1 << (at % TIME_SLOT_CLOCKS) : 0)
            && first_axis == (in_time_slot ? LANES * number : 0) && axis_one_hot == 32'd1 << first_axis);
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
        invariant_21: assert (slows == slowing[axis] || (TIME_SLOTS == 1 && was_beat[12]) || was_resetting && !before_resetting);
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
        invariant_36: assert (subs == {`LANES{sub}} && each_phases == {`LANES{phases}});
        invariant_37: assert ({ended, again} == {was_beat[12], again} && (!again || at > 1 && at % TIME_SLOT_CLOCKS == 1 && at <= ALL_TIME_SLOTS + 1));
        invariant_38: assert (each_swept == {`LANES{swept}} && each_asked == {`LANES{each_asked[0]}});
        invariant_39: assert (!meeting == (each_found_now == 0));
        invariant_40: assert (dut_taken == kept_put);
        invariant_18: assert (turning || !{going, taken, armed, active, unfed, held, drops, word[17]} && quiet);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_6_started: cover (started);
        cover_6_word_for_the_last_lane: cover (stores[`LANES-1] && beat[9]);
        cover_12_limit_of_the_last_lane: cover (limit[`LANES-1] && beat[12]);
        cover_14_enabled: cover (enabled && idle);
        cover_13_reset: cover (stage_2 && completes);
        cover_15_snapshot: cover (takes && refreshed == 0 && beat[12]);
        cover_12_protocol: cover (fault && was_fault && cause == PROTOCOL);
    end
endmodule

// Proves promises 1 to 7, 9, 11 and 13 of the engine's pulser on the pins of one axis, for any
// inputs and without a bound on time.
//
//   parameters   STEP_HIGH, STEP_LOW, DIR_SETUP, DIR_HOLD: the pin timing in clocks
//                `DUT: the name of the exported pulser, built with this timing
//   assumptions  none
//
// The promises refer to the pins and to counters in this file, not to the counters of the pulser.

module promises (
    input wire clock,
    input wire frozen,
    input wire request,
    input wire request_back,
    input wire has_sign,
    input wire sign_back
);
    localparam [19:0] STEP_HIGH = `STEP_HIGH, STEP_LOW = `STEP_LOW, DIR_SETUP = `DIR_SETUP, DIR_HOLD = `DIR_HOLD, LONG = 20'hfffff;

    wire step, dir, held_back, overruns;
    wire [5:0] counts;
    `DUT dut (.*);
    wire [2:0] position = counts[2:0], discarded = counts[5:3];

    // ---- Values of the clock before.

    reg first_clock = 1;
    reg was_step = 0, was_dir = 0, was_frozen = 0, was_request = 0, was_request_back = 0, was_held_back = 0;
    reg was_overruns = 0;
    reg [2:0] was_discarded = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        was_step <= step;
        was_dir <= dir;
        was_frozen <= frozen;
        was_request <= request;
        was_request_back <= request_back;
        was_held_back <= held_back;
        was_overruns <= overruns;
        was_discarded <= discarded;
    end
    wire rose = step & !was_step;
    wire fell = !step & was_step;
    wire turned = dir != was_dir;
    wire was_second = was_held_back & was_request & !was_frozen;

    // ---- Times on the pins, in clocks. Each counter saturates at LONG, which also means `never`.

    function [19:0] more(input [19:0] clocks);
        more = clocks == LONG ? LONG : clocks + 1;
    endfunction

    reg [19:0] highs = 0;            // clocks for which STEP was high until the clock before
    reg [19:0] lows = LONG;          // clocks for which STEP was low until the clock before
    reg [19:0] last_rise = LONG;     // clocks since STEP rose, before this clock
    // Clocks since DIR changed, before this clock, or since configuration.
    reg [19:0] last_dir_change = 0;
    wire [19:0] since_rise = rose ? 0 : last_rise;
    wire [19:0] since_dir_change = turned ? 0 : last_dir_change;
    always @(posedge clock) begin
        highs <= step ? more(highs) : 0;
        lows <= step ? 0 : more(lows);
        last_rise <= more(since_rise);
        last_dir_change <= more(since_dir_change);
    end

    // ---- The numbers of requested, made and discarded steps, and the position. The pulser counts
    // modulo 8.

    reg [31:0] asked = 0, made = 0, given_up = 0, place = 0;
    wire [31:0] made_now = made + rose;
    wire [31:0] given_up_now = given_up + (discarded != was_discarded);
    wire [31:0] place_now = !rose ? place : dir ? place - 1 : place + 1;
    always @(posedge clock) begin
        asked <= asked + request;
        made <= made_now;
        given_up <= given_up_now;
        place <= place_now;
    end

    // ---- The step that is due, the direction that DIR should have, and the number of clocks for
    // which a step has been held back (`held_back`).

    // The direction of the last V that was not 0, and the same one clock later.
    reg shown = 0, sign = 0;
    reg kept_back = 0;               // direction of the step that is held back
    wire asked_back = was_request & (!was_held_back | rose) ? was_request_back : kept_back;
    reg was_due = 0, was_due_back = 0, was_aim = 0;
    reg [19:0] waits = 1;
    // Number of clocks for which a step has been held back, this clock included. A step that a
    // freeze discards is not held back.
    wire [19:0] waited = rose | was_frozen ? 1 : waits;
    wire due = held_back | request;
    wire due_back = held_back ? asked_back : request_back;
    always @(posedge clock) begin
        if (has_sign) shown <= sign_back;
        sign <= shown;
        kept_back <= asked_back;
        was_due <= due;
        was_due_back <= due_back;
        was_aim <= due ? due_back : shown;
        waits <= held_back ? more(waited) : 1;
    end
    wire [19:0] longest = STEP_HIGH + STEP_LOW > DIR_SETUP + DIR_HOLD ? STEP_HIGH + STEP_LOW : DIR_SETUP + DIR_HOLD;

    // ---- A rate that fits the pin timing: requests are STEP_HIGH + STEP_LOW apart, V changes its sign at least DIR_HOLD
    // after a step and DIR_SETUP before the next one, and there is no freeze.

    reg fits = 1;
    reg [19:0] last_request = LONG, last_sign = 0;
    wire [19:0] since_sign = shown != sign ? 0 : last_sign;
    wire fits_now = fits & !frozen & (shown == sign | last_request >= DIR_HOLD)
        & (!request | (last_request >= STEP_HIGH + STEP_LOW & request_back == shown & since_sign >= DIR_SETUP));
    always @(posedge clock) begin
        fits <= fits_now;
        last_request <= request ? 1 : more(last_request);
        last_sign <= more(since_sign);
    end

    // ---- The promises.

    always_comb begin
        promise_1_step_high: assert (!fell || highs >= STEP_HIGH);
        promise_2_step_low: assert (!rose || lows >= STEP_LOW);
        promise_3_dir_setup: assert (!rose || since_dir_change >= DIR_SETUP);
        promise_4_dir_hold: assert (!turned || since_rise >= DIR_HOLD);

        promise_5_no_new_edge: assert (!was_frozen || !rose);
        promise_5_dir_stays: assert (!was_frozen || !turned);
        promise_5_never_left_high: assert (!step || highs < STEP_HIGH);

        promise_6_nothing_lost: assert (made_now + held_back + given_up_now == asked);
        promise_6_one_at_a_time: assert (discarded == was_discarded || discarded == was_discarded + 3'd1);
        promise_6_second_is_overrun: assert (was_overruns == (was_second && !rose));
        promise_6_only_a_freeze_discards: assert (discarded == was_discarded || was_frozen || was_overruns);
        promise_6_freeze_owes_nothing: assert (!was_frozen || !held_back || was_request);

        promise_7_pulses_as_counted: assert (position == place_now[2:0]);

        promise_9_no_overrun: assert (!fits_now || !overruns);
        promise_9_never_late: assert (!fits || rose == was_request && !held_back);

        promise_11_first_clock_allowed: assert (rose == (was_due && !was_frozen && was_dir == was_due_back
            && last_rise >= STEP_HIGH + STEP_LOW && last_dir_change >= DIR_SETUP));
        promise_11_dir_follows: assert (turned == (!was_frozen && was_dir != was_aim && last_rise >= DIR_HOLD));
        promise_11_bound: assert (!held_back || waited <= longest);

        promise_13_inactive: assert (!first_clock || {step, dir, held_back, overruns & !request, counts} == 0);
    end

    // ---- The invariants that make the promises inductive: while the counters of the pulser count,
    // they agree with the counters above.

    (* inside = "dut.since" *) wire [16:0] since;
    (* inside = "dut.after" *) wire [15:0] after;
    (* inside = "dut.busy" *) wire busy;
    (* inside = "dut.held" *) wire held;
    (* inside = "dut.settled" *) wire settled;
    (* inside = "dut.want" *) wire want;
    (* inside = "dut.due_back" *) wire held_back_dir;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (step == (busy && since < STEP_HIGH) && (!step || highs == since));
        invariant_2: assert (busy ? since_rise == since && since <= STEP_HIGH + STEP_LOW - 2 : since_rise >= STEP_HIGH + STEP_LOW - 1);
        invariant_3: assert (step || (busy ? lows == since - STEP_HIGH : lows >= STEP_LOW - 1));
        invariant_4: assert (held ? since_rise == since && since + 2 <= DIR_HOLD : since_rise >= DIR_HOLD - 1);
        invariant_5: assert (DIR_SETUP == 1 || (settled ? since_dir_change >= DIR_SETUP - 1 : since_dir_change == after && after <= DIR_SETUP - 2));
        invariant_6: assert (want == shown);
        invariant_7: assert (!held_back || held_back_dir == asked_back);

        invariant_8: assert (!held_back || !busy || waited <= since + 1);
        invariant_9: assert (!held_back || settled || DIR_SETUP == 1 || dir != held_back_dir || waited <= DIR_HOLD + after + 1);
        invariant_10: assert (!held_back || dir == held_back_dir || (held ? waited <= since + 1 : waited <= DIR_HOLD));

        invariant_11: assert (!fits || dir == sign);
        invariant_12: assert (!fits || !busy || last_request <= since + 1);
        invariant_13: assert (!fits || !held || last_request <= since + 1);
        invariant_14: assert (!fits || settled || DIR_SETUP == 1 || last_sign <= after + 1);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_1_2_tightest_pulses: cover (rose && lows == STEP_LOW && last_rise == STEP_HIGH + STEP_LOW);
        cover_3_tightest_dir_setup: cover (rose && last_dir_change == DIR_SETUP && dir);
        cover_4_tightest_dir_hold: cover (turned && last_rise == DIR_HOLD);
        cover_5_pulse_completes_frozen: cover (fell && was_frozen && position == 1);
        cover_6_two_discarded: cover (discarded == 2 && overruns);
        cover_7_backward: cover (position == 7);
        cover_9_reversal_that_fits: cover (fits && made_now == 2 && position == 0);
        cover_11_longest_wait: cover (rose && waits == longest);
    end
endmodule

// Proves promises 1 to 7, 9, 11 and 13 of the shaper on the pins of one axis, for any inputs and
// without a bound on time.
//
//   parameters   STEP_HIGH, STEP_LOW, DIR_SETUP, DIR_HOLD: the pin timing in clocks
//                `DUT: the name of the exported shaper, built with this timing
//   assumptions  An overrun freezes the axis, and only a frozen axis is cleared (proved in
//                core/promises.sv).
//
// The promises refer to the pins and to counters in this file, not to the timers of the shaper.

module promises (
    input wire clock,
    input wire frozen,
    input wire clear,
    input wire request,
    input wire request_back,
    input wire want_fwd,
    input wire want_back
);
    localparam [19:0] STEP_HIGH = `STEP_HIGH, STEP_LOW = `STEP_LOW, DIR_SETUP = `DIR_SETUP, DIR_HOLD = `DIR_HOLD, LONG = 20'hfffff;

    wire step, dir, held_back, overrun;
    wire [31:0] position, discarded;
    `DUT dut (.*);

    always_comb begin
        assume (frozen || !overrun);
        assume (frozen || !clear);
    end

    // ---- Values of the clock before.

    reg first_clock = 1;
    reg was_step = 0, was_dir = 0, was_frozen = 0, was_request = 0, was_second = 0, was_overrun = 0;
    reg [31:0] was_discarded = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        was_step <= step;
        was_dir <= dir;
        was_frozen <= frozen;
        was_request <= request;
        was_second <= held_back & request & !frozen;
        was_overrun <= overrun;
        was_discarded <= discarded;
    end
    wire rose = step & !was_step;
    wire fell = !step & was_step;
    wire turned = dir != was_dir;

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

    // ---- The numbers of requested and made steps, and the position.

    reg [31:0] asked = 0, made = 0, place = 0;
    wire [31:0] made_now = made + rose;
    wire [31:0] place_now = !rose ? place : dir ? place - 1 : place + 1;
    always @(posedge clock) begin
        asked <= asked + request;
        made <= made_now;
        place <= place_now;
    end

    // ---- The step that is due, the direction that DIR should have, and the number of clocks for
    // which a step has been held back (`held_back`).

    reg sign = 0;                    // the direction of the last V that was not 0
    reg asked_back = 0;              // the direction of the last step that was requested
    reg was_due = 0, was_due_back = 0, was_aim = 0;
    reg [19:0] waits = 1;
    // Number of clocks for which a step has been held back, this clock included.
    wire [19:0] waited = rose ? 1 : waits;
    wire sign_now = want_back ? 1 : want_fwd ? 0 : sign;
    wire due = held_back | request;
    wire due_back = held_back ? asked_back : request_back;
    always @(posedge clock) begin
        sign <= sign_now;
        if (request) asked_back <= request_back;
        was_due <= due;
        was_due_back <= due_back;
        was_aim <= due ? due_back : sign_now;
        waits <= held_back ? more(waited) : 1;
    end
    wire [19:0] longest = STEP_HIGH + STEP_LOW > DIR_SETUP + DIR_HOLD ? STEP_HIGH + STEP_LOW : DIR_SETUP + DIR_HOLD;

    // ---- A rate that fits the pin timing: requests are STEP_HIGH + STEP_LOW apart, V changes its sign at least DIR_HOLD
    // after a step and DIR_SETUP before the next one, and there is no freeze.

    reg fits = 1;
    reg [19:0] last_request = LONG, last_sign = 0;
    wire [19:0] since_sign = sign_now != sign ? 0 : last_sign;
    wire fits_now = fits & !frozen & (sign_now == sign | last_request >= DIR_HOLD)
        & (!request | (last_request >= STEP_HIGH + STEP_LOW & request_back == sign_now & since_sign >= DIR_SETUP));
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
        promise_5_never_left_high: assert (!step || highs < STEP_HIGH);

        promise_6_nothing_lost: assert (made_now + held_back + discarded == asked);
        promise_6_second_is_overrun: assert (!was_second || rose || overrun);
        promise_6_overrun_is_second: assert (!overrun || was_overrun || was_second && !rose);
        promise_6_only_a_freeze_discards: assert (discarded == was_discarded || was_frozen || overrun);
        promise_6_freeze_owes_nothing: assert (!was_frozen || !held_back);

        promise_7_position: assert (position == place_now);

        promise_9_no_overrun: assert (!fits || !overrun);
        promise_9_never_late: assert (!fits || rose == was_request && !held_back);

        promise_11_first_clock_allowed: assert (rose == (was_due && !was_frozen && was_dir == was_due_back
            && last_rise >= STEP_HIGH + STEP_LOW && last_dir_change >= DIR_SETUP));
        promise_11_dir_follows: assert (turned == (!was_frozen && was_dir != was_aim && last_rise >= DIR_HOLD));
        promise_11_bound: assert (!held_back || overrun || waited <= longest);

        promise_13_inactive: assert (!first_clock || {step, dir, held_back, overrun, position, discarded} == 0);
    end

    // ---- The invariants that make the promises inductive: the timers of the shaper agree with the
    // counters above.

    (* inside = "dut.busy" *) wire [16:0] busy;
    (* inside = "dut.hold" *) wire [15:0] hold;
    (* inside = "dut.setup" *) wire [15:0] setup;
    (* inside = "dut.want" *) wire want;
    (* inside = "dut.due_back" *) wire held_back_dir;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (step ? highs == STEP_HIGH + STEP_LOW - 1 - busy : busy == 0 ? lows >= STEP_LOW - 1 : lows == STEP_LOW - 1 - busy);
        invariant_2: assert (busy == 0 ? since_rise >= STEP_HIGH + STEP_LOW - 1 : since_rise == STEP_HIGH + STEP_LOW - 1 - busy);
        invariant_3: assert (hold == 0 ? since_rise >= DIR_HOLD - 1 : since_rise == DIR_HOLD - 1 - hold);
        invariant_4: assert (setup == 0 ? since_dir_change >= DIR_SETUP - 1 : since_dir_change == DIR_SETUP - 1 - setup);
        invariant_5: assert (want == sign);
        invariant_6: assert (!held_back || overrun || held_back_dir == asked_back);

        invariant_7: assert (!held_back || overrun || busy == 0 || waited <= STEP_HIGH + STEP_LOW - busy);
        invariant_8: assert (!held_back || overrun || setup == 0 || dir != held_back_dir || waited <= DIR_SETUP + DIR_HOLD - setup);
        invariant_9: assert (!held_back || overrun || dir == held_back_dir || waited <= DIR_HOLD - hold);

        invariant_10: assert (!fits || dir == sign);
        invariant_11: assert (!fits || busy == 0 || last_request <= STEP_HIGH + STEP_LOW - busy);
        invariant_12: assert (!fits || hold == 0 || last_request <= DIR_HOLD - hold);
        invariant_13: assert (!fits || setup == 0 || last_sign <= DIR_SETUP - setup);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_1_2_tightest_pulses: cover (rose && lows == STEP_LOW && last_rise == STEP_HIGH + STEP_LOW);
        cover_3_tightest_dir_setup: cover (rose && last_dir_change == DIR_SETUP && dir);
        cover_4_tightest_dir_hold: cover (turned && last_rise == DIR_HOLD);
        cover_5_pulse_completes_frozen: cover (fell && was_frozen && position == 1);
        cover_6_two_discarded: cover (discarded == 2 && overrun);
        cover_7_backward: cover (position == 32'hffffffff);
        cover_9_reversal_that_fits: cover (fits && made_now == 2 && position == 0);
        cover_11_longest_wait: cover (rose && waits == longest);
    end
endmodule

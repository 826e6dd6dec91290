// Proves promises 5, 10, 12, 13 and 14 of the module that monitors the e-stop, the watchdog and the
// power of the drivers, without a bound on time.
//
//   parameters   ESTOP_LOW: 1 if the e-stop is active when its pin is low
//                ROUND: length of a round in ticks
//                WATCHDOG, WARM: timeout of the watchdog and enable time of the drivers in rounds
//                `DUT: the name of the exported module `supervisor`, built with these values
//   assumptions  A tick is shorter than 2^24 - 1 clocks. `resetting` and `restarts_round` occur only
//                with `ending`, `restarts_round` only at a strobe (proved in
//                resets/promises.sv).
//
// This file counts the long times in ticks, while the module counts them in rounds. So each promise
// about a time allows a difference of up to one round.

module promises (
    input wire clock,
    input wire strobe,
    input wire estop,
    input wire kick,
    input wire enable,
    input wire idle,
    input wire ending,
    input wire resetting,
    input wire restarts_round
);
    localparam [23:0] ROUND = `ROUND, WATCHDOG = `WATCHDOG, WARM = `WARM, LONG = 24'hffffff;

    wire pressed, missed, enabled, warm, begins_round;
    wire [1:0] row;
    `DUT dut (.*);

    function [23:0] more(input [23:0] count);
        more = count == LONG ? LONG : count + 1;
    endfunction

    // ---- The e-stop: the level of its pin two clocks ago, the number of clocks for which it has
    // been active, and the number of clocks since the last strobe.

    reg sync = 0, active = 0, seen = 0;
    reg [23:0] actives = 0, clocks = 0;
    always @(posedge clock) begin
        {active, sync} <= {sync, estop != `ESTOP_LOW};
        actives <= active ? more(actives) : 0;
        clocks <= strobe ? 1 : more(clocks);
        if (strobe) seen <= 1;
    end
    always_comb begin
        assume (clocks != LONG);
        assume (ending || !resetting && !restarts_round);
        assume (strobe || !restarts_round);
    end

    // ---- The tick within the round, the ticks since the last `kick`, and the ticks since
    // `enabled` was asserted. A reset starts all of them anew.

    reg first_clock = 1, was_enable = 0, was_idle = 0, was_enabled = 0, was_resetting = 0;
    reg [23:0] tick = 0, silent = 0, powered = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_enable, was_idle, was_enabled, was_resetting} <= {enable, idle, enabled, resetting};
        if (restarts_round) tick <= 0;
        else if (strobe) tick <= tick == ROUND - 1 ? 0 : tick + 1;
        silent <= kick | ending ? 0 : strobe ? more(silent) : silent;
        powered <= !enabled | ending ? 0 : strobe ? more(powered) : powered;
    end

    // ---- The promises.

    always_comb begin
        promise_5_pressed_for_a_whole_tick: assert (pressed == (seen && active && actives >= clocks));

        promise_10_not_before_its_time: assert (!missed || WATCHDOG != 0 && silent > (WATCHDOG - 1) * ROUND);
        promise_10_missed_in_time: assert (missed || WATCHDOG == 0 || silent < WATCHDOG * ROUND);

        promise_13_inactive: assert (!first_clock || {pressed, missed, enabled} == 0);

        promise_14_not_before_the_host: assert (!enabled || was_enable || was_enabled);
        promise_14_powered_where_asked: assert (!was_enable || enabled || was_resetting);
        promise_14_powered_until_idle: assert (!was_enabled || enabled || was_idle && !was_enable || was_resetting);
        promise_13_no_power_in_a_reset: assert (!was_resetting || !enabled);
        promise_14_warm_not_before_its_time: assert (!warm || WARM == 0 || powered > (WARM - 1) * ROUND);
        promise_14_warm_is_powered: assert (!warm || enabled);
        promise_14_warm_in_time: assert (warm || !enabled || powered < WARM * ROUND);

        promise_12_one_round_for_all: assert (begins_round == (tick < 4) && row == tick[1:0]);
    end

    // ---- The invariants that make the promises inductive: a time in ticks agrees with the
    // module's whole rounds and the ticks of the present round.

    (* inside = "dut.sync" *) wire dut_sync;
    (* inside = "dut.now" *) wire dut_now;
    (* inside = "dut.held" *) wire held;
    (* inside = "dut.round" *) wire [9:0] round;
    (* inside = "dut.silence" *) wire [11:0] silence;
    (* inside = "dut.warmth" *) wire [11:0] warmth;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert ({dut_sync, dut_now} == {sync, active} && held == (seen && actives >= clocks));
        invariant_2: assert (clocks != 0 || !seen && actives == 0);
        invariant_3: assert (round == tick && tick < ROUND);
        invariant_4: assert (silence <= WATCHDOG && warmth <= WARM);
        invariant_5: assert (silence == 0 ? silent <= tick || WATCHDOG == 0
            : silent >= (silence - 1) * ROUND + tick + 1 || silence == WATCHDOG && silent > (WATCHDOG - 1) * ROUND);
        invariant_6: assert (silence == WATCHDOG || silent <= silence * ROUND + tick);
        invariant_7: assert (warmth == 0 || powered >= (warmth - 1) * ROUND + tick + 1
            || warmth == WARM && powered > (WARM - 1) * ROUND);
        invariant_8: assert (warmth == WARM || powered <= warmth * ROUND + tick);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    reg heard = 0, was_warm = 0;
    always @(posedge clock) begin
        heard <= heard | missed & kick;
        was_warm <= was_warm | warm & enabled;
    end
    always_comb begin
        cover_5_pressed: cover (strobe && pressed);
        cover_10_missed_then_heard: cover (heard && !missed);
        cover_14_warm: cover (warm && enabled);
        cover_14_cold_again: cover (was_warm && !enabled);
    end
endmodule

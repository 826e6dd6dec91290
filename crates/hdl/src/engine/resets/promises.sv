// Proves promises 5 and 13 of the module that controls a reset, without a bound on time.
//
//   parameters   `DUT: the name of the exported module `resets`
//   assumptions  none: the inputs are free.

module promises (
    input wire clock,
    input wire strobe,
    input wire reset,
    input wire settled,
    input wire pins_busy
);
    wire ending, stage_1, stage_2, resetting, completes, restarts_round;
    `DUT dut (.*);

    // ---- The reset as docs/clock-by-clock.md specifies it.

    reg asked = 0;
    reg [1:0] stage = 0;
    always @(posedge clock) begin
        if (reset) asked <= 1;
        if (strobe && asked) begin
            if (stage == 0 && settled && !pins_busy) stage <= 1;
            if (stage == 1) stage <= 2;
            if (stage == 2 && !reset) begin
                stage <= 0;
                asked <= 0;
            end
        end
    end

    reg first_clock = 1, was_reset = 0, was_resetting = 0, was_quiet = 0, was_completes = 0, was_strobe = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_reset, was_resetting, was_completes, was_strobe} <= {reset, resetting, completes, strobe};
        was_quiet <= settled & !pins_busy;
    end

    // ---- The promises.

    always_comb begin
        promise_5_reset_freezes: assert (!was_reset || ending);
        promise_5_frozen_until_complete: assert (ending == asked);

        promise_13_only_at_rest: assert (!resetting || was_resetting || was_strobe && was_quiet);
        promise_13_stages: assert ({stage_2, stage_1} == stage && resetting == (stage != 0));
        promise_13_completes: assert (completes == (strobe && stage == 2 && !reset));
        promise_13_round: assert (restarts_round == (asked && strobe && stage != 1));
        promise_13_complete_is_over: assert (!was_completes || !ending && !resetting);
        promise_13_inactive: assert (!first_clock || !ending && !resetting);
    end

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (stage != 3 && (stage == 0 || asked));
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_13_complete: cover (was_completes && !reset);
        cover_13_held: cover (stage == 2 && was_strobe && was_reset && was_resetting);
    end
endmodule

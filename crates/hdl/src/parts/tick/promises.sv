// The tick: the beat that promise 11 counts in, and promise 13. Without bound.
//
//   from outside   CLOCKS in a tick, PHASES in a tick; `DUT, the exported tick with these numbers
//   assumed        nothing
//
// A strobe in the last clock of each tick, Q equal phases between, for ever.

module promises (
    input wire clock
);
    localparam [16:0] CLOCKS = `CLOCKS, PHASE_CLOCKS = `CLOCKS / `PHASES;

    wire strobe, phase_start;
    wire [3:0] phase;
    `DUT dut (.*);

    // ---- The clock in its tick, counted from configuration.

    reg first_clock = 1;
    reg [16:0] clock_of_tick = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        clock_of_tick <= clock_of_tick == CLOCKS - 1 ? 0 : clock_of_tick + 1;
    end

    // ---- The promises.

    always_comb begin
        promise_11_strobe_ends_the_tick: assert (strobe == (clock_of_tick == CLOCKS - 1));
        promise_11_phases_are_equal: assert (phase == clock_of_tick / PHASE_CLOCKS);
        promise_11_phase_start: assert (phase_start == (clock_of_tick % PHASE_CLOCKS == 0));
        promise_13_inactive: assert (!first_clock || !strobe && phase == 0);
    end

    // ---- Why they hold: phase and clock of the phase are the clock of the tick.

    (* inside = "dut.sub" *) wire [15:0] sub;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (clock_of_tick < CLOCKS && sub < PHASE_CLOCKS);
        invariant_2: assert (clock_of_tick == phase * PHASE_CLOCKS + sub);
    end
`endif

    // ---- None of it is empty.

    reg ticked = 0;
    always @(posedge clock) ticked <= ticked | strobe;
    always_comb begin
        cover_11_second_tick: cover (ticked && strobe);
    end
endmodule

// Proves promise 13 of the tick counter, and the ticks and phases in which promise 11 is expressed,
// without a bound on time.
//
//   parameters   CLOCKS, PHASES: clocks and phases in a tick
//                `DUT: the name of the exported tick counter, built with these values
//   assumptions  none
//
// The strobe is asserted in the last clock of each tick, and each tick has PHASES phases of equal
// length.

module promises (
    input wire clock
);
    localparam [16:0] CLOCKS = `CLOCKS, PHASE_CLOCKS = `CLOCKS / `PHASES;

    wire strobe, phase_start;
    wire [3:0] phase;
    `DUT dut (.*);

    // ---- The clock within the tick, counted from configuration.

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

    // ---- The invariants that make the promises inductive: the phase and the clock within the
    // phase give the clock within the tick.

    (* inside = "dut.sub" *) wire [15:0] sub;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (clock_of_tick < CLOCKS && sub < PHASE_CLOCKS);
        invariant_2: assert (clock_of_tick == phase * PHASE_CLOCKS + sub);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    reg ticked = 0;
    always @(posedge clock) ticked <= ticked | strobe;
    always_comb begin
        cover_11_second_tick: cover (ticked && strobe);
    end
endmodule

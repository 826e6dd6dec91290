// Proves promises 13 and 17 of the PWM, without a bound on time: its pin is active for the duty.
//
//   parameters   DIVIDER: number of clocks of a step; 0: no PWM
//                `DUT: the name of the exported module `pulse_width`, built with this value
//   assumptions  none

module promises (
    input wire clock,
    input wire set,
    input wire [11:0] duty,
    input wire off
);
    localparam [8:0] DIVIDER = `DIVIDER;
    localparam EXISTS = DIVIDER != 0;

    wire pin;
    `DUT dut (.*);

    // ---- The clock of the period, as step and clock of the step, and the duty in force.

    reg first_clock = 1;
    reg [8:0] of_step = 0;
    reg [11:0] step = 0, width = 0;
    reg was_below = 0, was_off = 0, was_pin = 0;
    wire below = EXISTS & step < width;
    wire step_ends = of_step + 1 == DIVIDER;
    always @(posedge clock) begin
        first_clock <= 0;
        of_step <= step_ends ? 0 : of_step + 1;
        if (step_ends) step <= step + 1;
        width <= off ? 0 : set ? duty : width;
        {was_below, was_off, was_pin} <= {below, off, pin};
    end

    // ---- The promises.

    always_comb begin
        promise_13_inactive: assert (!first_clock || !pin);
        promise_17_pin_for_the_duty: assert (pin == (was_below & !was_off));
        promise_17_off: assert (!was_off || !pin);
    end

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.divided" *) wire [7:0] divided;
    (* inside = "dut.count" *) wire [11:0] count;
    (* inside = "dut.width" *) wire [11:0] dut_width;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (!EXISTS || of_step < DIVIDER && divided == of_step[7:0] && count == step && dut_width == width);
        invariant_2: assert (EXISTS || {divided, count, dut_width} == 0);
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_17_falls_with_the_duty: cover (was_pin && !pin && !was_off && width == 2);
        cover_17_off: cover (was_off && was_pin);
    end
endmodule

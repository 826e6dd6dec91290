// Proves promises 6, 11 and 13 of the edge, without a bound on time: each carry becomes one
// request, in the phase in which the carry occurs.
//
//   parameters   CLOCKS, PHASES: clocks and phases in a tick
//                `DUT: the name of the exported edge
//                The exported module carrystep_tick generates the strobe and the phases.
//   assumptions  The module is cleared only while it is frozen and no step is in flight (proved in
//                core/promises.sv).
//
// The phase is that of docs/clock-by-clock.md, written here as one function of P and V.

module promises (
    input wire clock,
    input wire frozen,
    input wire clear,
    input wire crosses,
    input wire [31:0] p,
    input wire [31:0] v
);
    localparam CLOCKS = `CLOCKS, PHASES = `PHASES, PHASE_CLOCKS = CLOCKS / PHASES, ROUNDS = $clog2(PHASES);

    wire strobe, phase_start;
    wire [3:0] phase;
    carrystep_tick beat (.*);

    wire backward = v[31];
    wire forward = !backward & v != 0;
    wire request, request_back, want_fwd, want_back, in_flight, crossed, back;
    wire [3:0] q;
    `DUT dut (.*);

    always_comb begin
        assume (!clear || frozen && !in_flight);
    end

    // ---- The clock within the tick, counted from configuration.

    reg first_clock = 1;
    reg [16:0] clock_of_tick = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        clock_of_tick <= clock_of_tick == CLOCKS - 1 ? 0 : clock_of_tick + 1;
    end

    // ---- The definition of the phase: the value of p and the bits of the phase after a number of
    // bisection steps.

    function [35:0] bisected(input [31:0] from, input [31:0] speed, input [2:0] rounds);
        integer k;
        reg [32:0] trial;
        reg [31:0] at;
        reg [3:0] bits;
        begin
            at = from;
            bits = 0;
            for (k = 1; k <= ROUNDS; k = k + 1) begin
                trial = {1'b0, at} + {1'b0, $unsigned($signed(speed) >>> k)};
                if (k <= rounds && trial[32] == speed[31]) begin
                    at = trial[31:0];
                    bits = bits | (1 << (ROUNDS - k));
                end
            end
            bisected = {at, bits};
        end
    endfunction

    // ---- The last tick that was added (`new_*`), and the tick before it, which is emitted now
    // (`due_*`).

    reg new_crossed = 0, new_back = 0, new_fwd = 0, new_sign_back = 0;
    reg [31:0] new_p = 32'hffffffff, new_v = 32'h7fffffff;   // values that give phase 0
    reg [2:0] rounds = ROUNDS;
    wire [31:0] new_at;
    wire [3:0] new_q;
    assign {new_at, new_q} = bisected(new_p, new_v, rounds);

    reg due = 0, due_back = 0, due_fwd = 0, due_sign_back = 0, done = 0;
    reg [3:0] due_q = 0;
    always @(posedge clock) begin
        if (rounds < ROUNDS) rounds <= rounds + 1;
        if (request) done <= 1;
        if (strobe) begin
            {due, due_back, due_q, done} <= {new_crossed, new_back, new_q, 1'b0};
            {due_fwd, due_sign_back} <= {new_fwd, new_sign_back};
            {new_crossed, new_fwd, new_sign_back} <= frozen ? 3'd0 : {crosses, forward, backward};
            if (!frozen) {new_back, new_p, new_v, rounds} <= {backward, p, v, 3'd0};
        end
        if (clear) {new_fwd, new_sign_back, due_fwd, due_sign_back} <= 0;
    end

    // ---- The numbers of carries and of requests.

    reg [31:0] carries = 0, requests = 0;
    always @(posedge clock) begin
        carries <= carries + (strobe & crosses & !frozen);
        requests <= requests + request;
    end

    wire bisection_over = rounds == ROUNDS;

    // ---- The promises.

    always_comb begin
        promise_6_nothing_lost: assert (carries == requests + new_crossed + (due & !done));
        promise_6_in_flight: assert (in_flight == (new_crossed | due));
        promise_11_at_its_phase: assert (request == (due && clock_of_tick == due_q * PHASE_CLOCKS));
        promise_11_direction: assert (request_back == due_back && {want_fwd, want_back} == {due_fwd, due_sign_back});
        promise_11_phase_as_defined: assert (!bisection_over || q == new_q);
        promise_11_over_in_time: assert (!strobe || bisection_over);
        promise_13_inactive: assert (!first_clock || {request, want_fwd, want_back, in_flight} == 0);
    end

    // ---- The invariants that make the promises inductive: each step of the bisection is that of
    // the definition.

    (* inside = "beat.sub" *) wire [15:0] sub;
    (* inside = "dut.bisect_p" *) wire [31:0] bisect_p;
    (* inside = "dut.bisect_v" *) wire [31:0] bisect_v;
    (* inside = "dut.weight" *) wire [3:0] weight;
    (* inside = "dut.emit" *) wire emit;
    (* inside = "dut.emit_q" *) wire [3:0] emit_q;
    (* inside = "dut.sign_fwd" *) wire sign_fwd;
    (* inside = "dut.sign_back" *) wire sign_back;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (sub < PHASE_CLOCKS && clock_of_tick == phase * PHASE_CLOCKS + sub);
        invariant_2: assert (phase < PHASES);
        invariant_3: assert (rounds <= ROUNDS && (rounds == clock_of_tick || bisection_over));
        invariant_4: assert (weight == (PHASES >> 1 >> rounds));
        invariant_5: assert (q == new_q);
        invariant_6: assert (bisection_over || bisect_p == new_at);
        invariant_7: assert (bisection_over || bisect_v == $unsigned($signed(new_v) >>> rounds));
        invariant_8: assert (crossed == new_crossed && (back == new_back) && new_back == new_v[31]);
        invariant_9: assert ({sign_fwd, sign_back} == {new_fwd, new_sign_back});
        invariant_10: assert (emit == due && emit_q == due_q && due_q < PHASES);
        invariant_11: assert (done == (due && clock_of_tick > due_q * PHASE_CLOCKS));
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_6_two_in_flight: cover (new_crossed && due && !done);
        cover_11_last_phase: cover (request && due_q == PHASES - 1 && !request_back);
        cover_11_backward: cover (request && request_back && want_back);
    end
endmodule

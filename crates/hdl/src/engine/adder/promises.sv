// Proves promises 6, 7, 10, 11, 13 and 15 of the adder, without a bound on time: the sums of a time
// slot are those of the words that the memory delivers in this time slot.
//
//   parameters   `DUT: the name of the exported adder
//   assumptions  The beats of a time slot follow one another, and the next one begins at once or at
//                least two clocks later (proved in time_slot/promises.sv). From beat 6 on, counts,
//                lost, wipe and forgets do not change within a time slot.
//
// The memory delivers the low halves of A, J, V and P first and their high halves later. This file
// joins the halves and computes the expected sums in 64 bits.

module promises (
    input wire clock,
    input wire [16:0] beat,
    input wire [31:0] word,
    input wire [31:0] put,
    input wire counts,
    input wire lost,
    input wire up,
    input wire down,
    input wire wipe,
    input wire forgets
);
    wire [31:0] sum;
    wire ended, overflow, turned, crosses, back, still, least;
    wire [3:0] q;
    `DUT dut (.*);

    // ---- The beats of a time slot, one after the other, and the words that arrive in them.

    reg first_clock = 1;
    reg [16:0] was_beat = 0;
    reg [31:0] low_a = 0, low_j = 0, low_v = 0, low_p = 0, n = 0, pos = 0, high_j = 0, high_a = 0, high_v = 0, high_p = 0;
    reg [31:0] was_put = 0, tick = 0;
    // After a time slot that no other one follows at once: the sum of this clock, and of the clock
    // before, is the number of the tick + 1.
    reg counts_tick = 0, had_counted = 0;
    reg was_counts = 0, was_lost = 0, added = 0, subtracted = 0, was_wipe = 0, was_forgets = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        was_beat <= beat;
        {was_counts, was_lost, was_wipe, was_forgets} <= {counts, lost, wipe, forgets};
        if (beat[1]) low_a <= word;
        if (beat[2]) low_j <= word;
        if (beat[3]) low_v <= word;
        if (beat[4]) low_p <= word;
        if (beat[5]) n <= word;
        if (beat[6]) {pos, added, subtracted} <= {word, up, down};
        if (beat[7]) {high_j, was_put} <= {word, put};
        if (beat[8]) high_a <= word;
        if (beat[9]) high_v <= word;
        if (beat[10]) high_p <= word;
        if (beat[13]) tick <= word;
        {had_counted, counts_tick} <= {counts_tick, beat[15] & !beat[2]};
    end
    always_comb begin
        assume ((beat[12:0] & (beat[12:0] - 1)) == 0 && beat[16:1] == was_beat[15:0]);
        assume (was_beat[11:5] == 0 || {counts, lost, wipe, forgets} == {was_counts, was_lost, was_wipe, was_forgets});
        assume (!(lost && counts) && !(up && down));
        assume (!(beat[0] && beat[14]));
    end

    wire [63:0] a = {high_a, low_a}, j = {high_j, low_j}, v = {high_v, low_v}, p = {high_p, low_p};
    wire signed [64:0] faster = $signed({v[63], v}) + $signed({a[63], a});
    wire [64:0] further = {1'b0, p} + {1'b0, v};
    wire [63:0] next_a = a + j;
    wire [31:0] counted = n - counts + lost;

    // ---- The promises.

    always_comb begin
        promise_6_a_plus_j: assert ((!beat[4] || sum == low_a + low_j) && (!beat[10] || sum == next_a[63:32]));
        promise_6_v_plus_a: assert ((!beat[5] || sum == low_a + low_v) && (!beat[11] || sum == faster[63:32]));
        promise_6_p_plus_v: assert ((!beat[6] || was_wipe || sum == low_p + low_v)
            && (!beat[12] || wipe || sum == further[63:32]));
        promise_6_wiped: assert ((!beat[6] || !was_wipe || sum == 0) && (!beat[12] || !wipe || sum == 0));
        promise_6_carry_is_a_step: assert (!beat[12] || crosses == (v[63] ? !further[64] : further[64]));
        promise_6_overspeed: assert (!beat[12] || overflow == (faster[64] != faster[63]));
        promise_6_least: assert (!beat[12] || least == (v == 64'h8000_0000_0000_0000));
        promise_6_ticks_and_discarded: assert (!beat[7] || sum == (was_forgets ? 0 : counted));
        promise_6_over_after_the_last_tick: assert (!beat[12] || !counts || ended == (n == 0));
        promise_6_put_as_it_is: assert (!beat[9] || sum == was_put);
        promise_7_position: assert (!beat[8] || sum == pos + added - subtracted);
        promise_10_ramp_turns_where_the_sign_does: assert (!beat[12] || turned == (faster[63] != v[63]));
        promise_11_sign: assert (!beat[12] || {back, still} == {v[63], v == 0});
        promise_11_direction_stays: assert (beat[12] || first_clock || back == was_back);
        promise_11_phase_stays: assert (was_beat[16:13] != 0 || first_clock || q == was_q);
        promise_13_inactive: assert (!first_clock || {ended, overflow, turned, crosses, back, still, least, q} == 0);
    end

    always_comb begin
        promise_15_tick_is_counted: assert (!had_counted || sum == tick + 1);
    end

    reg was_back = 0;
    reg [3:0] was_q = 0;
    always @(posedge clock) {was_back, was_q} <= {back, q};

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_6_carry_between_the_halves: cover (beat[12] && crosses && low_p + low_v < low_p && high_v == 0);
        cover_6_overspeed: cover (beat[12] && overflow && !back);
        cover_7_step_back: cover (beat[8] && subtracted && sum == 32'hffffffff);
        cover_15_counts_a_tick_that_wraps: cover (had_counted && sum == 0);
        cover_15_next_tick_has_begun: cover (counts_tick && beat[1]);
        cover_11_least: cover (beat[12] && least);
    end
endmodule

// Proves promises 13 and 15 of the bank of latches, without a bound on time: which record a latch
// takes at its edge, and for how long it keeps it.
//
//   parameters   COUNT: number of latches of the build, 2 to 4
//                `DUT: the name of the exported module `latch_bank`, built with this number
//   assumptions  Latch 0 accepts an edge only at a strobe and while it is armed; it is armed until
//                then; and the tick after such a strobe is the one that it latches (all proved in
//                edge_latch/promises.sv).

module promises (
    input wire clock,
    input wire strobe,
    input wire [2:0] pins,
    input wire [2:0] arm,
    input wire resetting,
    input wire first_armed,
    input wire first_comes,
    input wire first_latches
);
    wire comes, latches, absent;
    wire [2:0] armed;
    wire [11:0] edges;
    wire [7:0] records;
    wire [1:0] record;
    `DUT dut (.*);

    localparam [2:0] EXIST = (3'd1 << (`COUNT - 1)) - 3'd1;

    // ---- The edges that latches 1 to 3 accept.

    (* inside = "dut.edge_latch_0_comes" *) wire comes_1;
    (* inside = "dut.edge_latch_1_comes" *) wire comes_2;
    (* inside = "dut.edge_latch_2_comes" *) wire comes_3;
    wire [3:0] accept = {comes_3, comes_2, comes_1, first_comes} & {EXIST, 1'b1};
    wire [3:0] hold = ~{armed, first_armed} & {EXIST, 1'b1};

    // ---- The clock before.

    reg first_clock = 1, was_resetting = 0, was_strobe = 0, was_first_armed = 0;
    reg [3:0] was_accept = 0, was_hold = 0;
    reg [7:0] was_records = 0;
    reg [1:0] was_record = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_resetting, was_strobe, was_first_armed} <= {resetting, strobe, first_armed};
        {was_accept, was_hold, was_records, was_record} <= {accept, hold, records, record};
    end

    // ---- The latches whose words this tick outputs.

    reg [3:0] copies = 0;
    always @(posedge clock) copies <= resetting ? 0 : strobe ? accept : copies;

    always_comb begin
        assume (!first_comes || strobe && first_armed);
        assume (first_latches == copies[0]);
        assume (!was_first_armed || first_armed || was_accept[0] || was_resetting);
        assume (!first_clock || !first_armed);
    end

    // ---- What has happened to each latch in the clock before: the record that it holds was taken
    // by another one, it has taken another record than that of this tick, or its record has changed
    // without an edge.

    wire [3:0] is_overwritten, is_apart, is_lost;
    genvar k;
    generate for (k = 0; k < 4; k = k + 1) begin : each
        assign is_overwritten[k] = was_accept != 0 && was_hold[k] && was_records[2 * k +: 2] == record;
        assign is_apart[k] = was_accept[k] && records[2 * k +: 2] != record;
        assign is_lost[k] = !was_accept[k] && records[2 * k +: 2] != was_records[2 * k +: 2];
    end endgenerate

    // ---- The promises.

    always_comb begin
        promise_13_inactive: assert (!first_clock || {latches, armed, edges, records, record} == 0);
        promise_13_reset_forgets: assert (!was_resetting || {latches, armed, edges, records, record} == 0);
        promise_15_latched_while_armed: assert ((accept & hold) == 0 && (!comes || strobe)
            && comes == (accept != 0));
        promise_15_the_tick_after_an_edge: assert (latches == (copies != 0));
        promise_15_absent_latches: assert (absent == ((arm & ~EXIST) != 0) && (armed & ~EXIST) == 0);
        promise_15_record_of_its_tick: assert (record == was_record || was_accept != 0 || was_resetting);
        promise_15_takes_no_held_record: assert (is_overwritten == 0 || was_resetting);
        promise_15_one_strobe_one_record: assert (is_apart == 0 || was_resetting);
        promise_15_kept_until_armed: assert (is_lost == 0 || was_resetting);
    end

    // ---- The invariants that make the promises inductive.

    (* inside = "dut.edge_latch_0_latches" *) wire latches_1;
    (* inside = "dut.edge_latch_1_latches" *) wire latches_2;
    (* inside = "dut.edge_latch_2_latches" *) wire latches_3;
    wire unused = &pins;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (copies[3:1] == {latches_3, latches_2, latches_1});
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_15_shared: cover (was_accept[1:0] == 2'b11);
        cover_15_apart: cover (records[1:0] != records[3:2] && records[1:0] != 0 && records[3:2] != 0);
    end
endmodule

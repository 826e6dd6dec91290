// The limit switches: promises 10, 12 and 13 of their debouncer, for any switch. Without bound.
//
//   from outside   AXES; WIRING: 0 none, 1 a pair an axis, 2 one an axis, 3 one for all; LOW; LOOKS; `DUT, the
//                  exported limits with these
//   assumed        what turn/ and watch/promises.sv prove: turns end apart, the first two ticks of a round are two
//
// All is said of one switch, `side` of axis `who`, which may be any: the runs of looks at it are counted here without a memory.

module promises (
    input wire clock,
    input wire turn_ends,
    input wire [2:0] axis,
    input wire [2:0] axis_next,
    input wire tick_0,
    input wire tick_1,
    input wire [`AXES-1:0] limit_min,
    input wire [`AXES-1:0] limit_max,
    input wire goes,
    input wire back
);
    (* anyconst *) reg [2:0] who;
    (* anyconst *) reg side;
    localparam [1:0] NONE = 0, PAIR = 1, EACH = 2, ONE = 3, WIRING = `WIRING;
    localparam [7:0] LOOKS = `LOOKS;

    wire [`AXES-1:0] lane = 32'd1 << axis;
    wire hit;
    `DUT dut (.*);

    reg first_clock = 1, was_min = 0, was_max = 0, was_turn_ends = 0;
    reg [2:0] was_next = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_min, was_max, was_next, was_turn_ends} <= {tick_0, tick_1, axis_next, turn_ends};
    end
    always_comb begin
        assume (!tick_0 || !tick_1);
        assume (who < `AXES && (side == 0 || WIRING == PAIR));
        assume (axis == was_next && (!turn_ends || !was_turn_ends && axis < `AXES));
        // A round's tick changes in the clock after a strobe, where no turn ends.
        assume (!turn_ends || !first_clock && {tick_0, tick_1} == {was_min, was_max});
    end

    // ---- The pin of the axis whose turn it is, as it was two clocks ago.

    wire max = tick_1 & WIRING == PAIR;
    wire [`AXES-1:0] pins = max ? limit_max : limit_min;
    wire pin = (WIRING == ONE ? pins[0] : |(pins & lane)) != `LOW;
    reg sync = 0, seen = 0;
    always @(posedge clock) {seen, sync} <= {sync, pin};

    // ---- Looks at the switch, and what is believed of it.

    wire looks = WIRING != NONE & turn_ends & (max ? side : tick_0 & !side) & axis == who;
    reg believed = 0;
    reg [7:0] against = 0;           // equal looks that say otherwise, up to now
    wire differs = seen != believed;
    wire flips = looks & differs & against + 1 == LOOKS;
    wire believed_now = believed ^ flips;
    always @(posedge clock) begin
        if (looks) {believed, against} <= {believed_now, differs & !flips ? against + 8'd1 : 8'd0};
    end
    wire any_look = turn_ends & (tick_0 | max);

    // ---- The promises.

    always_comb begin
        promise_10_hits_only_where_it_looks: assert (!hit || any_look && goes && WIRING != NONE);
        promise_10_stops_by_direction: assert (WIRING != PAIR || !looks || hit == (goes & believed_now & back == !side));
        promise_10_stops_as_it_is_reached: assert (WIRING == PAIR || !looks || hit == (goes & flips & believed_now));
        promise_10_believed_after_equal_looks: assert (against < LOOKS && (!flips || looks));
        promise_12_own_switch_only: assert (memory == was_memory || was_looks);
        promise_13_inactive: assert (!first_clock || !hit || turn_ends);
    end

    reg was_looks = 0;
    reg [7:0] was_memory = 0;
    always @(posedge clock) {was_looks, was_memory} <= {looks, memory};

    // ---- Why they hold: its word in memory, seen through a port of its own.

    wire [7:0] memory;
    look #("\\dut.switches.words", 4, 8) at_switches (1'b0, 1'b1, {who, side}, memory);
    (* inside = "dut.now" *) wire now;
    (* inside = "dut.sync" *) wire dut_sync;
    (* inside = "dut.word" *) wire [7:0] word;
    // Its word was read in the last clock.
    wire looked_up = !first_clock & was_next == who & (was_max & WIRING == PAIR) == side;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (memory == {believed, against[6:0]} && against < LOOKS);
        invariant_2: assert (!looked_up || was_turn_ends || word == memory);
        invariant_3: assert ({dut_sync, now} == {sync, seen});
    end
`endif

    // ---- None of it is empty.

    always_comb begin
        cover_10_hit: cover (hit && looks);
        cover_12_let_go: cover (!believed && against == 0 && was_looks && was_memory[7]);
    end
endmodule

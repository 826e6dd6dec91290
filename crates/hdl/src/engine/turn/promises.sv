// Whose turn it is: promises 11, 12 and 13 of the schedule. Without bound.
//
//   from outside   AXES; CLOCKS, the fewest from strobe to strobe; `DUT, the exported turn
//   assumed        what wheel/promises.sv proves: a tick is never shorter
//
// In every tick each axis has one turn of 13 beats, axis 0 in the clock after the strobe, and no two at once.

module promises (
    input wire clock,
    input wire strobe
);
    localparam [16:0] AXES = `AXES, CLOCKS = `CLOCKS, TURN = 13, TURNS = TURN * AXES;

    wire [16:0] beat;
    wire [2:0] axis, axis_next;
    wire [`AXES-1:0] lane;
    `DUT dut (.*);

    // ---- Clocks since the strobe, and what they say.

    reg [16:0] at = TURNS;           // TURNS: all turns are over
    reg [16:0] since = CLOCKS;
    wire in_turn = at < TURNS;
    wire [16:0] number = at / TURN, clock_of_turn = at % TURN;
    always @(posedge clock) begin
        at <= strobe ? 0 : at == TURNS ? at : at + 1;
        since <= strobe ? 1 : since == CLOCKS ? since : since + 1;
    end
    reg [3:0] tail = 0;              // four beats go on into the next turn, or past the strobe
    always @(posedge clock) tail <= {tail[2:0], in_turn & clock_of_turn == TURN - 1};
    always_comb begin
        assume (!strobe || since == CLOCKS);
    end

    // ---- What holds of beats and axes from clock to clock, as other parts assume it.

    reg first_clock = 1;
    reg [12:0] was_beat = 0;
    reg [2:0] was_next = 0, was_axis = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_beat, was_next, was_axis} <= {beat[12:0], axis_next, axis};
    end

    // ---- The promises.

    always_comb begin
        promise_11_every_axis_once_a_tick: assert (beat[12:0] == (in_turn ? 13'd1 << clock_of_turn : 0));
        promise_11_tail: assert (beat[16:13] == tail);
        promise_12_whose_turn: assert (axis == (in_turn ? number : 0));
        promise_12_lane_is_the_axis: assert (lane == 32'd1 << axis);
        promise_12_one_after_the_other: assert ((beat[12:0] & (beat[12:0] - 1)) == 0 && beat[12:1] == was_beat[11:0]
            && (first_clock ? axis == 0 : axis == was_next));
        promise_12_nothing_else_in_a_turn: assert ((beat[11:0] == 0 || axis_next == axis)
            && (!beat[12] || axis_next != axis || AXES == 1));
        promise_12_no_turn_at_a_strobe: assert (!strobe || beat[12:0] == 0);
        promise_12_a_turn_of_its_own_after_a_pause: assert (!was_beat[12] || axis != was_axis || beat[12:0] == 0);
        promise_13_inactive: assert (!first_clock || beat == 0);
    end

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (at <= TURNS && since <= CLOCKS);
        invariant_2: assert (in_turn ? since == at + 1 : since > TURNS);
        invariant_3: assert (in_turn ? was_beat == (clock_of_turn == 0 ? (at == 0 ? 0 : 13'h1000)
            : 13'd1 << (clock_of_turn - 1)) : was_beat == 0 || was_beat == 13'h1000);
        invariant_5: assert (!was_beat[12] || first_clock || was_axis == (in_turn ? number : AXES) - 1);
        invariant_4: assert (was_next == axis || first_clock);
    end
`endif

    // ---- None of it is empty.

    always_comb begin
        cover_11_second_turn: cover (beat[0] && beat[13] && axis == 1);
        cover_12_tail: cover (beat[16] && axis == 1);
    end
endmodule

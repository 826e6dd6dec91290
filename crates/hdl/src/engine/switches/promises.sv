// Proves promises 10, 12 and 13 of the debouncer of the limit switches, without a bound on time.
//
//   parameters   AXES: number of axes
//                WIRING: 0 no switches, 1 two per axis, 2 one per axis, 3 one for all axes
//                LOW: 1 if a switch is active when its pin is low
//                SAMPLES: number of samples to debounce
//                `DUT: the name of the exported module `limits`, built with these values
//   assumptions  Two time slots do not end in adjacent clocks (proved in time_slot/promises.sv). The
//                first and the second tick of a round are different (proved in supervisor/promises.sv).
//
// All statements are about one switch, `side` of axis `who`; the solver may choose any. This file
// counts the samples of this switch in registers; the module keeps its counts in a memory.

module promises (
    input wire clock,
    input wire time_slot_ends,
    input wire [2:0] axis,
    input wire [2:0] axis_next,
    input wire tick_0,
    input wire tick_1,
    input wire [`AXES-1:0] limit_min,
    input wire [`AXES-1:0] limit_max,
    input wire goes,
    input wire back,
    input wire resetting
);
    (* anyconst *) reg [2:0] who;
    (* anyconst *) reg side;
    localparam [1:0] NONE = 0, PAIR = 1, EACH = 2, ONE = 3, WIRING = `WIRING;
    localparam [7:0] SAMPLES = `SAMPLES;

    wire [`AXES-1:0] axis_one_hot = 32'd1 << axis;
    wire hit;
    `DUT dut (.*);

    reg first_clock = 1, was_min = 0, was_max = 0, was_time_slot_ends = 0;
    reg [2:0] was_next = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_min, was_max, was_next, was_time_slot_ends} <= {tick_0, tick_1, axis_next, time_slot_ends};
    end
    always_comb begin
        assume (!tick_0 || !tick_1);
        assume (who < `AXES && (side == 0 || WIRING == PAIR));
        assume (axis == was_next && (!time_slot_ends || !was_time_slot_ends && axis < `AXES));
        // tick_0 and tick_1 change in the clock after a strobe, in which no time slot ends.
        assume (!time_slot_ends || !first_clock && {tick_0, tick_1} == {was_min, was_max});
    end

    // ---- The pin of the axis of this time slot, as it was two clocks ago.

    wire max = tick_1 & WIRING == PAIR;
    wire [`AXES-1:0] pins = max ? limit_max : limit_min;
    wire pin = (WIRING == ONE ? pins[0] : |(pins & axis_one_hot)) != `LOW;
    reg sync = 0, seen = 0;
    always @(posedge clock) {seen, sync} <= {sync, pin};

    // ---- The samples of the switch (`samples`), and its debounced state (`believed`).

    wire samples = WIRING != NONE & time_slot_ends & (max ? side : tick_0 & !side) & axis == who;
    reg believed = 0;
    // Number of consecutive samples, up to now, that differ from the debounced state.
    reg [7:0] against = 0;
    wire differs = seen != believed;
    wire flips = samples & differs & against + 1 == SAMPLES;
    wire believed_now = (believed ^ flips) & !resetting;
    always @(posedge clock) begin
        if (samples) {believed, against} <= {believed_now, differs & !flips & !resetting ? against + 8'd1 : 8'd0};
    end
    wire any_sample = time_slot_ends & (tick_0 | max);

    // ---- The promises.

    always_comb begin
        promise_10_hits_only_where_it_samples: assert (!hit || any_sample && goes && WIRING != NONE);
        promise_10_stops_by_direction: assert (WIRING != PAIR || !samples || hit == (goes & believed_now & back == !side));
        promise_10_stops_as_it_is_reached: assert (WIRING == PAIR || !samples || hit == (goes & flips & believed_now));
        promise_10_believed_after_equal_samples: assert (against < SAMPLES && (!flips || samples));
        promise_12_own_switch_only: assert (memory == was_memory || was_samples);
        promise_13_reset_forgets: assert (!was_samples || !was_resetting || memory == 0);
        promise_13_inactive: assert (!first_clock || !hit || time_slot_ends);
    end

    reg was_samples = 0, was_resetting = 0;
    reg [7:0] was_memory = 0;
    always @(posedge clock) {was_samples, was_memory, was_resetting} <= {samples, memory, resetting};

    // ---- The invariants that make the promises inductive. `sample` is an additional read port for
    // the word of this switch in memory.

    wire [7:0] memory;
    memory_probe #("\\dut.switches.words", 4, 8) at_switches (1'b0, 1'b1, {who, side}, memory);
    (* inside = "dut.now" *) wire now;
    (* inside = "dut.sync" *) wire dut_sync;
    (* inside = "dut.word" *) wire [7:0] word;
    // The memory read the word of this switch in the clock before.
    wire looked_up = !first_clock & was_next == who & (was_max & WIRING == PAIR) == side;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (memory == {believed, against[6:0]} && against < SAMPLES);
        invariant_2: assert (!looked_up || was_time_slot_ends || word == memory);
        invariant_3: assert ({dut_sync, now} == {sync, seen});
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_10_hit: cover (hit && samples);
        cover_12_let_go: cover (!believed && against == 0 && was_samples && was_memory[7]);
    end
endmodule

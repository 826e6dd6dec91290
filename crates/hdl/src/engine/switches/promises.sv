// Proves promises 10, 12, 13 and 15 of the debouncer of the switches, without a bound on time.
//
//   parameters   AXES: number of axes
//                WIRING: 0 no limits, 1 two per axis, 2 one per axis, 3 one for all axes
//                LOW: 1 if a limit is active when its pin is low
//                EXIST_0, EXIST_1: the inputs of the rows 2 and 3 that exist, one bit each
//                LOW_0, LOW_1: those of them that are active when their pin is low
//                SAMPLES: number of samples to debounce
//                `DUT: the name of the exported module `switches`, built with these values
//   assumptions  Two time slots do not end in adjacent clocks (proved in time_slot/promises.sv). The
//                row changes, and a reset begins and ends, in the clock after a strobe, in which no
//                time slot ends (proved in engine/promises.sv).
//
// All statements are about one switch, row `which` of axis `who`; the solver may choose any. This
// file counts the samples of this switch in registers; the module keeps its counts in a memory.

module promises (
    input wire clock,
    input wire time_slot_ends,
    input wire [2:0] axis,
    input wire [2:0] axis_next,
    input wire [1:0] row,
    input wire begins_round,
    input wire [`AXES-1:0] limit_min,
    input wire [`AXES-1:0] limit_max,
    input wire [`AXES-1:0] inputs_0,
    input wire [`AXES-1:0] inputs_1,
    input wire goes,
    input wire back,
    input wire resetting
);
    (* anyconst *) reg [2:0] who;
    (* anyconst *) reg [1:0] which;
    localparam [1:0] NONE = 0, PAIR = 1, EACH = 2, ONE = 3, WIRING = `WIRING;
    localparam [7:0] SAMPLES = `SAMPLES;
    localparam [`AXES-1:0] EXIST_0 = `EXIST_0, EXIST_1 = `EXIST_1, LOW_0 = `LOW_0, LOW_1 = `LOW_1;
    localparam [3:0] ROWS = {EXIST_1 != 0, EXIST_0 != 0, WIRING == PAIR, WIRING != NONE};
    localparam HAS_INPUTS = EXIST_0 != 0 || EXIST_1 != 0;

    wire [`AXES-1:0] axis_one_hot = 32'd1 << axis;
    wire samples, level, earlier, state, found, interlock;
    `DUT dut (.*);

    reg first_clock = 1, was_begins_round = 0, was_time_slot_ends = 0, was_resetting = 0;
    reg [1:0] was_row = 0;
    reg [2:0] was_next = 0;
    always @(posedge clock) begin
        first_clock <= 0;
        {was_begins_round, was_row, was_next} <= {begins_round, row, axis_next};
        {was_time_slot_ends, was_resetting} <= {time_slot_ends, resetting};
    end
    always_comb begin
        assume (who < `AXES && ROWS[which]);
        assume (axis == was_next && (!time_slot_ends || !was_time_slot_ends && axis < `AXES));
        assume (!time_slot_ends || !first_clock
            && {begins_round, row, resetting} == {was_begins_round, was_row, was_resetting});
    end

    // ---- The pin of the axis of this time slot, as it was two clocks ago. In a tick that samples
    // no switch, any pin will do.

    wire inputs = row[1] & HAS_INPUTS;
    wire [`AXES-1:0] pins = !inputs ? (row[0] ? limit_max : limit_min) ^ {`AXES{1'b`LOW}}
        : row[0] && EXIST_1 != 0 ? (inputs_1 ^ LOW_1) & EXIST_1 : (inputs_0 ^ LOW_0) & EXIST_0;
    wire pin = WIRING == ONE && !inputs ? pins[0] : |(pins & axis_one_hot);
    reg sync = 0, seen = 0;
    always @(posedge clock) {seen, sync} <= {sync, pin};

    // ---- The samples of the switch (`looks`), and its debounced state (`believed`). A reset also
    // forgets the rows 2 and 3, before the last beat of each time slot.

    wire any_sample = begins_round & ROWS[row];
    wire looks = time_slot_ends & any_sample & row == which & axis == who;
    wire forgets = resetting & HAS_INPUTS & axis == who & which == {row[1] | !time_slot_ends, row[0]};
    reg believed = 0;
    // Number of consecutive samples, up to now, that differ from the debounced state.
    reg [7:0] against = 0;
    wire differs = seen != believed;
    wire flips = looks & differs & against + 1 == SAMPLES;
    wire believed_now = (believed ^ flips) & !resetting;
    always @(posedge clock) begin
        if (looks) {believed, against} <= {believed_now, differs & !flips & !resetting ? against + 8'd1 : 8'd0};
        if (forgets) {believed, against} <= 0;
    end

    // ---- The interlock, if it is the switch.

    reg open = 0;
    always @(posedge clock) open <= !resetting & (looks ? believed_now : open);

    // ---- The promises.

    always_comb begin
        promise_10_hits_only_where_it_samples: assert (!found || time_slot_ends && any_sample && goes && WIRING != NONE);
        promise_10_stops_by_direction: assert (WIRING != PAIR || !looks || which[1]
            || found == (goes & believed_now & back == !which[0]));
        promise_10_stops_as_it_is_reached: assert (WIRING == PAIR || !looks || which[1] || found == (goes & flips & believed_now));
        promise_10_inputs_are_no_limits: assert (!looks || !which[1] || !found);
        promise_10_believed_after_equal_samples: assert (against < SAMPLES && (!flips || looks));
        promise_10_interlock: assert (interlock == open || who != 0 || which != 3 || !EXIST_1[0]);
        promise_12_state_of_the_switch: assert ((!looks || state == believed_now) && samples == any_sample);
        promise_12_own_switch_only: assert (memory == was_memory || was_looks || was_forgets);
        promise_13_reset_forgets: assert (!was_looks || !was_resetting || memory == 0);
        promise_13_reset_forgets_inputs: assert (!was_forgets || memory == 0);
        promise_13_inactive: assert (!first_clock || (!found || time_slot_ends) && !interlock);
        promise_15_levels: assert ((!looked_up || was_looks || was_forgets || earlier == believed) && level == seen);
    end

    reg was_looks = 0, was_forgets = 0;
    reg [7:0] was_memory = 0;
    always @(posedge clock) {was_looks, was_forgets, was_memory} <= {looks, forgets, memory};

    // ---- The invariants that make the promises inductive. `sample` is an additional read port for
    // the word of this switch in memory.

    wire [7:0] memory;
    memory_probe #("\\dut.switch_memory.words", 5, 8) at_switches (1'b0, 1'b1, {who, which}, memory);
    (* inside = "dut.now" *) wire now;
    (* inside = "dut.sync" *) wire dut_sync;
    (* inside = "dut.word" *) wire [7:0] word;
    // The memory read the word of this switch in the clock before.
    wire looked_up = !first_clock & was_next == who & was_row == which;

`ifdef INVARIANTS
    always_comb begin
        invariant_1: assert (memory == {believed, against[6:0]} && against < SAMPLES);
        invariant_2: assert (!looked_up || was_looks || was_forgets || word == memory);
        invariant_3: assert ({dut_sync, now} == {sync, seen});
        invariant_4: assert ((!was_looks || was_time_slot_ends) && (!was_forgets || was_resetting));
    end
`endif

    // ---- Covers: some run reaches each of these situations.

    always_comb begin
        cover_10_hit: cover (found && looks);
        cover_12_let_go: cover (!believed && against == 0 && was_looks && was_memory[7]);
    end
endmodule

// SPDX-License-Identifier: MIT OR Apache-2.0
//
// carrystep_engine: step and direction for six axes.
// This file is generated: change the generator instead.
//
// Made from    sim/six-axis.toml
// Made by      carrystep 0.1.0, with Rust-HDL 0.46.0
//
// Ports: inputs are sampled at the rising edge of `clock`, and outputs change after it; an output
// can also depend on inputs of the same clock. Signals are active high. The comment of a port says
// if it is otherwise; an asynchronous input may come directly from a pin. P is in 2^-64 step, V in
// 2^-64 step per tick, A in 2^-64 step per tick^2, and J in 2^-64 step per tick^3.
//
// The numbers of a build are parameters of the modules. If you override one, override BUILD_ID of
// the host link too: by this id the host knows the parameters for which it plans moves. With the id
// of other parameters it plans wrong moves, which is unsafe. The defaults of the parameters:
//
// Clock        80000000 Hz
// Tick         1000 ns, 80 clocks in 16 phases
// Latency      161 clocks from the load of a move to the edge of its tick 1, phase 0
// P starts at  half a step
// Pins         in clocks: STEP high, STEP low, DIR before STEP, DIR after STEP
//   axis 0     STEP_HIGH 8, STEP_LOW 8, DIR_SETUP 2, DIR_HOLD 2
//   axis 1     STEP_HIGH 80, STEP_LOW 80, DIR_SETUP 16, DIR_HOLD 16
//   axis 2     STEP_HIGH 152, STEP_LOW 152, DIR_SETUP 52, DIR_HOLD 52
//   axis 3     STEP_HIGH 200, STEP_LOW 200, DIR_SETUP 400, DIR_HOLD 400
//   axis 4     STEP_HIGH 8, STEP_LOW 8, DIR_SETUP 2, DIR_HOLD 2
//   axis 5     STEP_HIGH 240, STEP_LOW 240, DIR_SETUP 120, DIR_HOLD 120
// Guard        counts in rounds of 32 ticks, 32 us
//   watchdog   100 to 100.033 ms without a valid frame of the host: ramp
//   enable     1.024 to 1.057 ms from ENABLE to the first start
//   e-stop     active high: freeze
//   limits     two per axis, active high, debounced for 512 to 545 us: ramp
//   axis 0     ramps by 800000 steps/s^2
//   axis 1     ramps by 640000 steps/s^2
//   axis 2     ramps by 600000 steps/s^2
//   axis 3     ramps by 355556 steps/s^2
//   axis 4     ramps by 888889 steps/s^2
//   axis 5     ramps by 150000 steps/s^2

`default_nettype none

// The schedule: in each tick every axis has a time slot of thirteen clocks (beats).
module carrystep_time_slot (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of a tick.
    input  wire         strobe,
    // Bit i is asserted in beat i. Bits 13 to 16 belong to the axis of the slot before.
    output wire  [16:0] beat,
    // The axis of the slot, as a number.
    output wire   [2:0] axis,
    // The axis of the next clock, as a number.
    output wire   [2:0] axis_next,
    // The axis of the slot, one-hot. After the last slot it is the first axis.
    output wire   [5:0] axis_one_hot,
    // The time slot is that of the last axis.
    output wire         is_last
);
    localparam BY_ONE = 1'b1;
    localparam [16:0] FIRST_BEAT = 17'd1;
    localparam [2:0] FIRST_AXIS = 3'd0;
    localparam [2:0] ONE_AXIS = 3'd1;
    localparam [5:0] LAST_ONE_HOT = 6'd32;
    localparam [2:0] TO_TOP = 3'd5;

    reg [16:0] beats = 17'd0;
    reg [2:0] number = 3'd0;
    reg [5:0] one_hot = 6'd1;
    reg [2:0] axis_to_come;

    wire ends = (one_hot & LAST_ONE_HOT) != 6'd0;
    wire begins = strobe | (beats[12] & !ends);
    wire [16:0] shifted = beats << BY_ONE;

    assign beat = beats;
    assign axis = number;
    assign axis_next = axis_to_come;
    assign axis_one_hot = one_hot;
    assign is_last = ends;

    always @(*) begin
        axis_to_come = number;
        if (beats[12]) begin
            axis_to_come = number + ONE_AXIS;
            if (ends) begin
                axis_to_come = FIRST_AXIS;
            end
        end
    end

    always @(posedge clock) begin
        beats <= shifted;
        if (begins) begin
            beats <= shifted | FIRST_BEAT;
        end
        if (beats[12]) begin
            one_hot <= (one_hot << BY_ONE) | (one_hot >> TO_TOP);
        end
        number <= axis_to_come;
    end
endmodule

// The only adder, 32 bits: P + V, V + A, A + J, remaining ticks, positions, bisection.
module carrystep_adder (
    // The clock.
    input  wire         clock,
    // The beats of `time_slot`: bit i is asserted in beat i of a time slot.
    input  wire  [16:0] beat,
    // The word that the memory returns.
    input  wire  [31:0] word,
    // The word that the host offers.
    input  wire  [31:0] put,
    // The axis runs: beat 6 subtracts one from its remaining ticks.
    input  wire         counts,
    // In beat 5: the axis is at rest, and beat 6 adds one to its discarded steps. Never asserted
    // with `counts`.
    input  wire         lost,
    // In beat 6: beat 7 adds one to the position.
    input  wire         up,
    // In beat 6: beat 7 subtracts one from the position.
    input  wire         down,
    // The sums that replace P are zero.
    input  wire         wipe,
    // A reset: the sum that replaces the discarded steps is zero.
    input  wire         forgets,
    // The sum of the beat before.
    output wire  [31:0] sum,
    // From beat 8: the running segment ends with this tick.
    output wire         ended,
    // From beat 12: V + A does not fit in 64 bits.
    output wire         overflow,
    // From beat 12: V + A and V have different signs.
    output wire         turned,
    // In beat 12: the tick contains a step.
    output wire         crosses,
    // From beat 12: V < 0.
    output wire         back,
    // From beat 12: V = 0.
    output wire         still,
    // From beat 12: V = -2^63.
    output wire         least,
    // After beat 16: the phase of the step, in 1/16 tick.
    output wire   [3:0] q
);
    localparam [31:0] NOTHING = 32'd0;
    localparam [31:0] ONES = 32'hffffffff;
    localparam [31:0] SIGN = 32'h80000000;
    localparam [32:0] ABOVE = 33'h100000000;
    localparam BY_ONE = 1'b1;
    localparam [33:0] CARRY = 34'h1;
    localparam [33:0] NO_CARRY = 34'h0;
    localparam [3:0] Q_BIT = 4'd1;

    reg [31:0] a = 32'd0;
    reg [31:0] b = 32'd0;
    reg [31:0] r = 32'd0;
    reg top = 1'b0;
    reg carry_0 = 1'b0;
    reg carry_1 = 1'b0;
    reg carry_2 = 1'b0;
    reg over = 1'b0;
    reg unfit = 1'b0;
    reg sign_of_a = 1'b0;
    reg sign_of_b = 1'b0;
    reg other = 1'b0;
    reg low_zero = 1'b0;
    reg minus = 1'b0;
    reg zero = 1'b0;
    reg bound = 1'b0;
    reg crossed = 1'b0;
    reg bisects = 1'b0;
    reg carry_if_top = 1'b0;
    reg carry_if_not = 1'b0;
    reg [3:0] bits = 4'd0;
    reg [31:0] x;
    reg carry_in;
    reg [33:0] low;
    reg [32:0] extended;

    wire adds_tick = beat[15] & !beat[2];
    wire counting = beat[5] | beat[6] | adds_tick;
    wire ones_in = (beat[5] & counts) | (beat[6] & !up);
    wire load = beat[2] | beat[3] | beat[7] | beat[9];
    wire halve = beat[11] | beat[12] | beat[13] | beat[14];
    wire [31:0] half = (b >> BY_ONE) | (b & SIGN);
    wire halves_on = beat[12] | beat[13] | beat[14];
    wire crosses_now = top ^ crossed;
    wire carry_due = adds_tick | (beat[5] & lost) | (beat[6] & !down) | ((beat[8] | beat[9] | beat[10]) & carry_2);
    wire odd = halves_on & b[0];
    wire odd_beyond = odd & bisects & crosses_now;
    wire [33:0] wide = (({2'b0, x} << BY_ONE) | CARRY) + (({1'b0, extended} << BY_ONE) | low);
    wire wiping = (wipe & (beat[5] | beat[11])) | (forgets & beat[6]);
    wire empty = (b & ~SIGN) == 32'd0;

    assign sum = r;
    assign ended = over;
    assign overflow = unfit;
    assign turned = other;
    assign crosses = top;
    assign back = minus;
    assign still = zero;
    assign least = bound;
    assign q = bits;

    always @(*) begin
        x = a;
        if (bisects) begin
            x = r;
            if (top) begin
                x = ~r;
            end
        end
    end

    always @(*) begin
        carry_in = carry_if_not;
        if (top) begin
            carry_in = carry_if_top;
        end
    end

    always @(*) begin
        low = NO_CARRY;
        if (carry_in) begin
            low = CARRY;
        end
    end

    always @(*) begin
        extended = {1'b0, b};
        if (b[31]) begin
            extended = {1'b0, b} | ABOVE;
        end
    end

    always @(posedge clock) begin
        if (beat[1] | beat[4] | beat[5] | beat[6] | beat[8] | beat[10] | beat[13]) begin
            a <= word;
        end
        if (beat[7]) begin
            a <= put;
        end
        if (ones_in) begin
            b <= ONES;
        end else if (counting) begin
            b <= NOTHING;
        end else if (load) begin
            b <= word;
        end else if (halve) begin
            b <= half;
        end
        bisects <= halves_on;
        carry_if_not <= carry_due | odd_beyond;
        carry_if_top <= carry_due | (odd & !odd_beyond);
        r <= wide[32:1];
        if (beat[8]) begin
            r <= x;
        end
        if (wiping) begin
            r <= NOTHING;
        end
        top <= wide[33];
        sign_of_b <= b[31];
        if (beat[4] | beat[5] | beat[6] | beat[8] | beat[9]) begin
            carry_0 <= top ^ sign_of_b;
            carry_1 <= carry_0;
            carry_2 <= carry_1;
        end
        if (beat[7]) begin
            over <= top;
        end
        sign_of_a <= a[31];
        if (beat[11]) begin
            unfit <= r[31] ^ top ^ sign_of_a;
            other <= r[31] ^ b[31];
        end
        if (beat[5]) begin
            low_zero <= empty & !b[31];
        end
        if (beat[11]) begin
            minus <= b[31];
            zero <= low_zero & empty & !b[31];
            bound <= low_zero & empty & b[31];
        end
        if (beat[12]) begin
            crossed <= 1'b0;
        end
        if (bisects) begin
            crossed <= crosses_now;
        end
        if (bisects | beat[16]) begin
            bits <= bits << BY_ONE;
            if (!crosses_now) begin
                bits <= (bits << BY_ONE) | Q_BIT;
            end
        end
    end
endmodule

// Memory of the control words: the queue state and flags of each axis.
module carrystep_control (
    // The clock.
    input  wire         clock,
    // The address of the word to read.
    input  wire   [2:0] read_address,
    // The word at the address of the cycle before.
    output wire  [30:0] read_data,
    // The address of the word to write.
    input  wire   [2:0] write_address,
    // The write enable of each bit.
    input  wire  [30:0] write_bits,
    // The new values of the bits that are written.
    input  wire  [30:0] write_data
);
    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [30:0] words [0:7];
    reg [30:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 8; i = i + 1) words[i] = 0;
    end

    always @(posedge clock) begin
        value <= words[read_address];
        if (write_bits[0]) words[write_address] <= write_data;
    end
endmodule

// Memory of one bit per segment: the segment is the last of its move.
module carrystep_lasts (
    // The clock.
    input  wire         clock,
    // The address of the word to read.
    input  wire   [7:0] read_address,
    // The word at the address of the cycle before.
    output wire         read_data,
    // The address of the word to write.
    input  wire   [7:0] write_address,
    // The write enable of each bit.
    input  wire         write_bits,
    // The new values of the bits that are written.
    input  wire         write_data
);
    wire unused = &{read_address[7:6], write_address[7:6]};

    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg words [0:63];
    reg value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 64; i = i + 1) words[i] = 0;
    end

    always @(posedge clock) begin
        value <= words[read_address[5:0]];
        if (write_bits) words[write_address[5:0]] <= write_data;
    end
endmodule

// The segment queue of each axis: which segment runs, and which segments wait.
module carrystep_queue #(
    // Cuts: 0 each is refused, 1 they exist; 0 or 1
    parameter [31:0] CUTS = 32'd0
) (
    // The clock.
    input  wire         clock,
    // The beats of `time_slot`: bit i is asserted in beat i of a time slot.
    input  wire  [16:0] beat,
    // The axis of the time slot.
    input  wire   [2:0] axis,
    // The axis of the next clock.
    input  wire   [2:0] axis_next,
    // The axis starts in this tick.
    input  wire         starts,
    // A stop is complete: no axis runs.
    input  wire         halted,
    // The axis ramps down.
    input  wire         ramp,
    // Removes all segments.
    input  wire         clear,
    // In beat 12: removes the waiting segments.
    input  wire         empties,
    // The engine accepts the host's word in this clock.
    input  wire         take,
    // The number of that word.
    input  wire   [3:0] put_word,
    // The lowest bits of that word: the slot of the last segment that a cut keeps.
    input  wire   [4:0] put_slot,
    // The committed segment is the last of its move.
    input  wire         last,
    // In this tick the queue examines the segment that was named for a cut.
    input  wire         checks,
    // In this tick the queue ends with the segment that was named, if one was.
    input  wire         cuts,
    // In this tick the queue forgets what was named.
    input  wire         closes,
    // The running segment ends with this tick.
    input  wire         ended,
    // V + A does not fit in 64 bits.
    input  wire         overflow,
    // V = -2^63.
    input  wire         least,
    // V + A and V have different signs.
    input  wire         turned,
    // V < 0.
    input  wire         back,
    // In beat 12: the next tick's words of the axis are those of its own hit.
    input  wire         meets,
    // In beat 12: what is kept in `counts` until the next time slot of the axis.
    input  wire   [6:0] next_counts,
    // The slot of the running segment.
    output wire   [4:0] live,
    // The slot that the host writes.
    output wire   [4:0] fresh,
    // Fault: the word accepted in the clock before was not the one that was due.
    output wire         misplaced,
    // From beat 1: no slot is free for the host.
    output wire         full,
    // From beat 1: the number of segments for which the queue has space.
    output wire   [4:0] room,
    // No segment waits.
    output wire         empty,
    // The axis runs in this tick.
    output wire         running,
    // The axis runs, and V is in range as far as is known before beat 12.
    output wire         sound,
    // V changes by the stop acceleration in this tick.
    output wire         slows,
    // The ramp began with V < 0, so that V increases.
    output wire         upward,
    // V stays unchanged in this tick, the first of a ramp.
    output wire         steady,
    // In beat 12: the axis runs and its V is in range.
    output wire         moves,
    // In beat 12: the axis runs in the next tick too.
    output wire         goes_on,
    // In beat 12: the next segment begins with the next tick.
    output wire         advances,
    // In beat 12, fault: V is out of range.
    output wire         too_fast,
    // In beat 12, fault: the segment ends, it is not the last of its move, and no segment waits.
    output wire         dry,
    // In beat 12, while a cut is examined: the named segment neither waits nor runs after this
    // tick, or a segment is partly written.
    output wire         misses,
    // The words of this tick are those of the axis' own hit.
    output wire         met,
    // `next_counts` of the time slot before of this axis, at first 0.
    output wire   [6:0] counts
);
    localparam HAS_CUTS = CUTS[0];
    localparam [4:0] SLOTS = 5'd7;
    localparam [5:0] BEYOND = 6'd56;
    localparam [4:0] ONE_SLOT = 5'd1;
    localparam [4:0] NO_SLOT = 5'd0;
    localparam [30:0] NAMED_BIT = 31'h40000000;
    localparam [2:0] ONE = 3'd1;
    localparam [2:0] ZERO = 3'd0;
    localparam [30:0] NO = 31'd0;
    localparam [30:0] RUNNING_BIT = 31'd1024;
    localparam [30:0] UNFIT_BIT = 31'd2048;
    localparam [30:0] BACK_BIT = 31'd4096;
    localparam [30:0] KNOWN_BIT = 31'd8192;
    localparam [30:0] ALL = 31'h7fffffff;
    localparam [30:0] MET_BIT = 31'h20000;
    localparam [2:0] COMMIT = 3'd7;
    localparam SET = 1'b1;
    localparam UNSET = 1'b0;
    localparam [3:0] AT_3 = 4'd3;
    localparam [3:0] AT_5 = 4'd5;
    localparam [3:0] AT_14 = 4'd14;
    localparam [4:0] AT_18 = 5'd18;
    localparam [4:0] AT_25 = 5'd25;

    reg [4:0] spare = 5'd0;
    reg took = 1'b0;
    reg wrong = 1'b0;
    reg [4:0] newest;
    reg [4:0] live_now;
    reg over;
    reg lasts_write_data;
    reg lasts_write_bits;
    reg [4:0] next_live;
    reg [4:0] next_newest;
    reg [2:0] next_due;
    reg [30:0] next_running;
    reg [30:0] next_unfit;
    reg [30:0] next_known;
    reg [30:0] next_back;
    reg [30:0] next_met;
    reg [4:0] next_target;
    reg [30:0] next_named;
    reg [30:0] control_write_bits;

    wire [30:0] control_read_data;
    wire lasts_read_data;

    wire [30:0] word = control_read_data;
    wire [4:0] old_live = word[4:0] & SLOTS;
    wire [4:0] target = word[29:25] & SLOTS;
    wire is_named = word[30] & (HAS_CUTS != 1'b0);
    wire ends_here = cuts & is_named;
    wire [4:0] fresh_now = (newest + ONE_SLOT) & SLOTS;
    wire [4:0] space = (live_now + ~newest) & SLOTS;
    wire runs = (word[10] | starts) & !halted;
    wire fits = runs & !word[11];
    wire none = newest == live_now;
    wire last_one = lasts_read_data != 1'b0;
    wire ramps = ramp & word[13];
    wire follows = ended & !last_one & !none & !ramp;
    wire stays = moves & !over;
    wire steps_on = moves & follows;
    wire [4:0] distance = (target - live_now) & SLOTS;
    wire [5:0] span = {1'b0, distance} + {1'b0, space};
    wire is_live = distance == 5'd0;
    wire waits = ((span & BEYOND) == 6'd0) & !is_live & !empties & !clear;
    wire keeps = waits | (is_live & stays & !follows);
    wire takes_word = take & !put_word[3];
    wire names = take & put_word[3] & (HAS_CUTS != 1'b0);
    wire [2:0] due = word[16:14];
    wire fits_in = put_word[2:0] == due;

    assign live = live_now;
    assign fresh = fresh_now;
    assign misplaced = wrong;
    assign full = spare == 5'd0;
    assign room = spare;
    assign empty = none;
    assign running = runs;
    assign sound = fits;
    assign slows = ramps;
    assign upward = word[12];
    assign steady = ramp & !word[13];
    assign moves = fits & !least;
    assign goes_on = stays;
    assign advances = steps_on;
    assign too_fast = runs & (word[11] | least);
    assign dry = moves & ended & !last_one & none & !ramp;
    assign misses = checks & is_named & (!keeps | (next_due != 3'd0));
    assign met = word[17];
    assign counts = word[24:18];

    always @(*) begin
        newest = word[9:5] & SLOTS;
        if (ends_here) begin
            newest = target;
        end
    end

    always @(*) begin
        live_now = old_live;
        if (starts) begin
            live_now = (old_live + ONE_SLOT) & SLOTS;
        end
    end

    always @(*) begin
        over = ended & last_one;
        if (ramp) begin
            over = ramps & turned;
        end
    end

    always @(*) begin
        lasts_write_data = UNSET;
        if (last) begin
            lasts_write_data = SET;
        end
    end

    always @(*) begin
        lasts_write_bits = UNSET;
        if (takes_word) begin
            lasts_write_bits = SET;
        end
    end

    always @(*) begin
        next_live = live_now;
        if (steps_on) begin
            next_live = (live_now + ONE_SLOT) & SLOTS;
        end
        if (empties) begin
            next_live = newest;
        end
        next_newest = newest;
        if (took & (due == COMMIT)) begin
            next_newest = fresh_now;
        end
        next_due = due;
        if (took) begin
            next_due = due + ONE;
        end
        if (clear) begin
            next_live = NO_SLOT;
            next_newest = NO_SLOT;
            next_due = ZERO;
        end
    end

    always @(*) begin
        next_running = NO;
        if (stays) begin
            next_running = RUNNING_BIT;
        end
    end

    always @(*) begin
        next_unfit = NO;
        if (stays & !follows & !ramp & overflow) begin
            next_unfit = UNFIT_BIT;
        end
    end

    always @(*) begin
        next_known = NO;
        if (stays & ramp) begin
            next_known = KNOWN_BIT;
        end
    end

    always @(*) begin
        next_back = NO;
        if ((ramps & word[12]) | (!ramps & back)) begin
            next_back = BACK_BIT;
        end
    end

    always @(*) begin
        next_met = NO;
        if (meets) begin
            next_met = MET_BIT;
        end
    end

    always @(*) begin
        next_target = target;
        next_named = NO;
        if (is_named & !closes & !clear) begin
            next_named = NAMED_BIT;
        end
        if (names) begin
            next_target = put_slot & SLOTS;
            next_named = NAMED_BIT;
        end
    end

    always @(*) begin
        control_write_bits = NO;
        if (beat[12]) begin
            control_write_bits = ALL;
        end
    end

    carrystep_control control (
        .clock(clock),
        .read_address(axis_next),
        .read_data(control_read_data),
        .write_address(axis),
        .write_bits(control_write_bits),
        .write_data({26'b0, next_live} | ({26'b0, next_newest} << AT_5) | next_running | next_unfit | next_known | next_back | ({28'b0, next_due} << AT_14) | next_met | ({24'b0, next_counts} << AT_18) | ({26'b0, next_target} << AT_25) | next_named)
    );

    carrystep_lasts lasts (
        .clock(clock),
        .read_address(({3'b0, live_now} << AT_3) | {5'b0, axis}),
        .read_data(lasts_read_data),
        .write_address(({3'b0, fresh_now} << AT_3) | {5'b0, axis}),
        .write_bits(lasts_write_bits),
        .write_data(lasts_write_data)
    );

    always @(posedge clock) begin
        wrong <= takes_word & !fits_in;
        if (beat[0]) begin
            took <= 1'b0;
        end
        if (takes_word & fits_in) begin
            took <= 1'b1;
        end
        spare <= space;
    end
endmodule

// Counts pulses and discarded steps in memory, and the steps that are on their way.
module carrystep_step_counts (
    // The clock.
    input  wire         clock,
    // The beats of `time_slot`: bit i is asserted in beat i of a time slot.
    input  wire  [16:0] beat,
    // The axis runs in this tick.
    input  wire         running,
    // In beat 12: the axis runs and its V is in range.
    input  wire         moves,
    // In beat 12: P + V crosses a step, if the axis moves.
    input  wire         crosses,
    // In beat 12: V < 0.
    input  wire         back,
    // No step is on its way any more.
    input  wire         clear,
    // The low bits of the position, from the pulser of the axis.
    input  wire   [2:0] pulses,
    // The low bits of the discarded steps, from the pulser of the axis.
    input  wire   [2:0] losses,
    // The lowest bits of the word that the memory returns. In beat 6 it is the position.
    input  wire   [2:0] word,
    // `next_counts` of the time slot before of this axis, at first 0.
    input  wire   [6:0] counts,
    // In beat 12: what is kept until the next time slot of the axis.
    output wire   [6:0] next_counts,
    // In beat 6: a step forward is added to the position.
    output wire         up,
    // In beat 6: a step backward is subtracted from the position.
    output wire         down,
    // From beat 5: a discarded step is counted. Asserted only while the axis does not run.
    output wire         lost,
    // Carries since the last clear less counted steps, modulo 16.
    output wire   [3:0] on_way
);
    localparam [2:0] ONE = 3'd1;
    localparam [3:0] NONE_ON_WAY = 4'd0;
    localparam [3:0] ONE_MORE = 4'd1;
    localparam [3:0] TWO_MORE = 4'd2;
    localparam [3:0] ONE_LESS = 4'd15;
    localparam [3:0] TWO_LESS = 4'd14;
    localparam [2:0] AT_3 = 3'd3;

    reg forward = 1'b0;
    reg backward = 1'b0;
    reg gone = 1'b0;
    reg [2:0] next_lost;
    reg [3:0] gain;
    reg [3:0] next_on_way;

    wire [2:0] missing = pulses - word;
    wire more = (missing != 3'd0) & !missing[2];
    wire less = missing[2];
    wire [2:0] unseen = losses ^ counts[2:0];
    wire ahead = moves & crosses & !back;
    wire behind = moves & crosses & back;

    assign next_counts = {4'b0, next_lost} | ({3'b0, next_on_way} << AT_3);
    assign up = more;
    assign down = less;
    assign lost = gone;
    assign on_way = counts[6:3];

    always @(*) begin
        next_lost = counts[2:0];
        if (gone) begin
            next_lost = counts[2:0] + ONE;
        end
    end

    always @(*) begin
        gain = NONE_ON_WAY;
        if (forward) begin
            gain = ONE_LESS;
        end
        if (backward) begin
            gain = ONE_MORE;
        end
        if (ahead) begin
            gain = ONE_MORE;
            if (forward) begin
                gain = NONE_ON_WAY;
            end
            if (backward) begin
                gain = TWO_MORE;
            end
        end
        if (behind) begin
            gain = ONE_LESS;
            if (forward) begin
                gain = TWO_LESS;
            end
            if (backward) begin
                gain = NONE_ON_WAY;
            end
        end
    end

    always @(*) begin
        next_on_way = counts[6:3] + gain;
        if (clear) begin
            next_on_way = NONE_ON_WAY;
        end
    end

    always @(posedge clock) begin
        if (beat[6]) begin
            forward <= more;
            backward <= less;
        end
        if (beat[4]) begin
            gone <= (unseen != 3'd0) & !running;
        end
    end
endmodule

// The stages of a cut, which drops the segments behind a named one in several axes.
module carrystep_cut_control #(
    // Cuts: 0 each is refused, 1 they exist; 0 or 1
    parameter [31:0] CUTS = 32'd0
) (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of a tick.
    input  wire         strobe,
    // The beats of `time_slot`: bit i is asserted in beat i of a time slot.
    input  wire  [16:0] beat,
    // The host requests a cut.
    input  wire         request,
    // In beat 12: the axis was named, and its segment neither waits nor runs after this tick.
    input  wire         misses,
    // A reset: no cut is requested.
    input  wire         resetting,
    // In this tick the time slots examine the named segments.
    output wire         checks,
    // In this tick the queues of the named axes end with the named segment.
    output wire         cuts,
    // In this tick the axes forget what was named.
    output wire         closes,
    // A cut was requested and is not decided yet.
    output wire         busy,
    // The last cut was refused.
    output wire         refused
);
    localparam EXIST = CUTS[0];

    generate
        if (CUTS > 32'd1) begin : cuts_out_of_range
            carrystep_error_cuts_out_of_range error ();
        end
    endgenerate

    reg asked = 1'b0;
    reg checking = 1'b0;
    reg closing = 1'b0;
    reg missed = 1'b0;
    reg denied = 1'b0;

    assign checks = checking;
    assign cuts = closing & !denied;
    assign closes = closing;
    assign busy = asked | checking;
    assign refused = denied | (EXIST == 1'b0);

    always @(posedge clock) begin
        if (beat[12] & misses) begin
            missed <= 1'b1;
        end
        if (strobe) begin
            asked <= 1'b0;
            checking <= asked;
            closing <= checking;
            missed <= 1'b0;
            if (checking) begin
                denied <= missed;
            end
        end
        if (request & (EXIST != 1'b0)) begin
            asked <= 1'b1;
        end
        if (resetting) begin
            asked <= 1'b0;
            checking <= 1'b0;
            if (strobe) begin
                denied <= 1'b0;
            end
        end
    end
endmodule

// Memory of the segments, also used as registers, and of an axis' state between moves.
module carrystep_segments #(
    // Start value of P: 1 half a step, 0 zero; 0 or 1
    parameter [31:0] START_HALF = 32'd1,
    // Acceleration of the ramp in a controlled stop, in 2^-64 step per tick^2; 1 to 2^62
    parameter [63:0] STOP_ACCEL_0 = 64'hd6bf94d5e57,
    parameter [63:0] STOP_ACCEL_1 = 64'habcc7711846,
    parameter [63:0] STOP_ACCEL_2 = 64'ha10fafa06c1,
    parameter [63:0] STOP_ACCEL_3 = 64'h5f71977b826,
    parameter [63:0] STOP_ACCEL_4 = 64'hee9bfab4c61,
    parameter [63:0] STOP_ACCEL_5 = 64'h2843ebe81b0
) (
    // The clock.
    input  wire         clock,
    // The address of the word to read.
    input  wire  [10:0] read_address,
    // The word at the address of the cycle before.
    output wire  [31:0] read_data,
    // The address of the word to write.
    input  wire  [10:0] write_address,
    // The write enable of each bit.
    input  wire  [31:0] write_bits,
    // The new values of the bits that are written.
    input  wire  [31:0] write_data
);
    wire unused = &{read_address[10:9], write_address[10:9]};

    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [31:0] words [0:511];
    reg [31:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 512; i = i + 1) words[i] = 0;
        words[15] = START_HALF[0] ? 32'h80000000 : 32'd0;
        words[39] = 32'd0 - STOP_ACCEL_0[31:0];
        words[47] = ~STOP_ACCEL_0[63:32] + ((STOP_ACCEL_0[31:0] == 32'd0) ? 32'd1 : 32'd0);
        words[55] = STOP_ACCEL_0[31:0];
        words[63] = STOP_ACCEL_0[63:32];
        words[79] = START_HALF[0] ? 32'h80000000 : 32'd0;
        words[103] = 32'd0 - STOP_ACCEL_1[31:0];
        words[111] = ~STOP_ACCEL_1[63:32] + ((STOP_ACCEL_1[31:0] == 32'd0) ? 32'd1 : 32'd0);
        words[119] = STOP_ACCEL_1[31:0];
        words[127] = STOP_ACCEL_1[63:32];
        words[143] = START_HALF[0] ? 32'h80000000 : 32'd0;
        words[167] = 32'd0 - STOP_ACCEL_2[31:0];
        words[175] = ~STOP_ACCEL_2[63:32] + ((STOP_ACCEL_2[31:0] == 32'd0) ? 32'd1 : 32'd0);
        words[183] = STOP_ACCEL_2[31:0];
        words[191] = STOP_ACCEL_2[63:32];
        words[207] = START_HALF[0] ? 32'h80000000 : 32'd0;
        words[231] = 32'd0 - STOP_ACCEL_3[31:0];
        words[239] = ~STOP_ACCEL_3[63:32] + ((STOP_ACCEL_3[31:0] == 32'd0) ? 32'd1 : 32'd0);
        words[247] = STOP_ACCEL_3[31:0];
        words[255] = STOP_ACCEL_3[63:32];
        words[271] = START_HALF[0] ? 32'h80000000 : 32'd0;
        words[295] = 32'd0 - STOP_ACCEL_4[31:0];
        words[303] = ~STOP_ACCEL_4[63:32] + ((STOP_ACCEL_4[31:0] == 32'd0) ? 32'd1 : 32'd0);
        words[311] = STOP_ACCEL_4[31:0];
        words[319] = STOP_ACCEL_4[63:32];
        words[335] = START_HALF[0] ? 32'h80000000 : 32'd0;
        words[359] = 32'd0 - STOP_ACCEL_5[31:0];
        words[367] = ~STOP_ACCEL_5[63:32] + ((STOP_ACCEL_5[31:0] == 32'd0) ? 32'd1 : 32'd0);
        words[375] = STOP_ACCEL_5[31:0];
        words[383] = STOP_ACCEL_5[63:32];
        words[511] = 32'h1;
    end

    always @(posedge clock) begin
        value <= words[read_address[8:0]];
        if (write_bits[0]) words[write_address[8:0]] <= write_data;
    end
endmodule

// The segment memory with its address selection: reads and writes the words of a time slot.
module carrystep_store #(
    // Start value of P: 1 half a step, 0 zero; 0 or 1
    parameter [31:0] START_HALF = 32'd1,
    // Acceleration of the ramp in a controlled stop, in 2^-64 step per tick^2; 1 to 2^62
    parameter [63:0] STOP_ACCEL_0 = 64'hd6bf94d5e57,
    parameter [63:0] STOP_ACCEL_1 = 64'habcc7711846,
    parameter [63:0] STOP_ACCEL_2 = 64'ha10fafa06c1,
    parameter [63:0] STOP_ACCEL_3 = 64'h5f71977b826,
    parameter [63:0] STOP_ACCEL_4 = 64'hee9bfab4c61,
    parameter [63:0] STOP_ACCEL_5 = 64'h2843ebe81b0
) (
    // The clock.
    input  wire         clock,
    // The beats of `time_slot`: bit i is asserted in beat i of a time slot.
    input  wire  [16:0] beat,
    // The axis of the time slot.
    input  wire   [2:0] axis,
    // The slot of the running segment of the axis.
    input  wire   [4:0] live,
    // The slot that the host writes.
    input  wire   [4:0] fresh,
    // The axis runs in this tick.
    input  wire         running,
    // The axis runs, and V is in range as far as is known.
    input  wire         sound,
    // In beat 12: the axis runs and its V is in range.
    input  wire         moves,
    // The axis ramps down: the stop acceleration replaces A.
    input  wire         slows,
    // The stop acceleration is added (s), because the ramp began with V < 0. Otherwise it is
    // subtracted (-s).
    input  wire         upward,
    // V stays unchanged in this tick.
    input  wire         steady,
    // P is set to its start value.
    input  wire         wipe,
    // In beat 9: the word of the host is written.
    input  wire         put,
    // The number of that word in its segment.
    input  wire   [2:0] put_word,
    // The sum to write.
    input  wire  [31:0] sum,
    // The word that was read.
    output wire  [31:0] word
);
    localparam [2:0] TICKS = 3'd0;
    localparam [2:0] V_LOW = 3'd1;
    localparam [2:0] V_HIGH = 3'd2;
    localparam [2:0] A_LOW = 3'd3;
    localparam [2:0] A_HIGH = 3'd4;
    localparam [2:0] J_LOW = 3'd5;
    localparam [2:0] J_HIGH = 3'd6;
    localparam [2:0] KEPT = 3'd7;
    localparam [4:0] P_LOW = 5'd0;
    localparam [4:0] P_HIGH = 5'd1;
    localparam [4:0] POSITION = 5'd2;
    localparam [4:0] DISCARDED = 5'd3;
    localparam [4:0] DOWN_LOW = 5'd4;
    localparam [4:0] DOWN_HIGH = 5'd5;
    localparam [4:0] UP_LOW = 5'd6;
    localparam [4:0] UP_HIGH = 5'd7;
    localparam [3:0] AT_3 = 4'd3;
    localparam [3:0] AT_6 = 4'd6;
    localparam [3:0] AT_9 = 4'd9;
    localparam [10:0] TICK_ADDRESS = 11'd2047;
    localparam [31:0] START_HIGH = START_HALF[0] ? 32'h80000000 : 32'd0;
    localparam [31:0] NO = 32'd0;
    localparam [31:0] ALL = 32'hffffffff;

    generate
        if (START_HALF > 32'd1) begin : start_half_out_of_range
            carrystep_error_start_half_out_of_range error ();
        end
        if ((STOP_ACCEL_0 < 64'h1) | (STOP_ACCEL_0 > 64'h4000000000000000)) begin : stop_accel_out_of_range_0
            carrystep_error_stop_accel_out_of_range_0 error ();
        end
        if ((STOP_ACCEL_1 < 64'h1) | (STOP_ACCEL_1 > 64'h4000000000000000)) begin : stop_accel_out_of_range_1
            carrystep_error_stop_accel_out_of_range_1 error ();
        end
        if ((STOP_ACCEL_2 < 64'h1) | (STOP_ACCEL_2 > 64'h4000000000000000)) begin : stop_accel_out_of_range_2
            carrystep_error_stop_accel_out_of_range_2 error ();
        end
        if ((STOP_ACCEL_3 < 64'h1) | (STOP_ACCEL_3 > 64'h4000000000000000)) begin : stop_accel_out_of_range_3
            carrystep_error_stop_accel_out_of_range_3 error ();
        end
        if ((STOP_ACCEL_4 < 64'h1) | (STOP_ACCEL_4 > 64'h4000000000000000)) begin : stop_accel_out_of_range_4
            carrystep_error_stop_accel_out_of_range_4 error ();
        end
        if ((STOP_ACCEL_5 < 64'h1) | (STOP_ACCEL_5 > 64'h4000000000000000)) begin : stop_accel_out_of_range_5
            carrystep_error_stop_accel_out_of_range_5 error ();
        end
    endgenerate

    reg counted = 1'b0;
    reg [4:0] read_slot;
    reg [2:0] read_word;
    reg [10:0] segments_read_address;
    reg [4:0] write_slot;
    reg [2:0] write_word;
    reg writes;
    reg [10:0] segments_write_address;
    reg [31:0] segments_write_data;
    reg [31:0] segments_write_bits;

    wire [31:0] segments_read_data;

    assign word = segments_read_data;

    always @(*) begin
        read_slot = live;
        read_word = KEPT;
        if (beat[0]) begin
            if (slows) begin
                read_slot = DOWN_LOW;
                if (upward) begin
                    read_slot = UP_LOW;
                end
            end else begin
                read_word = A_LOW;
            end
        end
        if (beat[1]) begin
            read_word = J_LOW;
        end
        if (beat[2]) begin
            read_word = V_LOW;
        end
        if (beat[3]) begin
            read_slot = P_LOW;
        end
        if (beat[4]) begin
            if (running) begin
                read_word = TICKS;
            end else begin
                read_slot = DISCARDED;
            end
        end
        if (beat[5]) begin
            read_slot = POSITION;
        end
        if (beat[6]) begin
            read_word = J_HIGH;
        end
        if (beat[7]) begin
            if (slows) begin
                read_slot = DOWN_HIGH;
                if (upward) begin
                    read_slot = UP_HIGH;
                end
            end else begin
                read_word = A_HIGH;
            end
        end
        if (beat[8]) begin
            read_word = V_HIGH;
        end
        if (beat[9]) begin
            read_slot = P_HIGH;
        end
    end

    always @(*) begin
        segments_read_address = ({9'b0, read_slot[4:3]} << AT_9) | ({8'b0, axis} << AT_6) | ({8'b0, read_slot[2:0]} << AT_3) | {8'b0, read_word};
        if (beat[10] | beat[12]) begin
            segments_read_address = TICK_ADDRESS;
        end
    end

    always @(*) begin
        write_slot = live;
        write_word = KEPT;
        writes = 1'b0;
        if (beat[4]) begin
            write_word = A_LOW;
            writes = sound;
        end
        if (beat[5]) begin
            write_word = V_LOW;
            writes = sound & !steady;
        end
        if (beat[6]) begin
            write_slot = P_LOW;
            writes = sound | wipe;
        end
        if (beat[7]) begin
            writes = 1'b1;
            if (running) begin
                write_word = TICKS;
            end else begin
                write_slot = DISCARDED;
            end
        end
        if (beat[8]) begin
            write_slot = POSITION;
            writes = 1'b1;
        end
        if (beat[9]) begin
            write_slot = fresh;
            write_word = put_word;
            writes = put;
        end
        if (beat[10]) begin
            write_word = A_HIGH;
            writes = sound;
        end
        if (beat[11]) begin
            write_word = V_HIGH;
            writes = sound & !steady;
        end
        if (beat[12]) begin
            write_slot = P_HIGH;
            writes = moves | wipe;
        end
        segments_write_address = ({9'b0, write_slot[4:3]} << AT_9) | ({8'b0, axis} << AT_6) | ({8'b0, write_slot[2:0]} << AT_3) | {8'b0, write_word};
        if (counted) begin
            segments_write_address = TICK_ADDRESS;
            writes = 1'b1;
        end
    end

    always @(*) begin
        segments_write_data = sum;
        if (wipe & beat[12]) begin
            segments_write_data = sum | START_HIGH;
        end
    end

    always @(*) begin
        segments_write_bits = NO;
        if (writes) begin
            segments_write_bits = ALL;
        end
    end

    carrystep_segments #(
        .START_HALF(START_HALF),
        .STOP_ACCEL_0(STOP_ACCEL_0),
        .STOP_ACCEL_1(STOP_ACCEL_1),
        .STOP_ACCEL_2(STOP_ACCEL_2),
        .STOP_ACCEL_3(STOP_ACCEL_3),
        .STOP_ACCEL_4(STOP_ACCEL_4),
        .STOP_ACCEL_5(STOP_ACCEL_5)
    ) segments (
        .clock(clock),
        .read_address(segments_read_address),
        .read_data(segments_read_data),
        .write_address(segments_write_address),
        .write_bits(segments_write_bits),
        .write_data(segments_write_data)
    );

    always @(posedge clock) begin
        counted <= beat[16] & !beat[3];
    end
endmodule

// The tick counter: a strobe in the last clock of each tick, and the phases of a tick.
module carrystep_tick #(
    // Clocks per tick; a multiple of the phases, from 13 x axes + 1 and 2 x phases to 65536
    parameter [31:0] CLOCKS_PER_TICK = 32'd80
) (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of each tick.
    output wire         strobe,
    // Asserted in the first clock of each phase.
    output wire         phase_start,
    // The number of the present phase, 0 to Q - 1.
    output wire   [3:0] phase
);
    // A mask of the bits that a counter from 0 to `greatest` uses.
    function [15:0] used_bits_16(input [15:0] greatest);
        begin
            used_bits_16 = greatest;
            used_bits_16 = used_bits_16 | (used_bits_16 >> 1);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 2);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 4);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 8);
        end
    endfunction
    localparam [15:0] ZERO = 16'd0;
    localparam [15:0] ONE = 16'd1;
    localparam [15:0] LAST_SUB = CLOCKS_PER_TICK[19:4] - 16'd1;
    localparam [15:0] SUB_BITS = used_bits_16(CLOCKS_PER_TICK[19:4] - 16'd1);
    localparam [3:0] FIRST_PHASE = 4'd0;
    localparam [3:0] ONE_PHASE = 4'd1;
    localparam [3:0] LAST_PHASE = 4'd15;

    generate
        if (((CLOCKS_PER_TICK < 32'd16) | (CLOCKS_PER_TICK > 32'h10000)) | ((CLOCKS_PER_TICK & 32'd15) != 32'd0)) begin : clocks_per_tick_out_of_range
            carrystep_error_clocks_per_tick_out_of_range error ();
        end
    endgenerate

    reg [15:0] sub = 16'd1;
    reg [3:0] phases = 4'd0;

    wire sub_over = sub == LAST_SUB;
    wire phase_over = phases == LAST_PHASE;

    assign strobe = sub_over & phase_over;
    assign phase_start = sub == ZERO;
    assign phase = phases;

    always @(posedge clock) begin
        sub <= (sub + ONE) & SUB_BITS;
        if (sub_over) begin
            sub <= ZERO;
            phases <= phases + ONE_PHASE;
            if (phase_over) begin
                phases <= FIRST_PHASE;
            end
        end
    end
endmodule

// Memory of the event wheel: the steps of all axes in each phase of four ticks.
module carrystep_event_memory #(
    // Event memory: block RAM, or LUTs if block RAM has no write mask; "block" or "distributed"
    parameter EVENT_MEMORY = "block"
) (
    // The clock.
    input  wire         clock,
    // The address of the word to read.
    input  wire   [6:0] read_address,
    // The word at the address of the cycle before.
    output wire  [15:0] read_data,
    // The address of the word to write.
    input  wire   [6:0] write_address,
    // The write enable of each bit.
    input  wire  [15:0] write_bits,
    // The new values of the bits that are written.
    input  wire  [15:0] write_data
);
    // Words of different lengths are compared.
    // verilator lint_off WIDTH
    generate
        if ((EVENT_MEMORY != "block") && (EVENT_MEMORY != "distributed")) begin : refused
            carrystep_error_event_memory_out_of_range error ();
        end
    endgenerate
    // verilator lint_on WIDTH

    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = EVENT_MEMORY *) reg [15:0] words [0:127];
    reg [15:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 128; i = i + 1) words[i] = 0;
    end

    always @(posedge clock) begin
        value <= words[read_address];
        for (i = 0; i < 16; i = i + 1) begin
            if (write_bits[i]) words[write_address][i] <= write_data[i];
        end
    end
endmodule

// The event wheel: holds the pending steps of all axes, ordered by tick and phase.
module carrystep_event_wheel #(
    // Clocks per tick; a multiple of the phases, from 13 x axes + 1 and 2 x phases to 65536
    parameter [31:0] CLOCKS_PER_TICK = 32'd80,
    // Event memory: block RAM, or LUTs if block RAM has no write mask; "block" or "distributed"
    parameter EVENT_MEMORY = "block"
) (
    // The clock.
    input  wire         clock,
    // Asserted in the last beat of a time slot. The inputs of the following beats belong to its
    // axis.
    input  wire         time_slot_ends,
    // The axis of the present time slot, one-hot.
    input  wire   [5:0] axis_one_hot,
    // The tick of the axis contains a step.
    input  wire         crosses,
    // The V of the axis is not zero.
    input  wire         has_sign,
    // From the following beat on: V < 0.
    input  wire         back,
    // Asserted four beats after `time_slot_ends`: `q` is valid from the next clock on.
    input  wire         phase_known,
    // The phase of the step, in 1/16 tick.
    input  wire   [3:0] q,
    // Asserted in the last clock of a tick.
    output wire         strobe,
    // Asserted in the first clock of a phase, in which `events` are step events.
    output wire         phase_start,
    // Bit i: axis i has an event.
    output wire   [5:0] events,
    // Bit i: the event of axis i is backward.
    output wire   [5:0] backward
);
    localparam [1:0] ONE_TICK = 2'd1;
    localparam [15:0] NO = 16'd0;
    localparam [15:0] ALL = 16'd65535;
    localparam [15:0] FORWARD = 16'd255;
    localparam [6:0] SIGN_KIND = 7'd16;
    localparam BY_ONE = 1'b1;
    localparam [2:0] TO_TOP = 3'd5;
    localparam [3:0] AT_5 = 4'd5;
    localparam [3:0] AT_8 = 4'd8;
    localparam [6:0] LAST_PHASE = 7'd15;
    localparam [3:0] Q_SHIFT = 4'd0;

    reg turned = 1'b0;
    reg started = 1'b0;
    reg [1:0] ahead = 2'd0;
    reg [6:0] read = 7'd0;
    reg sign_due = 1'b0;
    reg step_due = 1'b0;
    reg step_known = 1'b0;
    reg [1:0] when = 2'd0;
    reg [6:0] place;
    reg [6:0] later;
    reg [6:0] event_memory_write_address;
    reg [15:0] data;
    reg [15:0] bits;

    wire tick_strobe;
    wire tick_phase_start;
    wire [3:0] tick_phase;
    wire [15:0] event_memory_read_data;

    wire wipes = turned | started;
    wire writes_sign = !wipes & sign_due;
    wire writes_step = !wipes & !sign_due & step_due & step_known;
    wire [1:0] now = when + ONE_TICK;
    wire [5:0] whose = (axis_one_hot >> BY_ONE) | (axis_one_hot << TO_TOP);

    assign strobe = turned;
    assign phase_start = started;
    assign events = event_memory_read_data[5:0];
    assign backward = event_memory_read_data[13:8];

    always @(*) begin
        place = ({5'b0, ahead} << AT_5) | {3'b0, tick_phase};
        if (tick_strobe) begin
            place = ({5'b0, ahead} << AT_5) | {3'b0, tick_phase} | SIGN_KIND;
        end
    end

    always @(*) begin
        later = ({5'b0, now} << AT_5) | {3'b0, q >> Q_SHIFT};
        if (sign_due) begin
            later = ({5'b0, when} << AT_5) | SIGN_KIND | LAST_PHASE;
        end
    end

    always @(*) begin
        event_memory_write_address = later;
        if (wipes) begin
            event_memory_write_address = read;
        end
    end

    always @(*) begin
        data = NO;
        if (!wipes) begin
            data = FORWARD;
            if (back) begin
                data = ALL;
            end
        end
    end

    always @(*) begin
        bits = NO;
        if (writes_sign | writes_step) begin
            bits = {10'b0, whose} | ({10'b0, whose} << AT_8);
        end
        if (wipes) begin
            bits = ALL;
        end
    end

    carrystep_tick #(
        .CLOCKS_PER_TICK(CLOCKS_PER_TICK)
    ) tick (
        .clock(clock),
        .strobe(tick_strobe),
        .phase_start(tick_phase_start),
        .phase(tick_phase)
    );

    carrystep_event_memory #(
        .EVENT_MEMORY(EVENT_MEMORY)
    ) event_memory (
        .clock(clock),
        .read_address(place),
        .read_data(event_memory_read_data),
        .write_address(event_memory_write_address),
        .write_bits(bits),
        .write_data(data)
    );

    always @(posedge clock) begin
        turned <= tick_strobe;
        started <= tick_phase_start;
        if (tick_strobe) begin
            ahead <= ahead + ONE_TICK;
        end
        read <= place;
        if (writes_sign) begin
            sign_due <= 1'b0;
        end
        if (writes_step) begin
            step_due <= 1'b0;
        end
        if (phase_known) begin
            step_known <= 1'b1;
        end
        if (time_slot_ends) begin
            sign_due <= has_sign;
            step_due <= crosses;
            step_known <= 1'b0;
            when <= read[6:5] + ONE_TICK;
        end
    end
endmodule

// Memory of the commits of axis 0: which outputs change, and their levels.
module carrystep_output_words (
    // The clock.
    input  wire         clock,
    // Reads a word in this cycle.
    input  wire         read,
    // The address of the word to read.
    input  wire   [4:0] read_address,
    // The word that was read last.
    output wire  [15:0] read_data,
    // Writes a word in this cycle.
    input  wire         write,
    // The address of the word to write.
    input  wire   [4:0] write_address,
    // The new word.
    input  wire  [15:0] write_data
);
    wire unused = &{read_address[4:3], write_address[4:3]};

    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [15:0] words [0:7];
    reg [15:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 8; i = i + 1) words[i] = 0;
    end

    always @(posedge clock) begin
        if (read) value <= words[read_address[2:0]];
        if (write) words[write_address[2:0]] <= write_data;
    end
endmodule

// Memory of the commits of axis 0: the duty of the PWM.
module carrystep_duty_words (
    // The clock.
    input  wire         clock,
    // Reads a word in this cycle.
    input  wire         read,
    // The address of the word to read.
    input  wire   [4:0] read_address,
    // The word that was read last.
    output wire  [12:0] read_data,
    // Writes a word in this cycle.
    input  wire         write,
    // The address of the word to write.
    input  wire   [4:0] write_address,
    // The new word.
    input  wire  [12:0] write_data
);
    wire unused = &{read_address[4:3], write_address[4:3]};

    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [12:0] words [0:7];
    reg [12:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 8; i = i + 1) words[i] = 0;
    end

    always @(posedge clock) begin
        if (read) value <= words[read_address[2:0]];
        if (write) words[write_address[2:0]] <= write_data;
    end
endmodule

// The outputs, which change where a segment of axis 0 begins; and the new duties of the PWM.
module carrystep_output_control #(
    // The outputs at `outputs` that exist; a mask of 8 bits
    parameter [31:0] OUTPUTS = 32'd0,
    // Length of each of the 4096 steps of a period of the PWM, in clocks; 0: no PWM; 0 to 256
    parameter [31:0] PWM_DIVIDER = 32'd0
) (
    // The clock.
    input  wire         clock,
    // The beats of `time_slot`: bit i is asserted in beat i of a time slot.
    input  wire  [16:0] beat,
    // The time slot is that of axis 0.
    input  wire         first,
    // The engine accepts a word of the host in this clock, for the axis of the time slot.
    input  wire         take,
    // The number of that word.
    input  wire   [3:0] put_word,
    // That word.
    input  wire  [31:0] put_data,
    // The slot that the host writes.
    input  wire   [4:0] fresh,
    // The slot of the running segment.
    input  wire   [4:0] live,
    // The axis starts in this tick.
    input  wire         starts,
    // In beat 12: the next segment of the axis begins with the next tick.
    input  wire         follows,
    // All outputs are off from the next clock on.
    input  wire         off,
    // The pins; 1 is active.
    output wire   [7:0] pins,
    // At a strobe: the duty of the PWM changes.
    output wire         sets_duty,
    // The new duty, valid with `sets_duty`.
    output wire  [11:0] duty,
    // Fault: the commit accepted in the clock before had bits that it must not have.
    output wire         stray
);
    localparam [7:0] EXIST = OUTPUTS[7:0];
    localparam HAS_PWM = PWM_DIVIDER != 32'd0;
    localparam [31:0] LACKS = ((OUTPUTS != 32'd0) | (PWM_DIVIDER != 32'd0)) ? ~(((OUTPUTS * 32'd4112) | ((PWM_DIVIDER != 32'd0) ? 32'hfff00002 : 32'd0)) | 32'd1) : 32'd0;
    localparam [31:0] HAS = (OUTPUTS * 32'd4112) | ((PWM_DIVIDER != 32'd0) ? 32'hfff00002 : 32'd0);
    localparam [3:0] COMMIT = 4'd7;
    localparam [12:0] DUTY_VALID = 13'd4096;
    localparam [12:0] NO_DUTY = 13'd0;
    localparam [7:0] NO_LEVELS = 8'd0;

    generate
        if (OUTPUTS > 32'd255) begin : outputs_out_of_range
            carrystep_error_outputs_out_of_range error ();
        end
    endgenerate

    reg [7:0] levels = 8'd0;
    reg [4:0] place = 5'd0;
    reg follower = 1'b0;
    reg begun = 1'b0;
    reg due = 1'b0;
    reg wrong = 1'b0;
    reg [12:0] sets_bit;

    wire [15:0] output_words_read_data;
    wire [12:0] duty_words_read_data;

    wire commits = take & (put_word == COMMIT);
    wire stores = commits & first;
    wire [31:0] never = put_data & LACKS;
    wire [31:0] of_others = put_data & HAS;
    wire applies = first & beat[0];
    wire [7:0] mask = output_words_read_data[7:0] & EXIST;
    wire [7:0] new_levels = output_words_read_data[15:8];

    assign pins = levels;
    assign sets_duty = due & duty_words_read_data[12] & (HAS_PWM != 1'b0);
    assign duty = duty_words_read_data[11:0];
    assign stray = wrong;

    always @(*) begin
        sets_bit = NO_DUTY;
        if (put_data[1]) begin
            sets_bit = DUTY_VALID;
        end
    end

    carrystep_output_words output_words (
        .clock(clock),
        .read(applies),
        .read_address(place),
        .read_data(output_words_read_data),
        .write(stores),
        .write_address(fresh),
        .write_data(put_data[19:4])
    );

    carrystep_duty_words duty_words (
        .clock(clock),
        .read(applies),
        .read_address(place),
        .read_data(duty_words_read_data),
        .write(stores),
        .write_address(fresh),
        .write_data({1'b0, put_data[31:20]} | sets_bit)
    );

    always @(posedge clock) begin
        wrong <= commits & ((never != 32'd0) | (!first & (of_others != 32'd0)));
        if (first & beat[12]) begin
            place <= live;
            begun <= starts | follower;
            follower <= follows;
        end
        if (applies) begin
            due <= begun;
        end
        if (applies & due) begin
            levels <= (levels & ~mask) | (new_levels & mask);
        end
        if (off) begin
            levels <= NO_LEVELS;
        end
    end
endmodule

// The PWM: its pin is active for the duty, a part of each period.
module carrystep_pulse_width #(
    // Length of each of the 4096 steps of a period of the PWM, in clocks; 0: no PWM; 0 to 256
    parameter [31:0] PWM_DIVIDER = 32'd0
) (
    // The clock.
    input  wire         clock,
    // The duty changes.
    input  wire         set,
    // The new duty, valid with `set`.
    input  wire  [11:0] duty,
    // The pin is off from the next clock on, and the duty is 0.
    input  wire         off,
    // The pin; 1 is active.
    output wire         pin
);
    // A mask of the bits that a counter from 0 to `greatest` uses.
    function [7:0] used_bits_8(input [7:0] greatest);
        begin
            used_bits_8 = greatest;
            used_bits_8 = used_bits_8 | (used_bits_8 >> 1);
            used_bits_8 = used_bits_8 | (used_bits_8 >> 2);
            used_bits_8 = used_bits_8 | (used_bits_8 >> 4);
        end
    endfunction
    localparam [7:0] LAST = (PWM_DIVIDER != 32'd0) ? (PWM_DIVIDER[7:0] - 8'd1) : 8'd0;
    localparam [7:0] DIVIDER_BITS = used_bits_8((PWM_DIVIDER != 32'd0) ? (PWM_DIVIDER[7:0] - 8'd1) : 8'd0);
    localparam [11:0] STEPS = (PWM_DIVIDER != 32'd0) ? 12'd4095 : 12'd0;
    localparam [7:0] ONE_CLOCK = 8'd1;
    localparam [7:0] NO_CLOCK = 8'd0;
    localparam [11:0] ONE_STEP = 12'd1;
    localparam [11:0] NO_DUTY = 12'd0;

    generate
        if (PWM_DIVIDER > 32'd256) begin : pwm_divider_out_of_range
            carrystep_error_pwm_divider_out_of_range error ();
        end
    endgenerate

    reg [7:0] divided = 8'd0;
    reg [11:0] count = 12'd0;
    reg [11:0] width = 12'd0;
    reg high = 1'b0;

    wire over = divided == LAST;

    assign pin = high;

    always @(posedge clock) begin
        divided <= (divided + ONE_CLOCK) & DIVIDER_BITS;
        if (over) begin
            divided <= NO_CLOCK;
            count <= (count + ONE_STEP) & STEPS;
        end
        if (set) begin
            width <= duty & STEPS;
        end
        if (off) begin
            width <= NO_DUTY;
        end
        high <= (count < width) & !off;
    end
endmodule

// Memory of the debounced state of each switch, and its count of deviating samples.
module carrystep_switch_memory (
    // The clock.
    input  wire         clock,
    // The address of the word to read.
    input  wire   [4:0] read_address,
    // The word at the address of the cycle before.
    output wire   [7:0] read_data,
    // The address of the word to write.
    input  wire   [4:0] write_address,
    // The write enable of each bit.
    input  wire   [7:0] write_bits,
    // The new values of the bits that are written.
    input  wire   [7:0] write_data
);
    // No word that is read in the clock in which it is written is ever used: no bypass is needed.
    (* no_rw_check, ram_style = "block" *) reg [7:0] words [0:31];
    reg [7:0] value; // a block RAM gives no value before its first clock
    integer i;

    assign read_data = value;

    initial begin
        for (i = 0; i < 32; i = i + 1) words[i] = 0;
    end

    always @(posedge clock) begin
        value <= words[read_address];
        if (write_bits[0]) words[write_address] <= write_data;
    end
endmodule

// Samples and debounces limits and other inputs, each in the time slot of its axis.
module carrystep_switches #(
    // Length of a round, the unit of the times below, in ticks; a power of two from 2 to 1024
    parameter [31:0] ROUND_TICKS = 32'd32,
    // Equal consecutive samples, one per round, that change a switch's debounced state; 1 to 127
    parameter [31:0] DEBOUNCE_SAMPLES = 32'd17,
    // Limit switches: 0 none, 1 two per axis, 2 one per axis, 3 one for all axes; 0 to 3
    parameter [31:0] LIMITS = 32'd1,
    // Active level of the limit switches: 0 high, 1 low; 0 or 1
    parameter [31:0] LIMITS_LOW = 32'd0,
    // The inputs at `inputs_0` that exist; bit 0 is the probe; a mask with one bit per axis
    parameter [31:0] INPUTS_0 = 32'd0,
    // Those of them that are active low; a part of INPUTS_0
    parameter [31:0] INPUTS_0_LOW = 32'd0,
    // The inputs at `inputs_1` that exist; bit 0 is the interlock; a mask with one bit per axis
    parameter [31:0] INPUTS_1 = 32'd0,
    // Those of them that are active low; a part of INPUTS_1
    parameter [31:0] INPUTS_1_LOW = 32'd0
) (
    // The clock.
    input  wire         clock,
    // Asserted in the last beat of a time slot.
    input  wire         time_slot_ends,
    // The axis of the slot, as a number.
    input  wire   [2:0] axis,
    // The axis of the next clock, as a number.
    input  wire   [2:0] axis_next,
    // The axis of the slot, one-hot.
    input  wire   [5:0] axis_one_hot,
    // The number of the tick in its round, modulo 4.
    input  wire   [1:0] row,
    // The tick is one of the first four of a round.
    input  wire         begins_round,
    // The pins at the low ends. With one switch per axis, the pin of that switch; with one for all
    // axes, bit 0. Asynchronous.
    input  wire   [5:0] limit_min,
    // The pins at the high ends; asynchronous.
    input  wire   [5:0] limit_max,
    // The pins of row 2; asynchronous.
    input  wire   [5:0] inputs_0,
    // The pins of row 3; asynchronous.
    input  wire   [5:0] inputs_1,
    // The axis moves in this tick, with V != 0.
    input  wire         goes,
    // V < 0 in this tick.
    input  wire         back,
    // A reset: all switches become inactive, as at configuration.
    input  wire         resetting,
    // In this tick a switch is sampled in each time slot.
    output wire         samples,
    // From beat 2: the level of the switch's pin two clocks ago.
    output wire         level,
    // From beat 1: the debounced state of the switch before this sample.
    output wire         earlier,
    // In the last beat: the debounced state after this sample.
    output wire         state,
    // In the last beat: the switch is a limit, and the axis has reached it.
    output wire         found,
    // The debounced state of the interlock: it is open.
    output wire         interlock
);
    localparam [3:0] ROWS = (((4'd0 | ((LIMITS != 32'd0) ? 4'd1 : 4'd0)) | ((LIMITS == 32'd1) ? 4'd2 : 4'd0)) | ((INPUTS_0 != 32'd0) ? 4'd4 : 4'd0)) | ((INPUTS_1 != 32'd0) ? 4'd8 : 4'd0);
    localparam PAIR = LIMITS == 32'd1;
    localparam ONE_FOR_ALL = LIMITS == 32'd3;
    localparam HAS_INPUTS = (INPUTS_0 != 32'd0) | (INPUTS_1 != 32'd0);
    localparam HAS_ROW_3 = INPUTS_1 != 32'd0;
    localparam HAS_INTERLOCK = INPUTS_1[0];
    localparam [5:0] LEVELS = LIMITS_LOW[0] ? 6'd63 : 6'd0;
    localparam [5:0] EXIST_0 = INPUTS_0[5:0];
    localparam [5:0] EXIST_1 = INPUTS_1[5:0];
    localparam [5:0] LOW_0 = INPUTS_0_LOW[5:0];
    localparam [5:0] LOW_1 = INPUTS_1_LOW[5:0];
    localparam [6:0] LAST_SAMPLE = DEBOUNCE_SAMPLES[6:0] - 7'd1;
    localparam [5:0] FIRST_ONE_HOT = 6'd1;
    localparam [3:0] FIRST_ROW = 4'd1;
    localparam [6:0] ONE = 7'd1;
    localparam [6:0] NONE = 7'd0;
    localparam [7:0] ACTIVE = 8'd128;
    localparam [7:0] NO = 8'd0;
    localparam [7:0] ALL = 8'd255;
    localparam [1:0] TO_INPUTS = 2'd2;
    localparam [1:0] LIMITS_ONLY = 2'd1;
    localparam [1:0] BY_TWO = 2'd2;

    generate
        if (LIMITS > 32'd3) begin : limits_out_of_range
            carrystep_error_limits_out_of_range error ();
        end
        if (LIMITS_LOW > 32'd1) begin : limits_low_out_of_range
            carrystep_error_limits_low_out_of_range error ();
        end
        if ((DEBOUNCE_SAMPLES < 32'd1) | (DEBOUNCE_SAMPLES > 32'd127)) begin : debounce_samples_out_of_range
            carrystep_error_debounce_samples_out_of_range error ();
        end
        if (INPUTS_0 > 32'd63) begin : inputs_0_out_of_range
            carrystep_error_inputs_0_out_of_range error ();
        end
        if (INPUTS_1 > 32'd63) begin : inputs_1_out_of_range
            carrystep_error_inputs_1_out_of_range error ();
        end
        if ((INPUTS_0_LOW & ~INPUTS_0) != 32'd0) begin : inputs_0_low_out_of_range
            carrystep_error_inputs_0_low_out_of_range error ();
        end
        if ((INPUTS_1_LOW & ~INPUTS_1) != 32'd0) begin : inputs_1_low_out_of_range
            carrystep_error_inputs_1_low_out_of_range error ();
        end
        if ((ROUND_TICKS < 32'd4) & ((INPUTS_0 != 32'd0) | (INPUTS_1 != 32'd0))) begin : round_ticks_too_few_for_inputs
            carrystep_error_round_ticks_too_few_for_inputs error ();
        end
    endgenerate

    reg sync = 1'b0;
    reg now = 1'b0;
    reg open = 1'b0;
    reg [5:0] pins;
    reg [5:0] chosen;
    reg [1:0] row_written;
    reg [6:0] count;
    reg [7:0] next_word;
    reg [7:0] switch_memory_write_bits;

    wire [7:0] switch_memory_read_data;

    wire is_row = (ROWS & (FIRST_ROW << row)) != 4'd0;
    wire sampled = begins_round & is_row;
    wire inputs = row[1] & (HAS_INPUTS != 1'b0);
    wire [7:0] word = switch_memory_read_data;
    wire differs = now ^ word[7];
    wire flips = differs & (word[6:0] == LAST_SAMPLE);
    wire state_now = (word[7] ^ flips) & !resetting;

    assign samples = sampled;
    assign level = now;
    assign earlier = word[7];
    assign state = state_now;
    assign found = sampled & time_slot_ends & goes & state_now & !inputs & (((PAIR != 1'b0) & (back ^ row[0])) | ((PAIR == 1'b0) & flips));
    assign interlock = open;

    always @(*) begin
        pins = limit_min ^ LEVELS;
        if (row[0]) begin
            pins = limit_max ^ LEVELS;
        end
        if (inputs) begin
            pins = (inputs_0 ^ LOW_0) & EXIST_0;
            if (row[0] & (HAS_ROW_3 != 1'b0)) begin
                pins = (inputs_1 ^ LOW_1) & EXIST_1;
            end
        end
    end

    always @(*) begin
        chosen = pins & axis_one_hot;
        if ((ONE_FOR_ALL != 1'b0) & !inputs) begin
            chosen = pins & FIRST_ONE_HOT;
        end
    end

    always @(*) begin
        row_written = row & LIMITS_ONLY;
        if (inputs | (resetting & (HAS_INPUTS != 1'b0) & !time_slot_ends)) begin
            row_written = row | TO_INPUTS;
        end
    end

    always @(*) begin
        count = NONE;
        if (differs & !flips & !resetting) begin
            count = word[6:0] + ONE;
        end
    end

    always @(*) begin
        next_word = {1'b0, count};
        if (state_now) begin
            next_word = {1'b0, count} | ACTIVE;
        end
    end

    always @(*) begin
        switch_memory_write_bits = NO;
        if ((sampled & time_slot_ends) | (resetting & (HAS_INPUTS != 1'b0))) begin
            switch_memory_write_bits = ALL;
        end
    end

    carrystep_switch_memory switch_memory (
        .clock(clock),
        .read_address(({2'b0, axis_next} << BY_TWO) | {3'b0, row}),
        .read_data(switch_memory_read_data),
        .write_address(({2'b0, axis} << BY_TWO) | {3'b0, row_written}),
        .write_bits(switch_memory_write_bits),
        .write_data(next_word)
    );

    always @(posedge clock) begin
        sync <= chosen != 6'd0;
        now <= sync;
        if (sampled & time_slot_ends & inputs & row[0] & axis_one_hot[0] & (HAS_INTERLOCK != 1'b0)) begin
            open <= state_now;
        end
        if (resetting) begin
            open <= 1'b0;
        end
    end
endmodule

// Seek: the source of a seek, the axes that wait for it, and those that have hit it.
module carrystep_seek_control (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of a tick.
    input  wire         strobe,
    // The host replaces the source.
    input  wire         set_source,
    // The new source, valid with `set_source`: axis 3, row 2, own 1, level 1.
    input  wire   [6:0] source,
    // The host replaces the mask of the axes that wait for the source.
    input  wire         set,
    // The new mask, valid with `set`; bit i is axis i.
    input  wire   [5:0] mask,
    // Asserted in the last beat of a time slot.
    input  wire         time_slot_ends,
    // The axis of the time slot, as a number.
    input  wire   [2:0] axis,
    // The axis of the time slot, one-hot. At a strobe it is the first axis.
    input  wire   [5:0] axis_one_hot,
    // The row of the switches that this tick samples.
    input  wire   [1:0] row,
    // This tick samples a switch in each time slot.
    input  wire         samples,
    // In the last beat of a time slot: the debounced state of its switch.
    input  wire         state,
    // The axis of the slot runs in the next tick too.
    input  wire         goes_on,
    // A reset: no axis waits for the source any more, and none has hit it.
    input  wire         resetting,
    // The axes that wait for the source; bit i is axis i.
    output wire   [5:0] seeking,
    // The axes that have hit it; bit i is axis i.
    output wire   [5:0] hits,
    // The axis of the slot has hit the source in an earlier tick: it ramps down and rests.
    output wire         slows,
    // A limit that the axis of the slot finds belongs to its seek, and triggers no stop.
    output wire         forgives,
    // In the last beat of a slot: its axis has waited for its own switch and has hit it.
    output wire         caught,
    // In this tick the common source of all axes was hit.
    output wire         sweeps
);
    localparam [5:0] NONE = 6'd0;
    localparam BY_ONE = 1'b1;
    localparam [2:0] TO_TOP = 3'd5;

    reg [6:0] origin = 7'd0;
    reg [5:0] waiting = 6'd0;
    reg [5:0] slowing = 6'd0;
    reg released = 1'b0;
    reg common = 1'b0;
    reg mine_slows = 1'b0;
    reg [5:0] axis_one_hot_next;

    wire is_source = (row == origin[4:3]) & (origin[5] | (axis == origin[2:0]));
    wire hit = time_slot_ends & samples & is_source & !(state ^ origin[6]);
    wire mine = (waiting & axis_one_hot) != 6'd0;
    wire found = hit & origin[5] & mine;
    wire sweep = strobe & common;

    assign seeking = waiting;
    assign hits = slowing;
    assign slows = mine_slows;
    assign forgives = is_source & (mine | mine_slows);
    assign caught = found;
    assign sweeps = common;

    always @(*) begin
        axis_one_hot_next = axis_one_hot;
        if (time_slot_ends) begin
            axis_one_hot_next = (axis_one_hot << BY_ONE) | (axis_one_hot >> TO_TOP);
        end
    end

    always @(posedge clock) begin
        if (set_source) begin
            origin <= source;
        end
        if (hit & !origin[5] & (waiting != 6'd0)) begin
            common <= 1'b1;
        end
        if (strobe | resetting) begin
            common <= 1'b0;
        end
        if (found) begin
            waiting <= waiting & ~axis_one_hot;
            released <= 1'b0;
        end
        if (sweep) begin
            waiting <= NONE;
            released <= 1'b0;
        end
        if (set) begin
            waiting <= mask;
            released <= 1'b1;
        end
        if (resetting) begin
            waiting <= NONE;
            released <= 1'b0;
        end
        if (time_slot_ends & mine_slows & !goes_on & released) begin
            slowing <= slowing & ~axis_one_hot;
        end
        if (found) begin
            slowing <= slowing | axis_one_hot;
        end
        if (sweep) begin
            slowing <= slowing | waiting;
        end
        if (resetting) begin
            slowing <= NONE;
        end
        mine_slows <= ((slowing & axis_one_hot_next) != 6'd0) | (sweep & waiting[0]);
    end
endmodule

// The latch: at an edge of its pin the state of all axes is output on a page of its own.
module carrystep_edge_latch #(
    // Consecutive ticks that must find the latch active for an edge; 0: no latch; 0 to 16
    parameter [31:0] LATCH_LOOKS = 32'd0,
    // Active level of the latch: 0 high, 1 low; 0 or 1
    parameter [31:0] LATCH_LOW = 32'd0
) (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of a tick.
    input  wire         strobe,
    // The pin; asynchronous.
    input  wire         pin,
    // The host arms the latch.
    input  wire         arm,
    // A reset: the latch returns to its state at configuration.
    input  wire         resetting,
    // At a strobe: the next tick outputs the words of the latch.
    output wire         comes,
    // This tick outputs the words of the latch.
    output wire         latches,
    // The latch waits for its edge.
    output wire         armed,
    // The edges since it was armed that it did not latch, at most 15.
    output wire   [3:0] edges
);
    // A mask of the bits that a counter from 0 to `greatest` uses.
    function [3:0] used_bits_4(input [3:0] greatest);
        begin
            used_bits_4 = greatest;
            used_bits_4 = used_bits_4 | (used_bits_4 >> 1);
            used_bits_4 = used_bits_4 | (used_bits_4 >> 2);
        end
    endfunction
    localparam EXISTS = LATCH_LOOKS != 32'd0;
    localparam LOW = LATCH_LOW[0];
    localparam [3:0] LAST_LOOK = LATCH_LOOKS[3:0] - 4'd1;
    localparam [3:0] COUNT_BITS = used_bits_4(LATCH_LOOKS[3:0] - 4'd1);
    localparam [3:0] ONE = 4'd1;
    localparam [3:0] NONE = 4'd0;
    localparam [3:0] MOST = 4'd15;

    generate
        if (LATCH_LOOKS > 32'd16) begin : latch_looks_out_of_range
            carrystep_error_latch_looks_out_of_range error ();
        end
        if (LATCH_LOW > 32'd1) begin : latch_low_out_of_range
            carrystep_error_latch_low_out_of_range error ();
        end
    endgenerate

    reg sync = 1'b0;
    reg now = 1'b0;
    reg accepted = 1'b0;
    reg [3:0] count = 4'd0;
    reg waits = 1'b0;
    reg copies = 1'b0;
    reg [3:0] further = 4'd0;

    wire differs = now ^ accepted;
    wire ripe = count == LAST_LOOK;
    wire rises = strobe & now & !accepted & ripe;

    assign comes = rises & waits;
    assign latches = copies;
    assign armed = waits;
    assign edges = further;

    always @(posedge clock) begin
        sync <= (pin ^ (LOW != 1'b0)) & (EXISTS != 1'b0);
        now <= sync;
        if (strobe) begin
            count <= NONE;
            if (differs & ripe) begin
                accepted <= now;
            end
            if (differs & !ripe) begin
                count <= (count + ONE) & COUNT_BITS;
            end
            copies <= rises & waits;
        end
        if (rises) begin
            waits <= 1'b0;
            if (!waits & (further != MOST)) begin
                further <= further + ONE;
            end
        end
        if (arm) begin
            waits <= EXISTS != 1'b0;
            further <= NONE;
        end
        if (resetting) begin
            accepted <= 1'b0;
            count <= NONE;
            copies <= 1'b0;
            waits <= 1'b0;
            further <= NONE;
        end
    end
endmodule

// Outputs the state of every axis in its time slot, and takes snapshots of all axes.
module carrystep_readout (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of a tick.
    input  wire         strobe,
    // The beats of `time_slot`: bit i is asserted in beat i of a time slot.
    input  wire  [16:0] beat,
    // The time slot is that of the last axis.
    input  wire         is_last,
    // The host requests a snapshot.
    input  wire         snapshot,
    // In beat 12: the axis has hit its own source.
    input  wire         caught,
    // The words of the axis are still to be output for the hit of its own source.
    input  wire         met,
    // At a strobe: the common source of all axes was hit in this tick.
    input  wire         sweeps,
    // At a strobe: the next tick outputs the words of the latch.
    input  wire         comes,
    // This tick outputs the words of the latch.
    input  wire         latches,
    // In this tick a switch is sampled in each time slot.
    input  wire         samples,
    // The row of that switch.
    input  wire   [1:0] row,
    // In beat 7: the debounced state of that switch, before this sample.
    input  wire         earlier,
    // In beat 7: the level of its pin.
    input  wire         level,
    // The last two ticks of a reset: no word of a switch is output.
    input  wire         resetting,
    // The word that the memory returns.
    input  wire  [31:0] word,
    // The slot of the running segment.
    input  wire   [4:0] live,
    // The axis runs in this tick.
    input  wire         running,
    // The number of segments for which the queue has space.
    input  wire   [4:0] room,
    // Carries less counted steps, modulo 16.
    input  wire   [3:0] on_way,
    // A word of the state of the axis of this time slot is output.
    output wire         valid,
    // Its page.
    output reg    [1:0] page,
    // Its item.
    output reg    [2:0] item,
    // The word. Of the status, bits 31 to 16 have no meaning.
    output wire  [31:0] state,
    // All live words of this tick have been output.
    output wire         refreshed,
    // In beat 12: the words of the axis are to be output for the hit of its own source, in the next
    // tick that the latch does not need.
    output wire         meets
);
    localparam [4:0] SLOTS = 5'd7;
    localparam [31:0] HIGH_HALF = 32'hffff0000;
    localparam [15:0] NO_STATUS = 16'd0;
    localparam [15:0] RUNNING_BIT = 16'd32;
    localparam [3:0] AT_6 = 4'd6;
    localparam [3:0] AT_12 = 4'd12;
    localparam [1:0] HIT_PAGE = 2'd0;
    localparam [1:0] LIVE_PAGE = 2'd1;
    localparam [1:0] SNAPSHOT_PAGE = 2'd2;
    localparam [1:0] LATCH_PAGE = 2'd3;
    localparam [15:0] STATE_BIT = 16'd128;
    localparam [15:0] LEVEL_BIT = 16'd64;
    localparam [15:0] OTHER_BITS = 16'd65343;
    localparam [2:0] NO_ITEM = 3'd0;
    localparam [2:0] ODD_ITEM = 3'd1;
    localparam [2:0] MIDDLE_ITEM = 3'd2;
    localparam [2:0] HIGH_ITEM = 3'd4;

    reg asked = 1'b0;
    reg takes = 1'b0;
    reg found = 1'b0;
    reg swept = 1'b0;
    reg [15:0] running_now;
    reg [15:0] low;
    reg [15:0] levels;

    wire owed = caught | (met & latches);
    wire captured = met | swept;
    wire taken = found | sweeps | (swept & latches) | comes;
    wire of_switch = beat[7] & samples & !resetting;
    wire ticks_left = beat[5];
    wire p_or_position = beat[4] | beat[10] | beat[6];
    wire odd = (ticks_left & running) | beat[10] | beat[11] | beat[12];
    wire [4:0] waiting = ~room & SLOTS;
    wire [15:0] status = {11'b0, live} | running_now | ({11'b0, waiting} << AT_6) | ({12'b0, on_way} << AT_12);

    assign valid = (ticks_left & (!captured | latches)) | of_switch | p_or_position | beat[11] | beat[12];
    assign state = (word & HIGH_HALF) | {16'b0, low};
    assign refreshed = beat[12] & is_last & !takes & !captured & !latches;
    assign meets = owed;

    always @(*) begin
        page = LIVE_PAGE;
        if (captured) begin
            page = HIT_PAGE;
        end
        if (takes) begin
            page = SNAPSHOT_PAGE;
        end
        if (latches) begin
            page = LATCH_PAGE;
        end
        if (of_switch) begin
            page = row;
        end
    end

    always @(*) begin
        item = NO_ITEM;
        if (odd) begin
            item = ODD_ITEM;
        end
        if (beat[11] | beat[6] | beat[12] | of_switch) begin
            item = item | MIDDLE_ITEM;
        end
        if (p_or_position | beat[12]) begin
            item = item | HIGH_ITEM;
        end
    end

    always @(*) begin
        running_now = NO_STATUS;
        if (running) begin
            running_now = RUNNING_BIT;
        end
    end

    always @(*) begin
        low = word[15:0];
        if (beat[12]) begin
            low = status;
        end
        if (of_switch) begin
            low = (word[15:0] & OTHER_BITS) | levels;
        end
    end

    always @(*) begin
        levels = NO_STATUS;
        if (earlier) begin
            levels = STATE_BIT;
        end
        if (level) begin
            levels = levels | LEVEL_BIT;
        end
    end

    always @(posedge clock) begin
        if (owed & beat[12]) begin
            found <= 1'b1;
        end
        if (strobe) begin
            found <= 1'b0;
            swept <= sweeps | (swept & latches);
        end
        if (strobe) begin
            takes <= asked & !taken;
            asked <= asked & taken;
        end
        if (snapshot) begin
            asked <= 1'b1;
        end
    end
endmodule

// Latches the first cause of a stop, and controls the stop until the host clears it.
module carrystep_stops #(
    // Effect of a limit: 0 all axes ramp down, 1 all axes freeze; 0 or 1
    parameter [31:0] LIMIT_FREEZES = 32'd0
) (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of a tick.
    input  wire         strobe,
    // Asserted in the last beat of a time slot. The inputs about the slot's axis are valid in this
    // clock.
    input  wire         time_slot_ends,
    // The axis of the slot, one-hot.
    input  wire   [5:0] axis_one_hot,
    // The axis of the slot runs in this tick.
    input  wire         runs,
    // The V of the axis is out of range.
    input  wire         too_fast,
    // The axis has reached a limit.
    input  wire         limit,
    // The axis needs a segment, and its queue is empty.
    input  wire         dry,
    // The axes at which a second step arrives while one is held back.
    input  wire   [5:0] late,
    // The e-stop is active.
    input  wire         pressed,
    // The host breaks the segment protocol.
    input  wire         breaks,
    // The watchdog has timed out.
    input  wire         missed,
    // The interlock is open.
    input  wire         interlock,
    // The host requests a controlled stop.
    input  wire         asked,
    // The host requests that the stop is cleared.
    input  wire         clear,
    // A step is held back, or a STEP pin is high.
    input  wire         pins_busy,
    // A reset is under way: all axes freeze, and `clear` has no effect.
    input  wire         ending,
    // The second tick of a reset, which clears the state of all axes.
    input  wire         stage_2,
    // Asserted in the last clock of a reset: the stop ends.
    input  wire         completes,
    // A stop has been called and has not been cleared.
    output wire         fault,
    // A time slot of this tick has found a cause.
    output wire         finds,
    // The stop is a freeze: no new pulse starts.
    output wire         frozen,
    // All axes ramp down.
    output wire         ramp,
    // No axis moves any more.
    output wire         halted,
    // A stop has been complete for a whole tick, and `clear` is not clearing it.
    output wire         settles,
    // This tick clears the state of all axes.
    output wire         clearing,
    // The first cause.
    output wire   [3:0] cause,
    // The axes that caused the stop; bit i is axis i.
    output wire   [5:0] culprits
);
    localparam LIMITS_FREEZE = LIMIT_FREEZES[0];
    localparam [3:0] E_STOP = 4'd0;
    localparam [3:0] OVERRUN = 4'd1;
    localparam [3:0] PROTOCOL = 4'd2;
    localparam [3:0] WATCHDOG = 4'd3;
    localparam [3:0] OVERSPEED = 4'd4;
    localparam [3:0] LIMITED = 4'd5;
    localparam [3:0] UNDERRUN = 4'd6;
    localparam [3:0] HOST = 4'd7;
    localparam [3:0] OPENED = 4'd8;

    generate
        if (LIMIT_FREEZES > 32'd1) begin : limit_freezes_out_of_range
            carrystep_error_limit_freezes_out_of_range error ();
        end
    endgenerate

    reg called = 1'b0;
    reg freeze = 1'b0;
    reg slow = 1'b0;
    reg still = 1'b0;
    reg settled = 1'b0;
    reg wiping = 1'b0;
    reg [3:0] first = 4'd0;
    reg [5:0] axes = 6'd0;
    reg found = 1'b0;
    reg [3:0] kind = 4'd0;
    reg found_freezing = 1'b0;
    reg ran = 1'b0;

    wire finds_now = time_slot_ends & (too_fast | limit | dry);
    wire urgent = (late != 6'd0) | (strobe & pressed) | breaks;
    wire ripe = strobe & found;
    wire by_host = (strobe & (missed | interlock)) | asked | ending;
    wire calls = urgent | ripe | by_host;

    assign fault = called;
    assign finds = found;
    assign frozen = freeze;
    assign ramp = slow;
    assign halted = still;
    assign settles = settled & !wiping;
    assign clearing = wiping | stage_2;
    assign cause = first;
    assign culprits = axes;

    always @(posedge clock) begin
        if (finds_now) begin
            found <= 1'b1;
        end
        if (finds_now & !found) begin
            kind <= UNDERRUN;
            if (limit) begin
                kind <= LIMITED;
            end
            if (too_fast) begin
                kind <= OVERSPEED;
            end
        end
        if (time_slot_ends & (too_fast | (limit & (LIMITS_FREEZE != 1'b0)))) begin
            found_freezing <= 1'b1;
        end
        if (time_slot_ends & runs) begin
            ran <= 1'b1;
        end
        if (!called) begin
            if (urgent | (by_host & !ripe)) begin
                axes <= late;
            end else if (!found) begin
                axes <= axis_one_hot;
            end
        end
        if (calls & !called) begin
            first <= HOST;
            if (strobe & interlock) begin
                first <= OPENED;
            end
            if (strobe & missed) begin
                first <= WATCHDOG;
            end
            if (ripe) begin
                first <= kind;
            end
            if (breaks) begin
                first <= PROTOCOL;
            end
            if (strobe & pressed) begin
                first <= E_STOP;
            end
            if (late != 6'd0) begin
                first <= OVERRUN;
            end
        end
        if (calls) begin
            called <= 1'b1;
        end
        if (urgent | (strobe & found_freezing) | ending) begin
            freeze <= 1'b1;
        end
        if (strobe) begin
            found <= 1'b0;
            found_freezing <= 1'b0;
            ran <= 1'b0;
            slow <= called | found;
            still <= freeze | found_freezing | (slow & !ran);
            settled <= still;
            wiping <= clear & settled & !wiping & !pins_busy & !pressed & !interlock & !ending;
            if (wiping | completes) begin
                called <= 1'b0;
                freeze <= 1'b0;
                slow <= 1'b0;
                still <= 1'b0;
                settled <= 1'b0;
            end
        end
    end
endmodule

// The reset: freezes the engine, waits for rest, and restores the state at configuration.
module carrystep_resets (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of a tick.
    input  wire         strobe,
    // The host requests a reset.
    input  wire         reset,
    // A stop has been complete for a whole tick, and no clear of it is under way.
    input  wire         settled,
    // A step is held back, or a STEP pin is high.
    input  wire         pins_busy,
    // A reset is under way: all axes freeze.
    output wire         ending,
    // The first of the two ticks in which the state is reset.
    output wire         stage_1,
    // The second of them. It is repeated while `reset` is asserted.
    output wire         stage_2,
    // One of the two ticks.
    output wire         resetting,
    // Asserted in the last clock of a reset.
    output wire         completes,
    // At a strobe: the counter of ticks in a round restarts.
    output wire         restarts_round
);

    reg asked = 1'b0;
    reg first = 1'b0;
    reg second = 1'b0;

    wire over = strobe & second & !reset;

    assign ending = asked;
    assign stage_1 = first;
    assign stage_2 = second;
    assign resetting = first | second;
    assign completes = over;
    assign restarts_round = asked & strobe & !first;

    always @(posedge clock) begin
        if (over) begin
            asked <= 1'b0;
        end
        if (reset) begin
            asked <= 1'b1;
        end
        if (strobe) begin
            first <= asked & settled & !pins_busy & !first & !second;
            second <= first | (second & reset);
        end
    end
endmodule

// Monitors the e-stop and the host (watchdog), and times the power of the drivers.
module carrystep_supervisor #(
    // Length of a round, the unit of the times below, in ticks; a power of two from 2 to 1024
    parameter [31:0] ROUND_TICKS = 32'd32,
    // Rounds without a valid frame of the host after which all axes stop; 0: no watchdog; 0 to 4095
    parameter [31:0] WATCHDOG_ROUNDS = 32'd3126,
    // Rounds from the rising edge of `enabled` until starts are accepted; 0 to 4095
    parameter [31:0] ENABLE_ROUNDS = 32'd33,
    // Active level of the e-stop: 0 high, 1 low; 0 or 1
    parameter [31:0] ESTOP_LOW = 32'd0
) (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of a tick.
    input  wire         strobe,
    // The e-stop pin; asynchronous.
    input  wire         estop,
    // A sign of life of the host: the watchdog restarts.
    input  wire         kick,
    // The host requests power for the motor drivers.
    input  wire         enable,
    // All axes are at rest and no start is armed.
    input  wire         idle,
    // A reset is under way: the watchdog and the warm-up restart.
    input  wire         ending,
    // The last two ticks of a reset: the drivers get no power.
    input  wire         resetting,
    // A reset: the round restarts.
    input  wire         restarts_round,
    // At a strobe: the e-stop was active in the whole tick.
    output wire         pressed,
    // The watchdog has timed out: no `kick` for the specified number of rounds.
    output wire         missed,
    // The drivers are to be powered.
    output wire         enabled,
    // The drivers have been powered for the specified number of rounds.
    output wire         warm,
    // The number of the tick in its round, modulo 4: the row of the switches that are sampled.
    output wire   [1:0] row,
    // The tick is one of the first four of a round.
    output wire         begins_round
);
    // A mask of the bits that a counter from 0 to `greatest` uses.
    function [11:0] used_bits_12(input [11:0] greatest);
        begin
            used_bits_12 = greatest;
            used_bits_12 = used_bits_12 | (used_bits_12 >> 1);
            used_bits_12 = used_bits_12 | (used_bits_12 >> 2);
            used_bits_12 = used_bits_12 | (used_bits_12 >> 4);
            used_bits_12 = used_bits_12 | (used_bits_12 >> 8);
        end
    endfunction
    localparam PRESSED_LOW = ESTOP_LOW[0];
    localparam [9:0] ROUND_BITS = ROUND_TICKS[9:0] - 10'd1;
    localparam [11:0] WATCHDOG = WATCHDOG_ROUNDS[11:0];
    localparam [11:0] SILENCE_BITS = used_bits_12(WATCHDOG_ROUNDS[11:0]);
    localparam [11:0] WARM_AT = ENABLE_ROUNDS[11:0];
    localparam [11:0] WARM_BITS = used_bits_12(ENABLE_ROUNDS[11:0]);
    localparam [9:0] FIRST_TICK = 10'd0;
    localparam [9:0] ONE_TICK = 10'd1;
    localparam [7:0] NO_FOURS = 8'd0;
    localparam [11:0] NO_ROUND = 12'd0;
    localparam [11:0] ONE_ROUND = 12'd1;

    generate
        if (((ROUND_TICKS < 32'd2) | (ROUND_TICKS > 32'd1024)) | ((ROUND_TICKS & (ROUND_TICKS - 32'd1)) != 32'd0)) begin : round_ticks_out_of_range
            carrystep_error_round_ticks_out_of_range error ();
        end
        if (WATCHDOG_ROUNDS > 32'd4095) begin : watchdog_rounds_out_of_range
            carrystep_error_watchdog_rounds_out_of_range error ();
        end
        if (ENABLE_ROUNDS > 32'd4095) begin : enable_rounds_out_of_range
            carrystep_error_enable_rounds_out_of_range error ();
        end
        if (ESTOP_LOW > 32'd1) begin : estop_low_out_of_range
            carrystep_error_estop_low_out_of_range error ();
        end
    endgenerate

    reg sync = 1'b0;
    reg now = 1'b0;
    reg held = 1'b0;
    reg [9:0] round = 10'd0;
    reg [11:0] silence = 12'd0;
    reg power = 1'b0;
    reg [11:0] warmth = 12'd0;

    wire round_over = strobe & (round == ROUND_BITS);
    wire silent = silence == WATCHDOG;
    wire is_warm = warmth == WARM_AT;

    assign pressed = held & now;
    assign missed = silent & (WATCHDOG != 12'd0);
    assign enabled = power;
    assign warm = is_warm & power;
    assign row = round[1:0];
    assign begins_round = round[9:2] == NO_FOURS;

    always @(posedge clock) begin
        sync <= estop ^ (PRESSED_LOW != 1'b0);
        now <= sync;
        held <= now & (held | strobe);
        if (strobe) begin
            round <= (round + ONE_TICK) & ROUND_BITS;
        end
        if (restarts_round) begin
            round <= FIRST_TICK;
        end
        if (round_over & !silent) begin
            silence <= (silence + ONE_ROUND) & SILENCE_BITS;
        end
        if (kick | ending) begin
            silence <= NO_ROUND;
        end
        power <= (enable | (power & !idle)) & !resetting;
        if (round_over & !is_warm) begin
            warmth <= (warmth + ONE_ROUND) & WARM_BITS;
        end
        if (!power | ending) begin
            warmth <= NO_ROUND;
        end
    end
endmodule

// Drives STEP and DIR of one axis with the pulse width, gap, set-up and hold of its driver.
module carrystep_pulser #(
    // The minimum time in clocks for which STEP is high; 1 to 65536
    parameter [31:0] STEP_HIGH = 32'd8,
    // The minimum time in clocks for which STEP is low; 1 to 65536
    parameter [31:0] STEP_LOW = 32'd8,
    // The minimum time in clocks from a change of DIR to a rising edge of STEP; 1 to 65536
    parameter [31:0] DIR_SETUP = 32'd2,
    // The minimum time in clocks from a rising edge of STEP to a change of DIR; 1 to 65536
    parameter [31:0] DIR_HOLD = 32'd2
) (
    // The clock.
    input  wire         clock,
    // Asserted in a freezing stop. No new pulse starts and DIR does not change.
    input  wire         frozen,
    // A step is due in this clock.
    input  wire         request,
    // The requested step is backward.
    input  wire         request_back,
    // Asserted only at a strobe, if V != 0 in the tick before the one that ends: with the strobe
    // that ends tick n + 1 the V of tick n, whose step is made in tick n + 2. The register `want`
    // keeps the direction.
    input  wire         has_sign,
    // V < 0 in that tick; valid with `has_sign`.
    input  wire         sign_back,
    // The STEP pin.
    output wire         step,
    // The DIR pin; 1 is backward.
    output wire         dir,
    // A step is held back.
    output wire         held_back,
    // Bits 2 to 0: steps forward less steps backward, modulo 8. Bits 5 to 3: discarded steps,
    // modulo 8.
    output wire   [5:0] counts,
    // A second step arrives while one is held back that does not rise in this clock. The stop takes
    // effect in the next clock.
    output wire         overruns
);
    // A mask of the bits that a counter from 0 to `greatest` uses.
    function [15:0] used_bits_16(input [15:0] greatest);
        begin
            used_bits_16 = greatest;
            used_bits_16 = used_bits_16 | (used_bits_16 >> 1);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 2);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 4);
            used_bits_16 = used_bits_16 | (used_bits_16 >> 8);
        end
    endfunction
    // A mask of the bits that a counter from 0 to `greatest` uses.
    function [16:0] used_bits_17(input [16:0] greatest);
        begin
            used_bits_17 = greatest;
            used_bits_17 = used_bits_17 | (used_bits_17 >> 1);
            used_bits_17 = used_bits_17 | (used_bits_17 >> 2);
            used_bits_17 = used_bits_17 | (used_bits_17 >> 4);
            used_bits_17 = used_bits_17 | (used_bits_17 >> 8);
            used_bits_17 = used_bits_17 | (used_bits_17 >> 16);
        end
    endfunction
    localparam [16:0] STEP_HIGH_OVER = STEP_HIGH[16:0] - 17'd1;
    localparam [16:0] STEP_LOW_OVER = (STEP_HIGH[16:0] + STEP_LOW[16:0]) - 17'd2;
    localparam [16:0] HOLD_OVER = (DIR_HOLD[16:0] > 17'd2) ? (DIR_HOLD[16:0] - 17'd2) : 17'd0;
    localparam [16:0] SINCE_BITS = used_bits_17((((((STEP_HIGH[16:0] + STEP_LOW[16:0]) - 17'd2) > ((DIR_HOLD[16:0] > 17'd2) ? (DIR_HOLD[16:0] - 17'd2) : 17'd0)) ? ((STEP_HIGH[16:0] + STEP_LOW[16:0]) - 17'd2) : ((DIR_HOLD[16:0] > 17'd2) ? (DIR_HOLD[16:0] - 17'd2) : 17'd0)) > (STEP_HIGH[16:0] - 17'd1)) ? ((((STEP_HIGH[16:0] + STEP_LOW[16:0]) - 17'd2) > ((DIR_HOLD[16:0] > 17'd2) ? (DIR_HOLD[16:0] - 17'd2) : 17'd0)) ? ((STEP_HIGH[16:0] + STEP_LOW[16:0]) - 17'd2) : ((DIR_HOLD[16:0] > 17'd2) ? (DIR_HOLD[16:0] - 17'd2) : 17'd0)) : (STEP_HIGH[16:0] - 17'd1));
    localparam [15:0] SETUP_OVER = (DIR_SETUP == 32'd1) ? 16'd0 : (DIR_SETUP[15:0] - 16'd2);
    localparam [15:0] AFTER_BITS = used_bits_16((DIR_SETUP == 32'd1) ? 16'd0 : (DIR_SETUP[15:0] - 16'd2));
    localparam HOLDS = DIR_HOLD > 32'd1;
    localparam INSTANT = DIR_SETUP == 32'd1;
    localparam [16:0] SINCE_RISE = 17'd0;
    localparam [16:0] SINCE_ONE = 17'd1;
    localparam [15:0] AFTER_DIR_CHANGE = 16'd0;
    localparam [15:0] AFTER_ONE = 16'd1;
    localparam [3:0] AT_3 = 4'd3;
    localparam [2:0] ONE = 3'd1;
    localparam [2:0] MINUS_ONE = 3'd7;

    generate
        if ((STEP_HIGH < 32'd1) | (STEP_HIGH > 32'h10000)) begin : step_high_out_of_range
            carrystep_error_step_high_out_of_range error ();
        end
        if ((STEP_LOW < 32'd1) | (STEP_LOW > 32'h10000)) begin : step_low_out_of_range
            carrystep_error_step_low_out_of_range error ();
        end
        if ((DIR_SETUP < 32'd1) | (DIR_SETUP > 32'h10000)) begin : dir_setup_out_of_range
            carrystep_error_dir_setup_out_of_range error ();
        end
        if ((DIR_HOLD < 32'd1) | (DIR_HOLD > 32'h10000)) begin : dir_hold_out_of_range
            carrystep_error_dir_hold_out_of_range error ();
        end
    endgenerate

    reg step_pin = 1'b0;
    reg dir_pin = 1'b0;
    reg want = 1'b0;
    reg due = 1'b0;
    reg due_back = 1'b0;
    reg [16:0] since = 17'd0;
    reg [15:0] after = 16'd0;
    reg busy = 1'b0;
    reg held = 1'b0;
    reg settled = 1'b0;
    reg [2:0] count = 3'd0;
    reg [2:0] lost = 3'd0;
    reg first_back;
    reg aim;
    reg [2:0] change;

    wire pending = due | request;
    wire rise = pending & !frozen & !busy & (settled | (INSTANT != 1'b0)) & (dir_pin == first_back);
    wire dir_changes = !frozen & !held & (dir_pin != aim);
    wire second = due & request;
    wire late_now = second & !rise & !frozen;

    assign step = step_pin;
    assign dir = dir_pin;
    assign held_back = due;
    assign counts = {3'b0, count} | ({3'b0, lost} << AT_3);
    assign overruns = late_now;

    always @(*) begin
        first_back = request_back;
        if (due) begin
            first_back = due_back;
        end
    end

    always @(*) begin
        aim = want;
        if (pending) begin
            aim = first_back;
        end
    end

    always @(*) begin
        change = ONE;
        if (dir_pin) begin
            change = MINUS_ONE;
        end
    end

    always @(posedge clock) begin
        if (has_sign) begin
            want <= sign_back;
        end
        step_pin <= rise | (step_pin & (since != STEP_HIGH_OVER));
        dir_pin <= dir_pin ^ dir_changes;
        since <= (since + SINCE_ONE) & SINCE_BITS;
        busy <= busy & (since != STEP_LOW_OVER);
        held <= held & (since != HOLD_OVER);
        if (rise) begin
            since <= SINCE_RISE;
            busy <= 1'b1;
            held <= HOLDS != 1'b0;
        end
        after <= (after + AFTER_ONE) & AFTER_BITS;
        settled <= settled | (after == SETUP_OVER);
        if (dir_changes) begin
            after <= AFTER_DIR_CHANGE;
            settled <= 1'b0;
        end
        if (rise) begin
            count <= count + change;
        end
        due <= (pending & !rise & !frozen) | second;
        if (!due | rise) begin
            due_back <= request_back;
        end
        if ((frozen & pending) | late_now) begin
            lost <= lost + ONE;
        end
    end
endmodule

// The engine: all axes on one adder, with their queues, starts, stops and pins.
module carrystep_engine #(
    // Clocks per tick; a multiple of the phases, from 13 x axes + 1 and 2 x phases to 65536
    parameter [31:0] CLOCKS_PER_TICK = 32'd80,
    // Start value of P: 1 half a step, 0 zero; 0 or 1
    parameter [31:0] START_HALF = 32'd1,
    // The minimum time in clocks for which STEP is high; 1 to 65536
    parameter [31:0] STEP_HIGH_0 = 32'd8,
    parameter [31:0] STEP_HIGH_1 = 32'd80,
    parameter [31:0] STEP_HIGH_2 = 32'd152,
    parameter [31:0] STEP_HIGH_3 = 32'd200,
    parameter [31:0] STEP_HIGH_4 = 32'd8,
    parameter [31:0] STEP_HIGH_5 = 32'd240,
    // The minimum time in clocks for which STEP is low; 1 to 65536
    parameter [31:0] STEP_LOW_0 = 32'd8,
    parameter [31:0] STEP_LOW_1 = 32'd80,
    parameter [31:0] STEP_LOW_2 = 32'd152,
    parameter [31:0] STEP_LOW_3 = 32'd200,
    parameter [31:0] STEP_LOW_4 = 32'd8,
    parameter [31:0] STEP_LOW_5 = 32'd240,
    // The minimum time in clocks from a change of DIR to a rising edge of STEP; 1 to 65536
    parameter [31:0] DIR_SETUP_0 = 32'd2,
    parameter [31:0] DIR_SETUP_1 = 32'd16,
    parameter [31:0] DIR_SETUP_2 = 32'd52,
    parameter [31:0] DIR_SETUP_3 = 32'd400,
    parameter [31:0] DIR_SETUP_4 = 32'd2,
    parameter [31:0] DIR_SETUP_5 = 32'd120,
    // The minimum time in clocks from a rising edge of STEP to a change of DIR; 1 to 65536
    parameter [31:0] DIR_HOLD_0 = 32'd2,
    parameter [31:0] DIR_HOLD_1 = 32'd16,
    parameter [31:0] DIR_HOLD_2 = 32'd52,
    parameter [31:0] DIR_HOLD_3 = 32'd400,
    parameter [31:0] DIR_HOLD_4 = 32'd2,
    parameter [31:0] DIR_HOLD_5 = 32'd120,
    // Acceleration of the ramp in a controlled stop, in 2^-64 step per tick^2; 1 to 2^62
    parameter [63:0] STOP_ACCEL_0 = 64'hd6bf94d5e57,
    parameter [63:0] STOP_ACCEL_1 = 64'habcc7711846,
    parameter [63:0] STOP_ACCEL_2 = 64'ha10fafa06c1,
    parameter [63:0] STOP_ACCEL_3 = 64'h5f71977b826,
    parameter [63:0] STOP_ACCEL_4 = 64'hee9bfab4c61,
    parameter [63:0] STOP_ACCEL_5 = 64'h2843ebe81b0,
    // Length of a round, the unit of the times below, in ticks; a power of two from 2 to 1024
    parameter [31:0] ROUND_TICKS = 32'd32,
    // Rounds without a valid frame of the host after which all axes stop; 0: no watchdog; 0 to 4095
    parameter [31:0] WATCHDOG_ROUNDS = 32'd3126,
    // Rounds from the rising edge of `enabled` until starts are accepted; 0 to 4095
    parameter [31:0] ENABLE_ROUNDS = 32'd33,
    // Equal consecutive samples, one per round, that change a switch's debounced state; 1 to 127
    parameter [31:0] DEBOUNCE_SAMPLES = 32'd17,
    // Limit switches: 0 none, 1 two per axis, 2 one per axis, 3 one for all axes; 0 to 3
    parameter [31:0] LIMITS = 32'd1,
    // Active level of the limit switches: 0 high, 1 low; 0 or 1
    parameter [31:0] LIMITS_LOW = 32'd0,
    // Effect of a limit: 0 all axes ramp down, 1 all axes freeze; 0 or 1
    parameter [31:0] LIMIT_FREEZES = 32'd0,
    // The inputs at `inputs_0` that exist; bit 0 is the probe; a mask with one bit per axis
    parameter [31:0] INPUTS_0 = 32'd0,
    // Those of them that are active low; a part of INPUTS_0
    parameter [31:0] INPUTS_0_LOW = 32'd0,
    // The inputs at `inputs_1` that exist; bit 0 is the interlock; a mask with one bit per axis
    parameter [31:0] INPUTS_1 = 32'd0,
    // Those of them that are active low; a part of INPUTS_1
    parameter [31:0] INPUTS_1_LOW = 32'd0,
    // Consecutive ticks that must find the latch active for an edge; 0: no latch; 0 to 16
    parameter [31:0] LATCH_LOOKS = 32'd0,
    // Active level of the latch: 0 high, 1 low; 0 or 1
    parameter [31:0] LATCH_LOW = 32'd0,
    // Active level of the e-stop: 0 high, 1 low; 0 or 1
    parameter [31:0] ESTOP_LOW = 32'd0,
    // The outputs at `outputs` that exist; a mask of 8 bits
    parameter [31:0] OUTPUTS = 32'd0,
    // Effect of a stop by ramps on outputs and PWM: 0 none, 1 all off; a freeze turns them off; 0
    // or 1
    parameter [31:0] OUTPUTS_OFF_AT_RAMPS = 32'd0,
    // Length of each of the 4096 steps of a period of the PWM, in clocks; 0: no PWM; 0 to 256
    parameter [31:0] PWM_DIVIDER = 32'd0,
    // Cuts: 0 each is refused, 1 they exist; 0 or 1
    parameter [31:0] CUTS = 32'd0,
    // Event memory: block RAM, or LUTs if block RAM has no write mask; "block" or "distributed"
    parameter EVENT_MEMORY = "block"
) (
    // The clock.
    input  wire         clock,
    // The host offers a word of a segment and holds it until the engine accepts it, which takes up
    // to a tick while the queue has space.
    input  wire         put_valid,
    // The axis of the offered word, as a number from 0. Also the axis whose free queue space `room`
    // reports.
    input  wire   [2:0] put_axis,
    // The number of the word. The words of a segment come in order: 0 is its duration in ticks less
    // 1; 1 and 2 are the initial V, 3 and 4 the initial A, 5 and 6 J, low half first; 7 commits the
    // segment. A word 8 belongs to no segment: its bits 4 to 0 are the slot of the last segment
    // that the next cut keeps.
    input  wire   [3:0] put_word,
    // The offered word. In a commit, bit 0 is 1 if the segment is the last of its move. In a commit
    // of axis 0, bits 11 to 4 are the outputs that change where the segment begins, bits 19 to 12
    // their levels, and bits 31 to 20 the duty of the PWM, which changes if bit 1 is 1.
    input  wire  [31:0] put_data,
    // The engine accepts an offered word in this clock.
    output wire         put_ready,
    // The host offers a start and holds it until the engine accepts it, which it does in the last
    // clock of a tick.
    input  wire         start_valid,
    // The axes to start; bit i is axis i.
    input  wire   [5:0] start_mask,
    // The engine accepts an offered start in this clock.
    output wire         start_ready,
    // The host requests a cut in all axes for which it has offered a word 8; asserted for one
    // clock.
    input  wire         cut,
    // A cut was requested and is not decided yet.
    output wire         cut_busy,
    // The last cut was refused: nothing was dropped.
    output wire         cut_refused,
    // Clears a stop. The host holds it until `fault` falls.
    input  wire         clear,
    // Stops the engine and returns it to its state at configuration; the positions stay. It is
    // synchronous, unlike the pins, and begins in any clock. A host that does not need it ties it
    // to 0.
    input  wire         reset,
    // The host requests a controlled stop by a ramp; asserted for one clock or longer.
    input  wire         stop,
    // The host has broken the segment protocol; asserted for one clock or longer. The engine
    // freezes all axes.
    input  wire         broken,
    // The host replaces the source of seeks.
    input  wire         seek_source_valid,
    // The source from the next clock on, valid with `seek_source_valid`: in bits 2 to 0 the axis
    // and in bits 4 and 3 the row of a switch; in bit 5 that each axis waits for its own switch in
    // that row; in bit 6 the debounced state that is the hit, 1 active.
    input  wire   [6:0] seek_source,
    // The host replaces the mask of the axes that wait for the source.
    input  wire         seek_valid,
    // The axes that wait for the source from the next clock on, valid with `seek_valid`; bit i is
    // axis i. A mask of 0 ends the seek.
    input  wire   [5:0] seek_mask,
    // The host arms the latch for one edge, and sets the count of further edges to 0.
    input  wire         latch_arm,
    // The host requests a snapshot of the state of all axes; asserted for one clock or longer.
    input  wire         snapshot,
    // A sign of life of the host: the watchdog restarts in each clock in which it is asserted.
    input  wire         kick,
    // The host requests power for the motor drivers, as long as it is asserted.
    input  wire         enable,
    // The e-stop pin; asynchronous. The parameter `ESTOP_LOW` gives its active level. It stops the
    // axes if it is active for a whole tick.
    input  wire         estop,
    // The pins of the limit switches at the low ends; bit i is axis i; asynchronous. `LIMITS` tells
    // how they are wired, `LIMITS_LOW` their active level. Each is sampled once per round.
    input  wire   [5:0] limit_min,
    // The pins of the limit switches at the high ends; bit i is axis i; asynchronous. They are used
    // only if `LIMITS` is 1.
    input  wire   [5:0] limit_max,
    // The pins of the inputs that `INPUTS_0` names; bit 0 is the probe; asynchronous. Each is
    // debounced as the limits are.
    input  wire   [5:0] inputs_0,
    // The pins of the inputs that `INPUTS_1` names; bit 0 is the interlock, which stops all axes by
    // a ramp; asynchronous.
    input  wire   [5:0] inputs_1,
    // The pin of the latch; asynchronous. It is used unless `LATCH_LOOKS` is 0.
    input  wire         latch,
    // A word of the state of an axis is output in this clock.
    output wire         state_valid,
    // The copy to which it belongs: 0 hit of a seek, 1 live, 2 snapshot, 3 latch. Of the item 2 it
    // is the row of the switch: 0 and 1 limits at the low and the high ends, 2 and 3 inputs.
    output wire   [1:0] state_page,
    // The axis, as a number from 0.
    output wire   [2:0] state_axis,
    // The meaning of the word: 0 discarded steps, 1 remaining ticks, 2 switch (bit 7 its debounced
    // state, bit 6 the level of its pin), 3 number of the tick, 4 and 5 P (low and high half), 6
    // position in steps, 7 status.
    output wire   [2:0] state_item,
    // The word. Of the status only bits 15 to 0 have a meaning.
    output wire  [31:0] state,
    // All live words of this tick have been output; asserted for one clock.
    output wire         refreshed,
    // The number of segments for which the queue of the axis `put_axis` has space.
    output wire   [4:0] room,
    // `room` is valid in this clock, once in the time slot of that axis.
    output wire         room_valid,
    // The STEP pins; bit i is axis i. A rising edge is a step.
    output wire   [5:0] step,
    // The DIR pins; bit i is axis i; 1 is backward.
    output wire   [5:0] dir,
    // The outputs, which change where a segment of axis 0 begins; 1 is active.
    output wire   [7:0] outputs,
    // The pin of the PWM; 1 is active.
    output wire         pwm,
    // The motor drivers are to be powered.
    output wire         enabled,
    // All axes are at rest and no start is armed.
    output wire         idle,
    // A stop has been called and has not been cleared.
    output wire         fault,
    // The stop is complete: no axis moves any more.
    output wire         halted,
    // The engine is returning to its state at configuration, after `reset`.
    output wire         resetting,
    // The first cause of the stop: 0 e-stop, 1 overrun, 2 protocol, 3 watchdog, 4 overspeed, 5
    // limit, 6 underrun, 7 stop of the host, 8 interlock. It has no meaning while `fault` is not
    // asserted.
    output wire   [3:0] cause,
    // The axes that caused the stop; bit i is axis i. It has no meaning while `fault` is not
    // asserted.
    output wire   [5:0] culprits,
    // A start is armed.
    output wire         armed,
    // The host requests power for the drivers and they have been powered for long enough, so that a
    // start can be accepted.
    output wire         ready,
    // The axes that wait for the source of their seek; bit i is axis i.
    output wire   [5:0] seeking,
    // The axes that have hit the source, until the host ends the seek; bit i is axis i.
    output wire   [5:0] hits,
    // The latch waits for its edge.
    output wire         latch_armed,
    // The edges since the latch was armed that it did not latch, at most 15.
    output wire   [3:0] latch_edges,
    // Axes start at the end of this clock; asserted for one clock per start.
    output wire         started
);
    localparam [5:0] NONE = 6'd0;
    localparam [5:0] NO_AXES = 6'd0;
    localparam [5:0] ONE_AXIS_0 = 6'd1;
    localparam [5:0] ONE_AXIS_1 = 6'd2;
    localparam [5:0] ONE_AXIS_2 = 6'd4;
    localparam [5:0] ONE_AXIS_3 = 6'd8;
    localparam [5:0] ONE_AXIS_4 = 6'd16;
    localparam [5:0] ONE_AXIS_5 = 6'd32;
    localparam [3:0] COMMIT = 4'd7;
    localparam BY_ONE = 1'b1;
    localparam [2:0] TO_TOP = 3'd5;
    localparam [3:0] AXES = 4'd6;
    localparam OFF_AT_RAMPS = OUTPUTS_OFF_AT_RAMPS[0];

    generate
        if (OUTPUTS_OFF_AT_RAMPS > 32'd1) begin : outputs_off_at_ramps_out_of_range
            carrystep_error_outputs_off_at_ramps_out_of_range error ();
        end
        if (CLOCKS_PER_TICK < 32'd80) begin : clocks_per_tick_too_few_for_the_axes
            carrystep_error_clocks_per_tick_too_few_for_the_axes error ();
        end
    endgenerate

    reg waits = 1'b0;
    reg [5:0] mask = 6'd0;
    reg going = 1'b0;
    reg taken = 1'b0;
    reg [2:0] taken_word = 3'd0;
    reg unfed = 1'b0;
    reg held = 1'b0;
    reg drops = 1'b0;
    reg active = 1'b0;
    reg rest_1 = 1'b1;
    reg rest_2 = 1'b1;
    reg [5:0] counts;
    reg pins_busy;
    reg [5:0] late;
    reg [5:0] counted_0;
    reg [5:0] late_bit_0;
    reg [5:0] counted_1;
    reg [5:0] late_bit_1;
    reg [5:0] counted_2;
    reg [5:0] late_bit_2;
    reg [5:0] counted_3;
    reg [5:0] late_bit_3;
    reg [5:0] counted_4;
    reg [5:0] late_bit_4;
    reg [5:0] counted_5;
    reg [5:0] late_bit_5;

    wire [16:0] time_slot_beat;
    wire [2:0] time_slot_axis;
    wire [2:0] time_slot_axis_next;
    wire [5:0] time_slot_axis_one_hot;
    wire time_slot_is_last;
    wire [31:0] adder_sum;
    wire adder_ended;
    wire adder_overflow;
    wire adder_turned;
    wire adder_crosses;
    wire adder_back;
    wire adder_still;
    wire adder_least;
    wire [3:0] adder_q;
    wire [4:0] queue_live;
    wire [4:0] queue_fresh;
    wire queue_misplaced;
    wire queue_full;
    wire [4:0] queue_room;
    wire queue_empty;
    wire queue_running;
    wire queue_sound;
    wire queue_slows;
    wire queue_upward;
    wire queue_steady;
    wire queue_moves;
    wire queue_goes_on;
    wire queue_advances;
    wire queue_too_fast;
    wire queue_dry;
    wire queue_misses;
    wire queue_met;
    wire [6:0] queue_counts;
    wire [6:0] step_counts_next_counts;
    wire step_counts_up;
    wire step_counts_down;
    wire step_counts_lost;
    wire [3:0] step_counts_on_way;
    wire cut_control_checks;
    wire cut_control_cuts;
    wire cut_control_closes;
    wire cut_control_busy;
    wire cut_control_refused;
    wire [31:0] store_word;
    wire event_wheel_strobe;
    wire event_wheel_phase_start;
    wire [5:0] event_wheel_events;
    wire [5:0] event_wheel_backward;
    wire [7:0] output_control_pins;
    wire output_control_sets_duty;
    wire [11:0] output_control_duty;
    wire output_control_stray;
    wire pulse_width_pin;
    wire switches_samples;
    wire switches_level;
    wire switches_earlier;
    wire switches_state;
    wire switches_found;
    wire switches_interlock;
    wire [5:0] seek_control_seeking;
    wire [5:0] seek_control_hits;
    wire seek_control_slows;
    wire seek_control_forgives;
    wire seek_control_caught;
    wire seek_control_sweeps;
    wire edge_latch_comes;
    wire edge_latch_latches;
    wire edge_latch_armed;
    wire [3:0] edge_latch_edges;
    wire readout_valid;
    wire [1:0] readout_page;
    wire [2:0] readout_item;
    wire [31:0] readout_state;
    wire readout_refreshed;
    wire readout_meets;
    wire stops_fault;
    wire stops_finds;
    wire stops_frozen;
    wire stops_ramp;
    wire stops_halted;
    wire stops_settles;
    wire stops_clearing;
    wire [3:0] stops_cause;
    wire [5:0] stops_culprits;
    wire resets_ending;
    wire resets_stage_2;
    wire resets_resetting;
    wire resets_completes;
    wire resets_restarts_round;
    wire supervisor_pressed;
    wire supervisor_missed;
    wire supervisor_enabled;
    wire supervisor_warm;
    wire [1:0] supervisor_row;
    wire supervisor_begins_round;
    wire pulser_0_step;
    wire pulser_0_dir;
    wire pulser_0_held_back;
    wire [5:0] pulser_0_counts;
    wire pulser_0_overruns;
    wire pulser_1_step;
    wire pulser_1_dir;
    wire pulser_1_held_back;
    wire [5:0] pulser_1_counts;
    wire pulser_1_overruns;
    wire pulser_2_step;
    wire pulser_2_dir;
    wire pulser_2_held_back;
    wire [5:0] pulser_2_counts;
    wire pulser_2_overruns;
    wire pulser_3_step;
    wire pulser_3_dir;
    wire pulser_3_held_back;
    wire [5:0] pulser_3_counts;
    wire pulser_3_overruns;
    wire pulser_4_step;
    wire pulser_4_dir;
    wire pulser_4_held_back;
    wire [5:0] pulser_4_counts;
    wire pulser_4_overruns;
    wire pulser_5_step;
    wire pulser_5_dir;
    wire pulser_5_held_back;
    wire [5:0] pulser_5_counts;
    wire pulser_5_overruns;

    wire strobe = event_wheel_strobe;
    wire masked = mask[0];
    wire nobody = {1'b0, put_axis} >= AXES;
    wire is_own = time_slot_axis == put_axis;
    wire listens = time_slot_beat[7] & is_own;
    wire names = put_word[3];
    wire take = put_valid & put_ready & !nobody;
    wire may_start = enable & supervisor_warm;
    wire free = !stops_fault & !stops_finds;
    wire decides = strobe & waits & free;
    wire go = decides & !unfed & !held & !drops;
    wire rests = rest_2 & !waits & !pins_busy;
    wire outputs_off = stops_frozen | (stops_fault & (OFF_AT_RAMPS != 1'b0)) | !supervisor_enabled;

    assign put_ready = !stops_fault & (nobody | (listens & !names & !queue_full) | (time_slot_beat[12] & is_own & names & !cut_control_checks));
    assign start_ready = strobe & !waits & !stops_fault & may_start;
    assign cut_busy = cut_control_busy;
    assign cut_refused = cut_control_refused;
    assign state_valid = readout_valid;
    assign state_page = readout_page;
    assign state_axis = time_slot_axis;
    assign state_item = readout_item;
    assign state = readout_state;
    assign refreshed = readout_refreshed;
    assign room = queue_room;
    assign room_valid = listens;
    assign step[0] = pulser_0_step;
    assign step[1] = pulser_1_step;
    assign step[2] = pulser_2_step;
    assign step[3] = pulser_3_step;
    assign step[4] = pulser_4_step;
    assign step[5] = pulser_5_step;
    assign dir[0] = pulser_0_dir;
    assign dir[1] = pulser_1_dir;
    assign dir[2] = pulser_2_dir;
    assign dir[3] = pulser_3_dir;
    assign dir[4] = pulser_4_dir;
    assign dir[5] = pulser_5_dir;
    assign outputs = output_control_pins;
    assign pwm = pulse_width_pin;
    assign enabled = supervisor_enabled;
    assign idle = rests;
    assign fault = stops_fault;
    assign halted = stops_halted;
    assign resetting = resets_resetting;
    assign cause = stops_cause;
    assign culprits = stops_culprits;
    assign armed = waits;
    assign ready = may_start;
    assign seeking = seek_control_seeking;
    assign hits = seek_control_hits;
    assign latch_armed = edge_latch_armed;
    assign latch_edges = edge_latch_edges;
    assign started = go;

    always @(*) begin
        counts = NONE;
        counts = counts | counted_0;
        counts = counts | counted_1;
        counts = counts | counted_2;
        counts = counts | counted_3;
        counts = counts | counted_4;
        counts = counts | counted_5;
    end

    always @(*) begin
        pins_busy = 1'b0;
        pins_busy = pins_busy | pulser_0_held_back | pulser_0_step;
        pins_busy = pins_busy | pulser_1_held_back | pulser_1_step;
        pins_busy = pins_busy | pulser_2_held_back | pulser_2_step;
        pins_busy = pins_busy | pulser_3_held_back | pulser_3_step;
        pins_busy = pins_busy | pulser_4_held_back | pulser_4_step;
        pins_busy = pins_busy | pulser_5_held_back | pulser_5_step;
    end

    always @(*) begin
        late = NO_AXES;
        late = late | late_bit_0;
        late = late | late_bit_1;
        late = late | late_bit_2;
        late = late | late_bit_3;
        late = late | late_bit_4;
        late = late | late_bit_5;
    end

    always @(*) begin
        counted_0 = NONE;
        if (time_slot_axis_one_hot[0]) begin
            counted_0 = pulser_0_counts;
        end
    end

    always @(*) begin
        late_bit_0 = NO_AXES;
        if (pulser_0_overruns) begin
            late_bit_0 = ONE_AXIS_0;
        end
    end

    always @(*) begin
        counted_1 = NONE;
        if (time_slot_axis_one_hot[1]) begin
            counted_1 = pulser_1_counts;
        end
    end

    always @(*) begin
        late_bit_1 = NO_AXES;
        if (pulser_1_overruns) begin
            late_bit_1 = ONE_AXIS_1;
        end
    end

    always @(*) begin
        counted_2 = NONE;
        if (time_slot_axis_one_hot[2]) begin
            counted_2 = pulser_2_counts;
        end
    end

    always @(*) begin
        late_bit_2 = NO_AXES;
        if (pulser_2_overruns) begin
            late_bit_2 = ONE_AXIS_2;
        end
    end

    always @(*) begin
        counted_3 = NONE;
        if (time_slot_axis_one_hot[3]) begin
            counted_3 = pulser_3_counts;
        end
    end

    always @(*) begin
        late_bit_3 = NO_AXES;
        if (pulser_3_overruns) begin
            late_bit_3 = ONE_AXIS_3;
        end
    end

    always @(*) begin
        counted_4 = NONE;
        if (time_slot_axis_one_hot[4]) begin
            counted_4 = pulser_4_counts;
        end
    end

    always @(*) begin
        late_bit_4 = NO_AXES;
        if (pulser_4_overruns) begin
            late_bit_4 = ONE_AXIS_4;
        end
    end

    always @(*) begin
        counted_5 = NONE;
        if (time_slot_axis_one_hot[5]) begin
            counted_5 = pulser_5_counts;
        end
    end

    always @(*) begin
        late_bit_5 = NO_AXES;
        if (pulser_5_overruns) begin
            late_bit_5 = ONE_AXIS_5;
        end
    end

    carrystep_time_slot time_slot (
        .clock(clock),
        .strobe(strobe),
        .beat(time_slot_beat),
        .axis(time_slot_axis),
        .axis_next(time_slot_axis_next),
        .axis_one_hot(time_slot_axis_one_hot),
        .is_last(time_slot_is_last)
    );

    carrystep_adder adder (
        .clock(clock),
        .beat(time_slot_beat),
        .word(store_word),
        .put(put_data),
        .counts(queue_running),
        .lost(step_counts_lost),
        .up(step_counts_up),
        .down(step_counts_down),
        .wipe(stops_clearing),
        .forgets(resets_stage_2),
        .sum(adder_sum),
        .ended(adder_ended),
        .overflow(adder_overflow),
        .turned(adder_turned),
        .crosses(adder_crosses),
        .back(adder_back),
        .still(adder_still),
        .least(adder_least),
        .q(adder_q)
    );

    carrystep_queue #(
        .CUTS(CUTS)
    ) queue (
        .clock(clock),
        .beat(time_slot_beat),
        .axis(time_slot_axis),
        .axis_next(time_slot_axis_next),
        .starts(going & masked),
        .halted(stops_halted),
        .ramp(stops_ramp | seek_control_slows),
        .clear(stops_clearing),
        .empties(seek_control_slows & !queue_goes_on),
        .take(take),
        .put_word(put_word),
        .put_slot(put_data[4:0]),
        .last(put_data[0]),
        .checks(cut_control_checks),
        .cuts(cut_control_cuts),
        .closes(cut_control_closes),
        .ended(adder_ended),
        .overflow(adder_overflow),
        .least(adder_least),
        .turned(adder_turned),
        .back(adder_back),
        .meets(readout_meets),
        .next_counts(step_counts_next_counts),
        .live(queue_live),
        .fresh(queue_fresh),
        .misplaced(queue_misplaced),
        .full(queue_full),
        .room(queue_room),
        .empty(queue_empty),
        .running(queue_running),
        .sound(queue_sound),
        .slows(queue_slows),
        .upward(queue_upward),
        .steady(queue_steady),
        .moves(queue_moves),
        .goes_on(queue_goes_on),
        .advances(queue_advances),
        .too_fast(queue_too_fast),
        .dry(queue_dry),
        .misses(queue_misses),
        .met(queue_met),
        .counts(queue_counts)
    );

    carrystep_step_counts step_counts (
        .clock(clock),
        .beat(time_slot_beat),
        .running(queue_running),
        .moves(queue_moves),
        .crosses(adder_crosses),
        .back(adder_back),
        .clear(stops_clearing),
        .pulses(counts[2:0]),
        .losses(counts[5:3]),
        .word(store_word[2:0]),
        .counts(queue_counts),
        .next_counts(step_counts_next_counts),
        .up(step_counts_up),
        .down(step_counts_down),
        .lost(step_counts_lost),
        .on_way(step_counts_on_way)
    );

    carrystep_cut_control #(
        .CUTS(CUTS)
    ) cut_control (
        .clock(clock),
        .strobe(strobe),
        .beat(time_slot_beat),
        .request(cut),
        .misses(queue_misses),
        .resetting(resets_resetting),
        .checks(cut_control_checks),
        .cuts(cut_control_cuts),
        .closes(cut_control_closes),
        .busy(cut_control_busy),
        .refused(cut_control_refused)
    );

    carrystep_store #(
        .START_HALF(START_HALF),
        .STOP_ACCEL_0(STOP_ACCEL_0),
        .STOP_ACCEL_1(STOP_ACCEL_1),
        .STOP_ACCEL_2(STOP_ACCEL_2),
        .STOP_ACCEL_3(STOP_ACCEL_3),
        .STOP_ACCEL_4(STOP_ACCEL_4),
        .STOP_ACCEL_5(STOP_ACCEL_5)
    ) store (
        .clock(clock),
        .beat(time_slot_beat),
        .axis(time_slot_axis),
        .live(queue_live),
        .fresh(queue_fresh),
        .running(queue_running),
        .sound(queue_sound),
        .moves(queue_moves),
        .slows(queue_slows),
        .upward(queue_upward),
        .steady(queue_steady),
        .wipe(stops_clearing),
        .put(taken),
        .put_word(taken_word),
        .sum(adder_sum),
        .word(store_word)
    );

    carrystep_event_wheel #(
        .CLOCKS_PER_TICK(CLOCKS_PER_TICK),
        .EVENT_MEMORY(EVENT_MEMORY)
    ) event_wheel (
        .clock(clock),
        .time_slot_ends(time_slot_beat[12]),
        .axis_one_hot(time_slot_axis_one_hot),
        .crosses(queue_moves & adder_crosses),
        .has_sign(queue_moves & !adder_still),
        .back(adder_back),
        .phase_known(time_slot_beat[16]),
        .q(adder_q),
        .strobe(event_wheel_strobe),
        .phase_start(event_wheel_phase_start),
        .events(event_wheel_events),
        .backward(event_wheel_backward)
    );

    carrystep_output_control #(
        .OUTPUTS(OUTPUTS),
        .PWM_DIVIDER(PWM_DIVIDER)
    ) output_control (
        .clock(clock),
        .beat(time_slot_beat),
        .first(time_slot_axis_one_hot[0]),
        .take(take),
        .put_word(put_word),
        .put_data(put_data),
        .fresh(queue_fresh),
        .live(queue_live),
        .starts(going & masked),
        .follows(queue_advances),
        .off(outputs_off),
        .pins(output_control_pins),
        .sets_duty(output_control_sets_duty),
        .duty(output_control_duty),
        .stray(output_control_stray)
    );

    carrystep_pulse_width #(
        .PWM_DIVIDER(PWM_DIVIDER)
    ) pulse_width (
        .clock(clock),
        .set(output_control_sets_duty & strobe),
        .duty(output_control_duty),
        .off(outputs_off),
        .pin(pulse_width_pin)
    );

    carrystep_switches #(
        .ROUND_TICKS(ROUND_TICKS),
        .DEBOUNCE_SAMPLES(DEBOUNCE_SAMPLES),
        .LIMITS(LIMITS),
        .LIMITS_LOW(LIMITS_LOW),
        .INPUTS_0(INPUTS_0),
        .INPUTS_0_LOW(INPUTS_0_LOW),
        .INPUTS_1(INPUTS_1),
        .INPUTS_1_LOW(INPUTS_1_LOW)
    ) switches (
        .clock(clock),
        .time_slot_ends(time_slot_beat[12]),
        .axis(time_slot_axis),
        .axis_next(time_slot_axis_next),
        .axis_one_hot(time_slot_axis_one_hot),
        .row(supervisor_row),
        .begins_round(supervisor_begins_round),
        .limit_min(limit_min),
        .limit_max(limit_max),
        .inputs_0(inputs_0),
        .inputs_1(inputs_1),
        .goes(queue_moves & !adder_still),
        .back(adder_back),
        .resetting(resets_resetting),
        .samples(switches_samples),
        .level(switches_level),
        .earlier(switches_earlier),
        .state(switches_state),
        .found(switches_found),
        .interlock(switches_interlock)
    );

    carrystep_seek_control seek_control (
        .clock(clock),
        .strobe(strobe),
        .set_source(seek_source_valid),
        .source(seek_source),
        .set(seek_valid),
        .mask(seek_mask),
        .time_slot_ends(time_slot_beat[12]),
        .axis(time_slot_axis),
        .axis_one_hot(time_slot_axis_one_hot),
        .row(supervisor_row),
        .samples(switches_samples),
        .state(switches_state),
        .goes_on(queue_goes_on),
        .resetting(resets_resetting),
        .seeking(seek_control_seeking),
        .hits(seek_control_hits),
        .slows(seek_control_slows),
        .forgives(seek_control_forgives),
        .caught(seek_control_caught),
        .sweeps(seek_control_sweeps)
    );

    carrystep_edge_latch #(
        .LATCH_LOOKS(LATCH_LOOKS),
        .LATCH_LOW(LATCH_LOW)
    ) edge_latch (
        .clock(clock),
        .strobe(strobe),
        .pin(latch),
        .arm(latch_arm),
        .resetting(resets_resetting),
        .comes(edge_latch_comes),
        .latches(edge_latch_latches),
        .armed(edge_latch_armed),
        .edges(edge_latch_edges)
    );

    carrystep_readout readout (
        .clock(clock),
        .strobe(strobe),
        .beat(time_slot_beat),
        .is_last(time_slot_is_last),
        .snapshot(snapshot),
        .caught(seek_control_caught),
        .met(queue_met),
        .sweeps(seek_control_sweeps),
        .comes(edge_latch_comes),
        .latches(edge_latch_latches),
        .samples(switches_samples),
        .row(supervisor_row),
        .earlier(switches_earlier),
        .level(switches_level),
        .resetting(resets_resetting),
        .word(store_word),
        .live(queue_live),
        .running(queue_running),
        .room(queue_room),
        .on_way(step_counts_on_way),
        .valid(readout_valid),
        .page(readout_page),
        .item(readout_item),
        .state(readout_state),
        .refreshed(readout_refreshed),
        .meets(readout_meets)
    );

    carrystep_stops #(
        .LIMIT_FREEZES(LIMIT_FREEZES)
    ) stops (
        .clock(clock),
        .strobe(strobe),
        .time_slot_ends(time_slot_beat[12]),
        .axis_one_hot(time_slot_axis_one_hot),
        .runs(queue_running),
        .too_fast(queue_too_fast),
        .limit(switches_found & !seek_control_forgives),
        .dry(queue_dry),
        .late(late),
        .pressed(supervisor_pressed),
        .breaks((((put_valid & nobody) | broken | queue_misplaced | output_control_stray) & !stops_fault) | (decides & unfed & !drops)),
        .missed(supervisor_missed & !rest_2),
        .interlock(switches_interlock),
        .asked(stop),
        .clear(clear),
        .pins_busy(pins_busy),
        .ending(resets_ending),
        .stage_2(resets_stage_2),
        .completes(resets_completes),
        .fault(stops_fault),
        .finds(stops_finds),
        .frozen(stops_frozen),
        .ramp(stops_ramp),
        .halted(stops_halted),
        .settles(stops_settles),
        .clearing(stops_clearing),
        .cause(stops_cause),
        .culprits(stops_culprits)
    );

    carrystep_resets resets (
        .clock(clock),
        .strobe(strobe),
        .reset(reset),
        .settled(stops_settles),
        .pins_busy(pins_busy),
        .ending(resets_ending),
        .stage_1(),
        .stage_2(resets_stage_2),
        .resetting(resets_resetting),
        .completes(resets_completes),
        .restarts_round(resets_restarts_round)
    );

    carrystep_supervisor #(
        .ROUND_TICKS(ROUND_TICKS),
        .WATCHDOG_ROUNDS(WATCHDOG_ROUNDS),
        .ENABLE_ROUNDS(ENABLE_ROUNDS),
        .ESTOP_LOW(ESTOP_LOW)
    ) supervisor (
        .clock(clock),
        .strobe(strobe),
        .estop(estop),
        .kick(kick),
        .enable(enable),
        .idle(rests),
        .ending(resets_ending),
        .resetting(resets_resetting),
        .restarts_round(resets_restarts_round),
        .pressed(supervisor_pressed),
        .missed(supervisor_missed),
        .enabled(supervisor_enabled),
        .warm(supervisor_warm),
        .row(supervisor_row),
        .begins_round(supervisor_begins_round)
    );

    carrystep_pulser #(
        .STEP_HIGH(STEP_HIGH_0),
        .STEP_LOW(STEP_LOW_0),
        .DIR_SETUP(DIR_SETUP_0),
        .DIR_HOLD(DIR_HOLD_0)
    ) pulser_0 (
        .clock(clock),
        .frozen(stops_frozen),
        .request(event_wheel_events[0] & event_wheel_phase_start),
        .request_back(event_wheel_backward[0]),
        .has_sign(event_wheel_events[0] & strobe),
        .sign_back(event_wheel_backward[0]),
        .step(pulser_0_step),
        .dir(pulser_0_dir),
        .held_back(pulser_0_held_back),
        .counts(pulser_0_counts),
        .overruns(pulser_0_overruns)
    );

    carrystep_pulser #(
        .STEP_HIGH(STEP_HIGH_1),
        .STEP_LOW(STEP_LOW_1),
        .DIR_SETUP(DIR_SETUP_1),
        .DIR_HOLD(DIR_HOLD_1)
    ) pulser_1 (
        .clock(clock),
        .frozen(stops_frozen),
        .request(event_wheel_events[1] & event_wheel_phase_start),
        .request_back(event_wheel_backward[1]),
        .has_sign(event_wheel_events[1] & strobe),
        .sign_back(event_wheel_backward[1]),
        .step(pulser_1_step),
        .dir(pulser_1_dir),
        .held_back(pulser_1_held_back),
        .counts(pulser_1_counts),
        .overruns(pulser_1_overruns)
    );

    carrystep_pulser #(
        .STEP_HIGH(STEP_HIGH_2),
        .STEP_LOW(STEP_LOW_2),
        .DIR_SETUP(DIR_SETUP_2),
        .DIR_HOLD(DIR_HOLD_2)
    ) pulser_2 (
        .clock(clock),
        .frozen(stops_frozen),
        .request(event_wheel_events[2] & event_wheel_phase_start),
        .request_back(event_wheel_backward[2]),
        .has_sign(event_wheel_events[2] & strobe),
        .sign_back(event_wheel_backward[2]),
        .step(pulser_2_step),
        .dir(pulser_2_dir),
        .held_back(pulser_2_held_back),
        .counts(pulser_2_counts),
        .overruns(pulser_2_overruns)
    );

    carrystep_pulser #(
        .STEP_HIGH(STEP_HIGH_3),
        .STEP_LOW(STEP_LOW_3),
        .DIR_SETUP(DIR_SETUP_3),
        .DIR_HOLD(DIR_HOLD_3)
    ) pulser_3 (
        .clock(clock),
        .frozen(stops_frozen),
        .request(event_wheel_events[3] & event_wheel_phase_start),
        .request_back(event_wheel_backward[3]),
        .has_sign(event_wheel_events[3] & strobe),
        .sign_back(event_wheel_backward[3]),
        .step(pulser_3_step),
        .dir(pulser_3_dir),
        .held_back(pulser_3_held_back),
        .counts(pulser_3_counts),
        .overruns(pulser_3_overruns)
    );

    carrystep_pulser #(
        .STEP_HIGH(STEP_HIGH_4),
        .STEP_LOW(STEP_LOW_4),
        .DIR_SETUP(DIR_SETUP_4),
        .DIR_HOLD(DIR_HOLD_4)
    ) pulser_4 (
        .clock(clock),
        .frozen(stops_frozen),
        .request(event_wheel_events[4] & event_wheel_phase_start),
        .request_back(event_wheel_backward[4]),
        .has_sign(event_wheel_events[4] & strobe),
        .sign_back(event_wheel_backward[4]),
        .step(pulser_4_step),
        .dir(pulser_4_dir),
        .held_back(pulser_4_held_back),
        .counts(pulser_4_counts),
        .overruns(pulser_4_overruns)
    );

    carrystep_pulser #(
        .STEP_HIGH(STEP_HIGH_5),
        .STEP_LOW(STEP_LOW_5),
        .DIR_SETUP(DIR_SETUP_5),
        .DIR_HOLD(DIR_HOLD_5)
    ) pulser_5 (
        .clock(clock),
        .frozen(stops_frozen),
        .request(event_wheel_events[5] & event_wheel_phase_start),
        .request_back(event_wheel_backward[5]),
        .has_sign(event_wheel_events[5] & strobe),
        .sign_back(event_wheel_backward[5]),
        .step(pulser_5_step),
        .dir(pulser_5_dir),
        .held_back(pulser_5_held_back),
        .counts(pulser_5_counts),
        .overruns(pulser_5_overruns)
    );

    always @(posedge clock) begin
        taken <= taken & !time_slot_beat[9];
        if (take) begin
            taken <= (put_word != COMMIT) & !names;
        end
        if (time_slot_beat[7]) begin
            taken_word <= put_word[2:0];
        end
        if (strobe) begin
            going <= go;
        end
        if (time_slot_beat[12]) begin
            mask <= (mask >> BY_ONE) | (mask << TO_TOP);
        end
        if (start_ready & start_valid) begin
            waits <= 1'b1;
            mask <= start_mask;
        end
        if (go | (decides & drops) | stops_fault) begin
            waits <= 1'b0;
        end
        if (time_slot_beat[12]) begin
            unfed <= unfed | (masked & queue_empty);
            held <= held | (masked & queue_goes_on);
            drops <= drops | (masked & seek_control_slows);
            active <= active | queue_running | !queue_empty;
        end
        if (strobe) begin
            unfed <= 1'b0;
            held <= 1'b0;
            drops <= 1'b0;
            active <= 1'b0;
            rest_1 <= !active;
            rest_2 <= !active & rest_1;
        end
        if (take & !names) begin
            rest_1 <= 1'b0;
            rest_2 <= 1'b0;
        end
        if (resets_completes) begin
            rest_1 <= 1'b1;
            rest_2 <= 1'b1;
        end
    end
endmodule

`default_nettype wire

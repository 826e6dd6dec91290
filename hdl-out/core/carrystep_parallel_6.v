// SPDX-License-Identifier: MIT OR Apache-2.0
//
// carrystep_parallel_6: step and direction for six axes.
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

`default_nettype none

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

    reg [15:0] sub = 16'd0;
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

// Holds the running segment of an axis and one waiting segment.
module carrystep_sequencer (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of a tick, unless the core is frozen.
    input  wire         strobe,
    // Asserted while a fault is latched. The axis stops running.
    input  wire         frozen,
    // The next V is out of range. The axis stops running.
    input  wire         stop,
    // Clears the waiting segment and the fault.
    input  wire         clear,
    // The waiting segment may start an axis at rest in this clock.
    input  wire         go,
    // The sequencer stores the offered segment in this clock.
    input  wire         push,
    // Offered segment: its duration in ticks.
    input  wire  [31:0] seg_ticks,
    // Offered segment: the initial speed V, in 2^-64 step per tick, two's complement.
    input  wire  [63:0] seg_v,
    // Offered segment: the initial acceleration A, in 2^-64 step per tick^2, two's complement.
    input  wire  [63:0] seg_a,
    // Offered segment: the jerk J, in 2^-64 step per tick^3, two's complement.
    input  wire  [63:0] seg_j,
    // Offered segment: it is the last of its move, and the axis rests after it.
    input  wire         seg_last,
    // A segment is stored and not yet loaded.
    output wire         waiting,
    // The waiting segment could start at a strobe in this clock.
    output wire         startable,
    // A segment runs.
    output wire         running,
    // The axis loads V, A and J from the waiting segment.
    output wire         load,
    // The running segment continues: the axis advances V and A.
    output wire         advance,
    // The V of the waiting segment.
    output wire  [63:0] v,
    // The A of the waiting segment.
    output wire  [63:0] a,
    // The J of the waiting segment.
    output wire  [63:0] j,
    // Latched fault: a segment that was not the last of its move ended, and no segment was waiting.
    output wire         underrun
);
    localparam [31:0] ONE = 32'd1;

    reg wait_full = 1'b0;
    reg [31:0] wait_ticks = 32'd0;
    reg [63:0] wait_v = 64'h0;
    reg [63:0] wait_a = 64'h0;
    reg [63:0] wait_j = 64'h0;
    reg wait_last = 1'b0;
    reg active = 1'b0;
    reg [31:0] left = 32'd0;
    reg last = 1'b0;
    reg dry = 1'b0;

    wire ending = active & (left == ONE);

    assign waiting = wait_full;
    assign startable = wait_full & (!active | (ending & last));
    assign running = active;
    assign load = strobe & wait_full & ((ending & !last) | (startable & go));
    assign advance = strobe & active & !ending;
    assign v = wait_v;
    assign a = wait_a;
    assign j = wait_j;
    assign underrun = dry;

    always @(posedge clock) begin
        if (push) begin
            wait_full <= 1'b1;
            wait_ticks <= seg_ticks;
            wait_v <= seg_v;
            wait_a <= seg_a;
            wait_j <= seg_j;
            wait_last <= seg_last;
        end
        if (load) begin
            wait_full <= 1'b0;
            active <= 1'b1;
            left <= wait_ticks;
            last <= wait_last;
        end else if (advance) begin
            left <= left - ONE;
        end else if (strobe) begin
            active <= 1'b0;
            dry <= dry | (ending & !last);
        end
        if (frozen | stop) begin
            active <= 1'b0;
        end
        if (clear) begin
            wait_full <= 1'b0;
            dry <= 1'b0;
        end
    end
endmodule

// Finds the phase of a step in its tick by bisection; requests the step in that phase.
module carrystep_step_edge (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of a tick, even while the core is frozen.
    input  wire         strobe,
    // Asserted in the first clock of a phase.
    input  wire         phase_start,
    // The number of the present phase, 0 to Q - 1.
    input  wire   [3:0] phase,
    // Asserted while a fault is latched. No new tick enters; steps that have already been found
    // continue.
    input  wire         frozen,
    // Clears the stored signs of V.
    input  wire         clear,
    // The tick that ends at this strobe contains a step.
    input  wire         crosses,
    // V > 0 in the tick that ends at this strobe.
    input  wire         forward,
    // V < 0 in the tick that ends at this strobe.
    input  wire         backward,
    // The upper 32 bits of P before the addition.
    input  wire  [31:0] p,
    // The upper 32 bits of V before the addition.
    input  wire  [31:0] v,
    // Asserted for one clock when a step is due.
    output wire         request,
    // The requested step is backward.
    output wire         request_back,
    // V > 0 in the tick that is being emitted.
    output wire         want_fwd,
    // V < 0 in the tick that is being emitted.
    output wire         want_back,
    // A step has been found and may not have been requested yet.
    output wire         in_flight,
    // The tick accumulated last contained a step.
    output wire         crossed,
    // V < 0 in the tick accumulated last.
    output wire         back,
    // The phase of that step, valid when the bisection has finished.
    output wire   [3:0] q
);
    localparam [31:0] SIGN = 32'h80000000;
    localparam [31:0] BY_ONE = 32'd1;
    localparam [3:0] WEIGHT_BY_ONE = 4'd1;
    localparam [3:0] FIRST_WEIGHT = 4'd8;
    localparam [3:0] PHASE_ZERO = 4'd0;

    reg tick_crossed = 1'b0;
    reg tick_back = 1'b0;
    reg sign_fwd = 1'b0;
    reg sign_back = 1'b0;
    reg [31:0] bisect_p = 32'd0;
    reg [31:0] bisect_v = 32'd0;
    reg [3:0] bisect_q = 4'd0;
    reg [3:0] weight = 4'd0;
    reg emit = 1'b0;
    reg emit_back = 1'b0;
    reg [3:0] emit_q = 4'd0;
    reg dir_fwd = 1'b0;
    reg dir_back = 1'b0;

    wire [31:0] half = (bisect_v >> BY_ONE) | (bisect_v & SIGN);
    wire [32:0] trial = {1'b0, bisect_p} + {1'b0, half};
    wire trial_crosses = trial[32] ^ bisect_v[31];

    assign request = emit & phase_start & (phase == emit_q);
    assign request_back = emit_back;
    assign want_fwd = dir_fwd;
    assign want_back = dir_back;
    assign in_flight = tick_crossed | emit;
    assign crossed = tick_crossed;
    assign back = tick_back;
    assign q = bisect_q;

    always @(posedge clock) begin
        if (weight != 4'd0) begin
            weight <= weight >> WEIGHT_BY_ONE;
            bisect_v <= half;
            if (!trial_crosses) begin
                bisect_p <= trial[31:0];
                bisect_q <= bisect_q | weight;
            end
        end
        if (strobe) begin
            emit <= tick_crossed;
            emit_back <= tick_back;
            emit_q <= bisect_q;
            dir_fwd <= sign_fwd;
            dir_back <= sign_back;
            tick_crossed <= crosses & !frozen;
            sign_fwd <= forward & !frozen;
            sign_back <= backward & !frozen;
            if (!frozen) begin
                tick_back <= backward;
                bisect_p <= p;
                bisect_v <= v;
                bisect_q <= PHASE_ZERO;
                weight <= FIRST_WEIGHT;
            end
        end
        if (clear) begin
            sign_fwd <= 1'b0;
            sign_back <= 1'b0;
            dir_fwd <= 1'b0;
            dir_back <= 1'b0;
        end
    end
endmodule

// One axis: P, V, A, J. Each carry of P is a step. The last five ports are for observation.
module carrystep_axis #(
    // Start value of P: 1 half a step, 0 zero; 0 or 1
    parameter [31:0] START_HALF = 32'd1
) (
    // The clock.
    input  wire         clock,
    // Asserted in the last clock of a tick.
    input  wire         strobe,
    // Asserted in the first clock of a phase.
    input  wire         phase_start,
    // The number of the present phase, 0 to Q - 1.
    input  wire   [3:0] phase,
    // Asserted while a fault of any axis is latched. The axis does not move.
    input  wire         frozen,
    // Sets P to its start value and clears the segments and the faults.
    input  wire         clear,
    // The waiting segment may start this axis at the strobe in this clock.
    input  wire         go,
    // The axis stores the offered segment in this clock.
    input  wire         push,
    // Offered segment: its duration in ticks.
    input  wire  [31:0] seg_ticks,
    // Offered segment: the initial speed V, in 2^-64 step per tick, two's complement.
    input  wire  [63:0] seg_v,
    // Offered segment: the initial acceleration A, in 2^-64 step per tick^2, two's complement.
    input  wire  [63:0] seg_a,
    // Offered segment: the jerk J, in 2^-64 step per tick^3, two's complement.
    input  wire  [63:0] seg_j,
    // Offered segment: it is the last of its move, and the axis rests after it.
    input  wire         seg_last,
    // A segment is stored and not yet loaded.
    output wire         waiting,
    // The waiting segment could start at a strobe in this clock.
    output wire         startable,
    // Asserted for one clock when a step is due.
    output wire         request,
    // The requested step is backward.
    output wire         request_back,
    // V > 0 in the tick that is being emitted.
    output wire         want_fwd,
    // V < 0 in the tick that is being emitted.
    output wire         want_back,
    // A step has been found and may not have reached the shaper.
    output wire         in_flight,
    // The axis is at rest, no segment waits, and every step has reached the shaper.
    output wire         drained,
    // Latched fault: the next V would have been outside -2^63 < V < 2^63.
    output wire         overspeed,
    // Latched fault: a segment that was not the last of its move ended, and no segment was waiting.
    output wire         underrun,
    // For observation: the last tick contained a step.
    output wire         crossed,
    // For observation: V < 0 in the last tick.
    output wire         back,
    // For observation: the phase of that step, valid when the bisection has finished.
    output wire   [3:0] q,
    // For observation: P.
    output wire  [63:0] p,
    // For observation: V.
    output wire  [63:0] v
);
    localparam [63:0] START_VALUE = START_HALF[0] ? 64'h8000000000000000 : 64'h0;
    localparam [63:0] ZERO = 64'h0;
    localparam [63:0] LEAST = 64'h8000000000000000;

    generate
        if (START_HALF > 32'd1) begin : start_half_out_of_range
            carrystep_error_start_half_out_of_range error ();
        end
    endgenerate

    reg [63:0] position = START_HALF[0] ? 64'h8000000000000000 : 64'h0;
    reg [63:0] speed = 64'h0;
    reg [63:0] accel = 64'h0;
    reg [63:0] jerk = 64'h0;
    reg too_fast = 1'b0;
    reg [63:0] next_speed;

    wire sequencer_waiting;
    wire sequencer_startable;
    wire sequencer_running;
    wire sequencer_load;
    wire sequencer_advance;
    wire [63:0] sequencer_v;
    wire [63:0] sequencer_a;
    wire [63:0] sequencer_j;
    wire sequencer_underrun;
    wire step_edge_request;
    wire step_edge_request_back;
    wire step_edge_want_fwd;
    wire step_edge_want_back;
    wire step_edge_in_flight;
    wire step_edge_crossed;
    wire step_edge_back;
    wire [3:0] step_edge_q;

    wire tick = strobe & !frozen;
    wire [64:0] sum = {1'b0, position} + {1'b0, speed};
    wire backward = speed[63];
    wire [63:0] faster = speed + accel;
    wire overflow = (backward == accel[63]) & (backward != faster[63]);
    wire off_limits = tick & ((next_speed == LEAST) | (sequencer_advance & overflow));

    assign waiting = sequencer_waiting;
    assign startable = sequencer_startable;
    assign request = step_edge_request;
    assign request_back = step_edge_request_back;
    assign want_fwd = step_edge_want_fwd;
    assign want_back = step_edge_want_back;
    assign in_flight = step_edge_in_flight;
    assign drained = !(sequencer_running | sequencer_waiting | step_edge_in_flight);
    assign overspeed = too_fast;
    assign underrun = sequencer_underrun;
    assign crossed = step_edge_crossed;
    assign back = step_edge_back;
    assign q = step_edge_q;
    assign p = position;
    assign v = speed;

    always @(*) begin
        next_speed = ZERO;
        if (sequencer_load) begin
            next_speed = sequencer_v;
        end else if (sequencer_advance) begin
            next_speed = faster;
        end
    end

    carrystep_sequencer sequencer (
        .clock(clock),
        .strobe(tick),
        .frozen(frozen),
        .stop(off_limits),
        .clear(clear),
        .go(go),
        .push(push),
        .seg_ticks(seg_ticks),
        .seg_v(seg_v),
        .seg_a(seg_a),
        .seg_j(seg_j),
        .seg_last(seg_last),
        .waiting(sequencer_waiting),
        .startable(sequencer_startable),
        .running(sequencer_running),
        .load(sequencer_load),
        .advance(sequencer_advance),
        .v(sequencer_v),
        .a(sequencer_a),
        .j(sequencer_j),
        .underrun(sequencer_underrun)
    );

    carrystep_step_edge step_edge (
        .clock(clock),
        .strobe(strobe),
        .phase_start(phase_start),
        .phase(phase),
        .frozen(frozen),
        .clear(clear),
        .crosses(sum[64] ^ backward),
        .forward((speed != 64'h0) & !backward),
        .backward(backward),
        .p(position[63:32]),
        .v(speed[63:32]),
        .request(step_edge_request),
        .request_back(step_edge_request_back),
        .want_fwd(step_edge_want_fwd),
        .want_back(step_edge_want_back),
        .in_flight(step_edge_in_flight),
        .crossed(step_edge_crossed),
        .back(step_edge_back),
        .q(step_edge_q)
    );

    always @(posedge clock) begin
        if (tick) begin
            position <= sum[63:0];
        end
        if (tick) begin
            speed <= next_speed;
        end
        if (sequencer_load) begin
            accel <= sequencer_a;
            jerk <= sequencer_j;
        end else if (sequencer_advance) begin
            accel <= accel + jerk;
        end else if (tick) begin
            accel <= ZERO;
            jerk <= ZERO;
        end
        if (off_limits | frozen) begin
            speed <= ZERO;
            accel <= ZERO;
            jerk <= ZERO;
        end
        too_fast <= too_fast | off_limits;
        if (clear) begin
            position <= START_VALUE;
            too_fast <= 1'b0;
        end
    end
endmodule

// Drives STEP and DIR of one axis with the pulse width, gap, set-up and hold of its driver.
module carrystep_shaper #(
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
    // Asserted while a fault is latched. No new pulse starts and DIR does not change.
    input  wire         frozen,
    // Clears the fault.
    input  wire         clear,
    // A step is due in this clock.
    input  wire         request,
    // The requested step is backward.
    input  wire         request_back,
    // V > 0: DIR should be forward.
    input  wire         want_fwd,
    // V < 0: DIR should be backward.
    input  wire         want_back,
    // The STEP pin.
    output wire         step,
    // The DIR pin; 1 is backward.
    output wire         dir,
    // A step is held back.
    output wire         held_back,
    // The steps forward less the steps backward, 32 bits two's complement.
    output wire  [31:0] position,
    // The number of steps that were requested but not made, modulo 2^32: the step of an overrun and
    // those discarded while frozen.
    output wire  [31:0] discarded,
    // Latched fault: a second step arrived while one was held back.
    output wire         overrun
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
    localparam [16:0] STEP_FALLS_AT = STEP_LOW[16:0];
    localparam [16:0] BUSY_LOAD = (STEP_HIGH[16:0] + STEP_LOW[16:0]) - 17'd1;
    localparam [16:0] BUSY_BITS = used_bits_17((STEP_HIGH[16:0] + STEP_LOW[16:0]) - 17'd1);
    localparam [15:0] HOLD_LOAD = DIR_HOLD[15:0] - 16'd1;
    localparam [15:0] HOLD_BITS = used_bits_16(DIR_HOLD[15:0] - 16'd1);
    localparam [15:0] SETUP_LOAD = DIR_SETUP[15:0] - 16'd1;
    localparam [15:0] SETUP_BITS = used_bits_16(DIR_SETUP[15:0] - 16'd1);
    localparam [16:0] BUSY_ONE = 17'd1;
    localparam [15:0] TIMER_ONE = 16'd1;
    localparam [31:0] ONE = 32'd1;
    localparam [31:0] TWO = 32'd2;

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
    reg [16:0] busy = 17'd0;
    reg [15:0] hold = 16'd0;
    reg [15:0] setup = DIR_SETUP[15:0] - 16'd1;
    reg [31:0] steps = 32'd0;
    reg [31:0] lost = 32'd0;
    reg late = 1'b0;
    reg first_back;
    reg aim;

    wire want_now = want_back | (want & !want_fwd);
    wire pending = due | request;
    wire rise = pending & !frozen & (busy == 17'd0) & (setup == 16'd0) & (dir_pin == first_back);
    wire dir_changes = !frozen & (hold == 16'd0) & (dir_pin != aim);
    wire second = due & request;

    assign step = step_pin;
    assign dir = dir_pin;
    assign held_back = due;
    assign position = steps;
    assign discarded = lost;
    assign overrun = late;

    always @(*) begin
        first_back = request_back;
        if (due) begin
            first_back = due_back;
        end
    end

    always @(*) begin
        aim = want_now;
        if (pending) begin
            aim = first_back;
        end
    end

    always @(posedge clock) begin
        want <= want_now;
        step_pin <= rise | (step_pin & (busy != STEP_FALLS_AT));
        dir_pin <= dir_pin ^ dir_changes;
        if (rise) begin
            busy <= BUSY_LOAD;
        end else if (busy != 17'd0) begin
            busy <= (busy - BUSY_ONE) & BUSY_BITS;
        end
        if (rise) begin
            hold <= HOLD_LOAD;
        end else if (hold != 16'd0) begin
            hold <= (hold - TIMER_ONE) & HOLD_BITS;
        end
        if (dir_changes) begin
            setup <= SETUP_LOAD;
        end else if (setup != 16'd0) begin
            setup <= (setup - TIMER_ONE) & SETUP_BITS;
        end
        if (rise) begin
            if (dir_pin) begin
                steps <= steps - ONE;
            end else begin
                steps <= steps + ONE;
            end
        end
        due <= pending & !rise;
        if (rise) begin
            due <= second;
        end
        if (!due | rise) begin
            due_back <= request_back;
        end
        if (frozen) begin
            due <= 1'b0;
            due_back <= due_back;
            if (second) begin
                lost <= lost + TWO;
            end else if (pending) begin
                lost <= lost + ONE;
            end
        end else if (second & !rise) begin
            late <= 1'b1;
            lost <= lost + ONE;
        end
        if (clear) begin
            late <= 1'b0;
        end
    end
endmodule

// Parallel axes on one tick counter: accepts segments and starts, freezes at a fault.
module carrystep_parallel_6 #(
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
    parameter [31:0] DIR_HOLD_5 = 32'd120
) (
    // The clock.
    input  wire         clock,
    // The host offers a segment and holds it until the core accepts it.
    input  wire         seg_valid,
    // The number of the axis that the segment is for. A segment for an axis that the core does not
    // have is a breach of the segment protocol.
    input  wire   [2:0] seg_axis,
    // Offered segment: its duration in ticks.
    input  wire  [31:0] seg_ticks,
    // Offered segment: the initial speed V, in 2^-64 step per tick, two's complement.
    input  wire  [63:0] seg_v,
    // Offered segment: the initial acceleration A, in 2^-64 step per tick^2, two's complement.
    input  wire  [63:0] seg_a,
    // Offered segment: the jerk J, in 2^-64 step per tick^3, two's complement.
    input  wire  [63:0] seg_j,
    // Offered segment: it is the last of its move, and the axis rests after it.
    input  wire         seg_last,
    // The core accepts an offered segment in this clock.
    output wire         seg_ready,
    // The host offers a start and holds it until the core accepts it.
    input  wire         start_valid,
    // The axes to start; bit i is axis i.
    input  wire   [5:0] start_mask,
    // The core accepts an offered start in this clock.
    output wire         start_ready,
    // Clears a fault. The host holds it until `fault` falls.
    input  wire         clear,
    // The STEP pins; bit i is axis i. A rising edge is a step.
    output wire   [5:0] step,
    // The DIR pins; bit i is axis i; 1 is backward.
    output wire   [5:0] dir,
    // The steps forward less the steps backward of each axis, 32 bits two's complement; axis 0 is
    // in the lowest bits.
    output wire [191:0] position,
    // The number of steps of each axis that were requested but not made, modulo 2^32; axis 0 is in
    // the lowest bits.
    output wire [191:0] discarded,
    // All axes are at rest, no segment waits and no start is armed.
    output wire         idle,
    // A fault is latched, and all axes are frozen.
    output wire         fault,
    // Latched fault of an axis: a second step arrived while one was held back.
    output wire   [5:0] overrun,
    // Latched fault of an axis: the next V would have been outside -2^63 < V < 2^63.
    output wire   [5:0] overspeed,
    // Latched fault of an axis: a segment that was not the last of its move ended, and no segment
    // was waiting.
    output wire   [5:0] underrun,
    // Latched fault: the host broke the segment protocol.
    output wire         protocol,
    // Axes start at the end of this clock; asserted for one clock per start.
    output wire         started
);
    localparam [5:0] FIRST = 6'd1;
    localparam [2:0] AXES = 3'd6;
    localparam [31:0] NO_TICKS = 32'd0;

    reg armed = 1'b0;
    reg [5:0] mask = 6'd0;
    reg broken = 1'b0;
    reg frozen;
    reg in_flight;
    reg at_rest;
    reg waiting;
    reg unfed;
    reg all_startable;

    wire tick_strobe;
    wire tick_phase_start;
    wire [3:0] tick_phase;
    wire axis_0_waiting;
    wire axis_0_startable;
    wire axis_0_request;
    wire axis_0_request_back;
    wire axis_0_want_fwd;
    wire axis_0_want_back;
    wire axis_0_in_flight;
    wire axis_0_drained;
    wire axis_0_overspeed;
    wire axis_0_underrun;
    wire axis_1_waiting;
    wire axis_1_startable;
    wire axis_1_request;
    wire axis_1_request_back;
    wire axis_1_want_fwd;
    wire axis_1_want_back;
    wire axis_1_in_flight;
    wire axis_1_drained;
    wire axis_1_overspeed;
    wire axis_1_underrun;
    wire axis_2_waiting;
    wire axis_2_startable;
    wire axis_2_request;
    wire axis_2_request_back;
    wire axis_2_want_fwd;
    wire axis_2_want_back;
    wire axis_2_in_flight;
    wire axis_2_drained;
    wire axis_2_overspeed;
    wire axis_2_underrun;
    wire axis_3_waiting;
    wire axis_3_startable;
    wire axis_3_request;
    wire axis_3_request_back;
    wire axis_3_want_fwd;
    wire axis_3_want_back;
    wire axis_3_in_flight;
    wire axis_3_drained;
    wire axis_3_overspeed;
    wire axis_3_underrun;
    wire axis_4_waiting;
    wire axis_4_startable;
    wire axis_4_request;
    wire axis_4_request_back;
    wire axis_4_want_fwd;
    wire axis_4_want_back;
    wire axis_4_in_flight;
    wire axis_4_drained;
    wire axis_4_overspeed;
    wire axis_4_underrun;
    wire axis_5_waiting;
    wire axis_5_startable;
    wire axis_5_request;
    wire axis_5_request_back;
    wire axis_5_want_fwd;
    wire axis_5_want_back;
    wire axis_5_in_flight;
    wire axis_5_drained;
    wire axis_5_overspeed;
    wire axis_5_underrun;
    wire shaper_0_step;
    wire shaper_0_dir;
    wire shaper_0_held_back;
    wire [31:0] shaper_0_position;
    wire [31:0] shaper_0_discarded;
    wire shaper_0_overrun;
    wire shaper_1_step;
    wire shaper_1_dir;
    wire shaper_1_held_back;
    wire [31:0] shaper_1_position;
    wire [31:0] shaper_1_discarded;
    wire shaper_1_overrun;
    wire shaper_2_step;
    wire shaper_2_dir;
    wire shaper_2_held_back;
    wire [31:0] shaper_2_position;
    wire [31:0] shaper_2_discarded;
    wire shaper_2_overrun;
    wire shaper_3_step;
    wire shaper_3_dir;
    wire shaper_3_held_back;
    wire [31:0] shaper_3_position;
    wire [31:0] shaper_3_discarded;
    wire shaper_3_overrun;
    wire shaper_4_step;
    wire shaper_4_dir;
    wire shaper_4_held_back;
    wire [31:0] shaper_4_position;
    wire [31:0] shaper_4_discarded;
    wire shaper_4_overrun;
    wire shaper_5_step;
    wire shaper_5_dir;
    wire shaper_5_held_back;
    wire [31:0] shaper_5_position;
    wire [31:0] shaper_5_discarded;
    wire shaper_5_overrun;

    wire clear_now = clear & frozen & !in_flight;
    wire [5:0] selected = FIRST << seg_axis;
    wire nobody = seg_axis >= AXES;
    wire taken = seg_valid & seg_ready;
    wire push = taken & !nobody & (seg_ticks != NO_TICKS);
    wire start = start_valid & start_ready;
    wire go = armed & tick_strobe & all_startable & !frozen;

    assign seg_ready = !(frozen | waiting);
    assign start_ready = !(frozen | armed);
    assign step[0] = shaper_0_step;
    assign step[1] = shaper_1_step;
    assign step[2] = shaper_2_step;
    assign step[3] = shaper_3_step;
    assign step[4] = shaper_4_step;
    assign step[5] = shaper_5_step;
    assign dir[0] = shaper_0_dir;
    assign dir[1] = shaper_1_dir;
    assign dir[2] = shaper_2_dir;
    assign dir[3] = shaper_3_dir;
    assign dir[4] = shaper_4_dir;
    assign dir[5] = shaper_5_dir;
    assign position[31:0] = shaper_0_position;
    assign position[63:32] = shaper_1_position;
    assign position[95:64] = shaper_2_position;
    assign position[127:96] = shaper_3_position;
    assign position[159:128] = shaper_4_position;
    assign position[191:160] = shaper_5_position;
    assign discarded[31:0] = shaper_0_discarded;
    assign discarded[63:32] = shaper_1_discarded;
    assign discarded[95:64] = shaper_2_discarded;
    assign discarded[127:96] = shaper_3_discarded;
    assign discarded[159:128] = shaper_4_discarded;
    assign discarded[191:160] = shaper_5_discarded;
    assign idle = at_rest;
    assign fault = frozen;
    assign overrun[0] = shaper_0_overrun;
    assign overrun[1] = shaper_1_overrun;
    assign overrun[2] = shaper_2_overrun;
    assign overrun[3] = shaper_3_overrun;
    assign overrun[4] = shaper_4_overrun;
    assign overrun[5] = shaper_5_overrun;
    assign overspeed[0] = axis_0_overspeed;
    assign overspeed[1] = axis_1_overspeed;
    assign overspeed[2] = axis_2_overspeed;
    assign overspeed[3] = axis_3_overspeed;
    assign overspeed[4] = axis_4_overspeed;
    assign overspeed[5] = axis_5_overspeed;
    assign underrun[0] = axis_0_underrun;
    assign underrun[1] = axis_1_underrun;
    assign underrun[2] = axis_2_underrun;
    assign underrun[3] = axis_3_underrun;
    assign underrun[4] = axis_4_underrun;
    assign underrun[5] = axis_5_underrun;
    assign protocol = broken;
    assign started = go;

    always @(*) begin
        frozen = broken;
        frozen = frozen | shaper_0_overrun | axis_0_overspeed | axis_0_underrun;
        frozen = frozen | shaper_1_overrun | axis_1_overspeed | axis_1_underrun;
        frozen = frozen | shaper_2_overrun | axis_2_overspeed | axis_2_underrun;
        frozen = frozen | shaper_3_overrun | axis_3_overspeed | axis_3_underrun;
        frozen = frozen | shaper_4_overrun | axis_4_overspeed | axis_4_underrun;
        frozen = frozen | shaper_5_overrun | axis_5_overspeed | axis_5_underrun;
    end

    always @(*) begin
        in_flight = 1'b0;
        in_flight = in_flight | axis_0_in_flight | shaper_0_step;
        in_flight = in_flight | axis_1_in_flight | shaper_1_step;
        in_flight = in_flight | axis_2_in_flight | shaper_2_step;
        in_flight = in_flight | axis_3_in_flight | shaper_3_step;
        in_flight = in_flight | axis_4_in_flight | shaper_4_step;
        in_flight = in_flight | axis_5_in_flight | shaper_5_step;
    end

    always @(*) begin
        at_rest = !armed;
        at_rest = at_rest & axis_0_drained & !(shaper_0_held_back | shaper_0_step);
        at_rest = at_rest & axis_1_drained & !(shaper_1_held_back | shaper_1_step);
        at_rest = at_rest & axis_2_drained & !(shaper_2_held_back | shaper_2_step);
        at_rest = at_rest & axis_3_drained & !(shaper_3_held_back | shaper_3_step);
        at_rest = at_rest & axis_4_drained & !(shaper_4_held_back | shaper_4_step);
        at_rest = at_rest & axis_5_drained & !(shaper_5_held_back | shaper_5_step);
    end

    always @(*) begin
        waiting = 1'b0;
        waiting = waiting | (selected[0] & axis_0_waiting);
        waiting = waiting | (selected[1] & axis_1_waiting);
        waiting = waiting | (selected[2] & axis_2_waiting);
        waiting = waiting | (selected[3] & axis_3_waiting);
        waiting = waiting | (selected[4] & axis_4_waiting);
        waiting = waiting | (selected[5] & axis_5_waiting);
    end

    always @(*) begin
        unfed = 1'b0;
        unfed = unfed | (start_mask[0] & !axis_0_waiting);
        unfed = unfed | (start_mask[1] & !axis_1_waiting);
        unfed = unfed | (start_mask[2] & !axis_2_waiting);
        unfed = unfed | (start_mask[3] & !axis_3_waiting);
        unfed = unfed | (start_mask[4] & !axis_4_waiting);
        unfed = unfed | (start_mask[5] & !axis_5_waiting);
    end

    always @(*) begin
        all_startable = 1'b1;
        all_startable = all_startable & (!mask[0] | axis_0_startable);
        all_startable = all_startable & (!mask[1] | axis_1_startable);
        all_startable = all_startable & (!mask[2] | axis_2_startable);
        all_startable = all_startable & (!mask[3] | axis_3_startable);
        all_startable = all_startable & (!mask[4] | axis_4_startable);
        all_startable = all_startable & (!mask[5] | axis_5_startable);
    end

    carrystep_tick #(
        .CLOCKS_PER_TICK(CLOCKS_PER_TICK)
    ) tick (
        .clock(clock),
        .strobe(tick_strobe),
        .phase_start(tick_phase_start),
        .phase(tick_phase)
    );

    carrystep_axis #(
        .START_HALF(START_HALF)
    ) axis_0 (
        .clock(clock),
        .strobe(tick_strobe),
        .phase_start(tick_phase_start),
        .phase(tick_phase),
        .frozen(frozen),
        .clear(clear_now),
        .go(go & mask[0]),
        .push(push & selected[0]),
        .seg_ticks(seg_ticks),
        .seg_v(seg_v),
        .seg_a(seg_a),
        .seg_j(seg_j),
        .seg_last(seg_last),
        .waiting(axis_0_waiting),
        .startable(axis_0_startable),
        .request(axis_0_request),
        .request_back(axis_0_request_back),
        .want_fwd(axis_0_want_fwd),
        .want_back(axis_0_want_back),
        .in_flight(axis_0_in_flight),
        .drained(axis_0_drained),
        .overspeed(axis_0_overspeed),
        .underrun(axis_0_underrun),
        .crossed(),
        .back(),
        .q(),
        .p(),
        .v()
    );

    carrystep_axis #(
        .START_HALF(START_HALF)
    ) axis_1 (
        .clock(clock),
        .strobe(tick_strobe),
        .phase_start(tick_phase_start),
        .phase(tick_phase),
        .frozen(frozen),
        .clear(clear_now),
        .go(go & mask[1]),
        .push(push & selected[1]),
        .seg_ticks(seg_ticks),
        .seg_v(seg_v),
        .seg_a(seg_a),
        .seg_j(seg_j),
        .seg_last(seg_last),
        .waiting(axis_1_waiting),
        .startable(axis_1_startable),
        .request(axis_1_request),
        .request_back(axis_1_request_back),
        .want_fwd(axis_1_want_fwd),
        .want_back(axis_1_want_back),
        .in_flight(axis_1_in_flight),
        .drained(axis_1_drained),
        .overspeed(axis_1_overspeed),
        .underrun(axis_1_underrun),
        .crossed(),
        .back(),
        .q(),
        .p(),
        .v()
    );

    carrystep_axis #(
        .START_HALF(START_HALF)
    ) axis_2 (
        .clock(clock),
        .strobe(tick_strobe),
        .phase_start(tick_phase_start),
        .phase(tick_phase),
        .frozen(frozen),
        .clear(clear_now),
        .go(go & mask[2]),
        .push(push & selected[2]),
        .seg_ticks(seg_ticks),
        .seg_v(seg_v),
        .seg_a(seg_a),
        .seg_j(seg_j),
        .seg_last(seg_last),
        .waiting(axis_2_waiting),
        .startable(axis_2_startable),
        .request(axis_2_request),
        .request_back(axis_2_request_back),
        .want_fwd(axis_2_want_fwd),
        .want_back(axis_2_want_back),
        .in_flight(axis_2_in_flight),
        .drained(axis_2_drained),
        .overspeed(axis_2_overspeed),
        .underrun(axis_2_underrun),
        .crossed(),
        .back(),
        .q(),
        .p(),
        .v()
    );

    carrystep_axis #(
        .START_HALF(START_HALF)
    ) axis_3 (
        .clock(clock),
        .strobe(tick_strobe),
        .phase_start(tick_phase_start),
        .phase(tick_phase),
        .frozen(frozen),
        .clear(clear_now),
        .go(go & mask[3]),
        .push(push & selected[3]),
        .seg_ticks(seg_ticks),
        .seg_v(seg_v),
        .seg_a(seg_a),
        .seg_j(seg_j),
        .seg_last(seg_last),
        .waiting(axis_3_waiting),
        .startable(axis_3_startable),
        .request(axis_3_request),
        .request_back(axis_3_request_back),
        .want_fwd(axis_3_want_fwd),
        .want_back(axis_3_want_back),
        .in_flight(axis_3_in_flight),
        .drained(axis_3_drained),
        .overspeed(axis_3_overspeed),
        .underrun(axis_3_underrun),
        .crossed(),
        .back(),
        .q(),
        .p(),
        .v()
    );

    carrystep_axis #(
        .START_HALF(START_HALF)
    ) axis_4 (
        .clock(clock),
        .strobe(tick_strobe),
        .phase_start(tick_phase_start),
        .phase(tick_phase),
        .frozen(frozen),
        .clear(clear_now),
        .go(go & mask[4]),
        .push(push & selected[4]),
        .seg_ticks(seg_ticks),
        .seg_v(seg_v),
        .seg_a(seg_a),
        .seg_j(seg_j),
        .seg_last(seg_last),
        .waiting(axis_4_waiting),
        .startable(axis_4_startable),
        .request(axis_4_request),
        .request_back(axis_4_request_back),
        .want_fwd(axis_4_want_fwd),
        .want_back(axis_4_want_back),
        .in_flight(axis_4_in_flight),
        .drained(axis_4_drained),
        .overspeed(axis_4_overspeed),
        .underrun(axis_4_underrun),
        .crossed(),
        .back(),
        .q(),
        .p(),
        .v()
    );

    carrystep_axis #(
        .START_HALF(START_HALF)
    ) axis_5 (
        .clock(clock),
        .strobe(tick_strobe),
        .phase_start(tick_phase_start),
        .phase(tick_phase),
        .frozen(frozen),
        .clear(clear_now),
        .go(go & mask[5]),
        .push(push & selected[5]),
        .seg_ticks(seg_ticks),
        .seg_v(seg_v),
        .seg_a(seg_a),
        .seg_j(seg_j),
        .seg_last(seg_last),
        .waiting(axis_5_waiting),
        .startable(axis_5_startable),
        .request(axis_5_request),
        .request_back(axis_5_request_back),
        .want_fwd(axis_5_want_fwd),
        .want_back(axis_5_want_back),
        .in_flight(axis_5_in_flight),
        .drained(axis_5_drained),
        .overspeed(axis_5_overspeed),
        .underrun(axis_5_underrun),
        .crossed(),
        .back(),
        .q(),
        .p(),
        .v()
    );

    carrystep_shaper #(
        .STEP_HIGH(STEP_HIGH_0),
        .STEP_LOW(STEP_LOW_0),
        .DIR_SETUP(DIR_SETUP_0),
        .DIR_HOLD(DIR_HOLD_0)
    ) shaper_0 (
        .clock(clock),
        .frozen(frozen),
        .clear(clear_now),
        .request(axis_0_request),
        .request_back(axis_0_request_back),
        .want_fwd(axis_0_want_fwd),
        .want_back(axis_0_want_back),
        .step(shaper_0_step),
        .dir(shaper_0_dir),
        .held_back(shaper_0_held_back),
        .position(shaper_0_position),
        .discarded(shaper_0_discarded),
        .overrun(shaper_0_overrun)
    );

    carrystep_shaper #(
        .STEP_HIGH(STEP_HIGH_1),
        .STEP_LOW(STEP_LOW_1),
        .DIR_SETUP(DIR_SETUP_1),
        .DIR_HOLD(DIR_HOLD_1)
    ) shaper_1 (
        .clock(clock),
        .frozen(frozen),
        .clear(clear_now),
        .request(axis_1_request),
        .request_back(axis_1_request_back),
        .want_fwd(axis_1_want_fwd),
        .want_back(axis_1_want_back),
        .step(shaper_1_step),
        .dir(shaper_1_dir),
        .held_back(shaper_1_held_back),
        .position(shaper_1_position),
        .discarded(shaper_1_discarded),
        .overrun(shaper_1_overrun)
    );

    carrystep_shaper #(
        .STEP_HIGH(STEP_HIGH_2),
        .STEP_LOW(STEP_LOW_2),
        .DIR_SETUP(DIR_SETUP_2),
        .DIR_HOLD(DIR_HOLD_2)
    ) shaper_2 (
        .clock(clock),
        .frozen(frozen),
        .clear(clear_now),
        .request(axis_2_request),
        .request_back(axis_2_request_back),
        .want_fwd(axis_2_want_fwd),
        .want_back(axis_2_want_back),
        .step(shaper_2_step),
        .dir(shaper_2_dir),
        .held_back(shaper_2_held_back),
        .position(shaper_2_position),
        .discarded(shaper_2_discarded),
        .overrun(shaper_2_overrun)
    );

    carrystep_shaper #(
        .STEP_HIGH(STEP_HIGH_3),
        .STEP_LOW(STEP_LOW_3),
        .DIR_SETUP(DIR_SETUP_3),
        .DIR_HOLD(DIR_HOLD_3)
    ) shaper_3 (
        .clock(clock),
        .frozen(frozen),
        .clear(clear_now),
        .request(axis_3_request),
        .request_back(axis_3_request_back),
        .want_fwd(axis_3_want_fwd),
        .want_back(axis_3_want_back),
        .step(shaper_3_step),
        .dir(shaper_3_dir),
        .held_back(shaper_3_held_back),
        .position(shaper_3_position),
        .discarded(shaper_3_discarded),
        .overrun(shaper_3_overrun)
    );

    carrystep_shaper #(
        .STEP_HIGH(STEP_HIGH_4),
        .STEP_LOW(STEP_LOW_4),
        .DIR_SETUP(DIR_SETUP_4),
        .DIR_HOLD(DIR_HOLD_4)
    ) shaper_4 (
        .clock(clock),
        .frozen(frozen),
        .clear(clear_now),
        .request(axis_4_request),
        .request_back(axis_4_request_back),
        .want_fwd(axis_4_want_fwd),
        .want_back(axis_4_want_back),
        .step(shaper_4_step),
        .dir(shaper_4_dir),
        .held_back(shaper_4_held_back),
        .position(shaper_4_position),
        .discarded(shaper_4_discarded),
        .overrun(shaper_4_overrun)
    );

    carrystep_shaper #(
        .STEP_HIGH(STEP_HIGH_5),
        .STEP_LOW(STEP_LOW_5),
        .DIR_SETUP(DIR_SETUP_5),
        .DIR_HOLD(DIR_HOLD_5)
    ) shaper_5 (
        .clock(clock),
        .frozen(frozen),
        .clear(clear_now),
        .request(axis_5_request),
        .request_back(axis_5_request_back),
        .want_fwd(axis_5_want_fwd),
        .want_back(axis_5_want_back),
        .step(shaper_5_step),
        .dir(shaper_5_dir),
        .held_back(shaper_5_held_back),
        .position(shaper_5_position),
        .discarded(shaper_5_discarded),
        .overrun(shaper_5_overrun)
    );

    always @(posedge clock) begin
        if (go | frozen) begin
            armed <= 1'b0;
        end
        if (start & !unfed) begin
            armed <= 1'b1;
            mask <= start_mask;
        end
        if ((taken & !push) | (start & unfed)) begin
            broken <= 1'b1;
        end
        if (clear_now) begin
            broken <= 1'b0;
        end
    end
endmodule

`default_nettype wire

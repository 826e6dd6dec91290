// Compares the engine with the parallel axes: given the same two segments per axis, both drive the
// same STEP and DIR in every clock.
//
//   parameters   AXES: number of axes
//                PARALLEL: the name of the parallel core of this number of axes
//                CLOCKS, PHASES: clocks and phases in a tick
//                TICKS_1, TICKS_2: ticks of the two segments
//                FREE: a mask of the bits of V, A and J that may have any value; the others are 0
//                Both cores are exported as a whole.
//   assumptions  none
//
// Both hosts offer the same segments, and each starts all axes on one tick. The second segment is
// marked as the last of its move. Ports that are not connected here are 0.
//
// A fault of the parallel axes ends the comparison, because the engine stops in a different way.
// The engine must then also stop, within a tick.

module promises (
    input wire clock
);
    localparam [31:0] TICKS_1 = `TICKS_1, TICKS_2 = `TICKS_2, CLOCKS = `CLOCKS, PHASE_CLOCKS = CLOCKS / `PHASES;
    localparam [3:0] SEGMENTS = 2 * `AXES;

    // ---- Any V, A and J: first those of segment 1 of each axis, then those of segment 2.

    (* anyconst *) reg [SEGMENTS*192-1:0] any;
    wire [SEGMENTS*192-1:0] numbers = any & {3 * SEGMENTS{64'd0 | `FREE}};

    integer i;

    // ---- The engine's host, which puts one word of each axis in each tick.

    reg [5:0] put = 0;               // bit 3: the segment; bits 2 to 0: the word of the segment
    reg [2:0] put_axis = 0;
    wire all_put = put[4];
    reg start = 0, begun = 0;
    wire put_ready, start_ready;
    wire [3:0] putting = put_axis + (put[3] ? `AXES : 0);
    reg [255:0] put_words;
    reg [31:0] put_data;
    always_comb begin
        put_words = {31'd0, put[3], 192'd0, (put[3] ? TICKS_2 : TICKS_1) - 1};
        for (i = 0; i < SEGMENTS; i = i + 1) if (putting == i) put_words[223:32] = numbers[192*i +: 192];
        put_data = 0;
        for (i = 0; i < 8; i = i + 1) if (put[2:0] == i) put_data = put_words[32*i +: 32];
    end
    always @(posedge clock) begin
        if (!all_put && put_ready) begin
            put_axis <= put_axis == `AXES - 1 ? 0 : put_axis + 1;
            if (put_axis == `AXES - 1) put <= put + 1;
        end
        start <= all_put && !begun;
        if (start && start_ready) begun <= 1;
    end

    // ---- The host of the parallel axes. An axis can hold one waiting segment; so the host offers
    // its second segment while the first one runs.

    reg [3:0] given = 0;
    reg asks = 0;
    wire seg_ready, axes_start_ready, offers = given != SEGMENTS;
    wire second = given >= `AXES;
    wire [2:0] seg_axis = second ? given - `AXES : given;
    reg [191:0] seg_numbers;
    always_comb begin
        seg_numbers = 0;
        for (i = 0; i < SEGMENTS; i = i + 1) if (given == i) seg_numbers = numbers[192*i +: 192];
    end
    always @(posedge clock) begin
        if (offers && seg_ready) given <= given + 1;
        asks <= start && start_ready && !begun || asks && !axes_start_ready;
    end

    // ---- Both cores.

    wire [`AXES-1:0] step, dir, axes_step, axes_dir;
    wire fault, started, axes_fault, axes_started, axes_idle;
    carrystep_engine dut (
        .clock(clock), .put_valid(!all_put), .put_axis(put_axis), .put_word(put[2:0]), .put_data(put_data),
        .put_ready(put_ready), .start_valid(start && !begun), .start_mask({`AXES{1'b1}}), .start_ready(start_ready),
        .kick(1'b1), .enable(1'b1), .step(step), .dir(dir), .fault(fault), .started(started)
    );
    `PARALLEL axes (
        .clock(clock), .seg_valid(offers), .seg_axis(seg_axis), .seg_ticks(second ? TICKS_2 : TICKS_1),
        .seg_v(seg_numbers[63:0]), .seg_a(seg_numbers[127:64]), .seg_j(seg_numbers[191:128]), .seg_last(second),
        .seg_ready(seg_ready), .start_valid(asks), .start_mask({`AXES{1'b1}}), .start_ready(axes_start_ready),
        .clear(1'b0), .step(axes_step), .dir(axes_dir), .idle(axes_idle), .fault(axes_fault), .started(axes_started)
    );

    // ---- The assertions: both cores behave in the same way.

    wire same = !axes_fault;
    always_comb begin
        equal_start: assert (started == axes_started);
        equal_step: assert (!same || step == axes_step);
        equal_dir: assert (!same || dir == axes_dir);
        equal_faults: assert (!same || !fault);
        equal_stops: assert (faulty <= CLOCKS || fault);
    end

    // ---- Covers: some run reaches each of these situations. `at` is the clock within the tick,
    // and `tick` is the tick within the move.

    reg [31:0] at = 0, tick = 0, faulty = 0;
    reg [`AXES-1:0] was_step = 0, was_dir = 0, forward = 0, backward = 0;
    wire [`AXES-1:0] rises = same ? step & ~was_step : 0;
    reg first_clock = 1;
    always @(posedge clock) begin
        first_clock <= 0;
        at <= at == CLOCKS - 1 ? 0 : at + 1;
        if (at == CLOCKS - 1 && (started || tick != 0)) tick <= tick + 1;
        if (axes_fault) faulty <= faulty + 1;
        {was_step, was_dir} <= {step, dir};
        forward <= forward | rises & ~dir;
        backward <= backward | rises & dir;
    end
    // STEP rises two ticks after the tick in which the step is computed, one clock after its phase
    // has begun.
    wire [31:0] of_tick = tick - 2;
    wire in_order = rises != 0 && at % PHASE_CLOCKS == 1;

    always_comb begin
        cover_each_forward_and_back: cover (forward == {`AXES{1'b1}} && backward == forward);
        cover_last_phase: cover (in_order && at / PHASE_CLOCKS == `PHASES - 1);
        cover_dir_change_inside: cover (same && dir != was_dir && of_tick == TICKS_1 + 2);
        cover_step_behind_the_boundary: cover (rises != 0 && of_tick == TICKS_1 + 1);
        cover_step_of_last_tick: cover (in_order && of_tick == TICKS_1 + TICKS_2);
        cover_all_over: cover (same && tick > TICKS_1 + TICKS_2 + 2 && axes_idle && forward != 0);
        cover_stopped: cover (faulty > CLOCKS);
    end
endmodule

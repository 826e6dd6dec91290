// The host that docs/clock-by-clock.md specifies, for Icarus: it feeds a program to the parallel
// core, and prints the outputs in every cycle in which any of them changed. The outputs of axes
// that the core does not have are printed as 0.
// Macros: CORE, the name of the core; AXES, its number of axes.
// Arguments: +program=FILE +tail=CYCLES +max=CYCLES.
`timescale 1ns / 1ps
module parallel_bench;
    reg clock = 0, seg_valid = 0, seg_last = 0, start_valid = 0, clear = 0;
    reg [2:0] seg_axis = 0;
    reg [31:0] seg_ticks = 0;
    reg [63:0] seg_v = 0, seg_a = 0, seg_j = 0;
    reg [`AXES-1:0] start_mask = 0;
    wire seg_ready, start_ready, idle, fault, protocol, started;
    wire [`AXES-1:0] step, dir, overrun, overspeed, underrun;
    wire [32*`AXES-1:0] position, discarded;
    wire [191:0] all_positions = position, all_discarded = discarded;

    `CORE core (
        .clock(clock), .seg_valid(seg_valid), .seg_axis(seg_axis), .seg_ticks(seg_ticks),
        .seg_v(seg_v), .seg_a(seg_a), .seg_j(seg_j), .seg_last(seg_last), .seg_ready(seg_ready),
        .start_valid(start_valid), .start_mask(start_mask), .start_ready(start_ready), .clear(clear),
        .step(step), .dir(dir), .position(position), .discarded(discarded), .idle(idle), .fault(fault),
        .overrun(overrun), .overspeed(overspeed), .underrun(underrun), .protocol(protocol), .started(started));

    localparam SEGMENT = 0, START = 1, WAIT = 2, CLEAR = 3, NONE = 4;
    integer file, kind, fields;
    reg [7:0] who;
    reg [31:0] ticks;
    reg [63:0] v, a, j, cycle, quiet, tail, max;
    reg last, done, over;
    wire [69*`AXES+5:0] outputs = {seg_ready, start_ready, step, dir, idle, started, overrun, overspeed, underrun,
                            protocol, fault, position, discarded};
    reg [69*`AXES+5:0] before;
    reg [8*256-1:0] name;

    task next_command;
        begin
            fields = $fscanf(file, "%d %h %h %h %h %h %b", kind, who, ticks, v, a, j, last);
            if (fields != 7) kind = NONE;
        end
    endtask

    task report(input [7:0] letter);
        $display("%c %0d %h %h %h %h %h %h %h %h %h %h %h %h", letter, cycle, seg_ready, start_ready, step, dir,
                 idle, started, overrun, overspeed, underrun, protocol, all_positions, all_discarded);
    endtask

    initial begin
        if (!$value$plusargs("program=%s", name)) $finish;
        if (!$value$plusargs("tail=%d", tail)) $finish;
        if (!$value$plusargs("max=%d", max)) $finish;
        file = $fopen(name, "r");
        next_command;
        cycle = 0;
        quiet = 0;
        over = 0;
        before = {69*`AXES+6{1'bx}};
        #1; // At time 0 the order of initial values and combinational blocks is undefined.
        while (!over) begin
            // The bench drives the inputs while the clock is low; `fault` is a register and has
            // settled.
            seg_valid = kind == SEGMENT && !fault;
            seg_axis = seg_valid ? who[2:0] : 3'd0;
            {seg_ticks, seg_v, seg_a, seg_j, seg_last} = {ticks, v, a, j, last};
            start_valid = kind == START && !fault;
            start_mask = who[`AXES-1:0];
            clear = kind == CLEAR;
            #1;
            if (outputs !== before) report("O");
            before = outputs;
            quiet = kind == NONE && (idle || fault) ? quiet + 1 : 0;
            if (quiet == tail) begin
                report("E");
                over = 1;
            end else if (cycle + 1 == max) begin
                $display("X");
                over = 1;
            end else begin
                case (kind)
                    SEGMENT: done = fault || seg_ready;
                    START:   done = fault || start_ready;
                    WAIT:    begin ticks = ticks - 1; done = ticks == 0; end
                    CLEAR:   done = !fault;
                    default: done = 0;
                endcase
                if (done) next_command;
                clock = 1;
                #1 clock = 0;
                #1 cycle = cycle + 1;
            end
        end
        $finish;
    end
endmodule

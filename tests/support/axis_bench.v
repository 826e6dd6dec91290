// Runs carrystep_axis alone in Icarus with the least number of clocks per tick: one for the strobe,
// and BISECTION clocks for the bisection. Each line of the file +program=FILE has one segment:
// ticks, v, a, j and last, in hexadecimal. The bench prints `tick phase back` for each step and,
// after the last segment, `P` and its value.
`timescale 1ns / 1ps
module axis_bench;
    parameter BISECTION = 4;
    reg clock, strobe = 0, go = 0, push = 0, last = 0;
    reg [31:0] ticks = 0;
    reg [63:0] v = 0, a = 0, j = 0;
    wire waiting, crossed, back, drained;
    wire [3:0] q;
    wire [63:0] p;

    carrystep_axis axis (
        .clock(clock), .strobe(strobe), .phase_start(1'b0), .phase(4'd0), .frozen(1'b0), .clear(1'b0), .go(go),
        .push(push), .seg_ticks(ticks), .seg_v(v), .seg_a(a), .seg_j(j), .seg_last(last), .waiting(waiting),
        .startable(), .request(), .request_back(), .want_fwd(), .want_back(), .in_flight(), .drained(drained),
        .overspeed(), .underrun(), .crossed(crossed), .back(back), .q(q), .p(p), .v());

    integer file, i;
    reg [31:0] tick;
    reg more, over;
    reg [8*256-1:0] name;

    task cycle;
        begin
            #1 clock = 1;
            #1 clock = 0;
        end
    endtask

    // Reads the next segment from the file and, if there is one, offers it in the following cycle.
    task offer;
        begin
            more = $fscanf(file, "%h %h %h %h %b", ticks, v, a, j, last) == 5;
            push = more;
        end
    endtask

    initial begin
        if (!$value$plusargs("program=%s", name)) $finish;
        file = $fopen(name, "r");
        #1 clock = 0;
        offer;
        cycle;
        push = 0;
        tick = 0;
        over = 0;
        go = 1;
        while (!over) begin
            strobe = 1;
            cycle;
            strobe = 0;
            go = 0;
            #1 if (!waiting && more) offer;
            for (i = 0; i < BISECTION; i = i + 1) begin
                cycle;
                push = 0;
            end
            #1 if (tick != 0 && crossed) $display("%0d %0d %b", tick, q, back);
            tick = tick + 1;
            over = drained && !more;
        end
        $display("P %h", p);
        $finish;
    end
endmodule

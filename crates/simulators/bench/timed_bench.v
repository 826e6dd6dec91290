// Applies recorded cycles to one module whose Verilog has delays, in Icarus. The file is that of
// vectors_bench.v. The inputs change some time after the clock's rising edge; the outputs are
// compared just before the next one.
//
// The bench prints the first cycle that differs, the first output that changes twice in one cycle,
// and in its last line the number of cycles, the number of changes, and the shortest and the longest
// time from the clock's rising edge to a change. Arguments: +vectors=FILE, +half=PS, half a period;
// +late=PS, the time from a rising edge to a change of the inputs, at most half a period;
// +cycles=N, the most cycles to run.
`timescale 1ps / 1ps
module timed_bench;
    reg clock;
    reg [INPUTS-1:0] inputs;
    wire [OUTPUTS-1:0] outputs;
    reg [OUTPUTS-1:0] expected, counts;
    MODULE module_of_vectors (.CLOCK(clock)CONNECTIONS);

    integer file, fields;
    reg [63:0] cycle, cycles, count, half, late, rose, changes, least, most;
    reg [8*256-1:0] name;
    reg [OUTPUTS-1:0] before, changed;
    reg differs, glitches;

    always @(outputs) if (rose != 0) begin
        if ((changed & (outputs ^ before)) !== {OUTPUTS{1'b0}} && !glitches) begin
            $display("twice in cycle %0d outputs %h after %h", cycle, outputs, before);
            glitches = 1;
        end
        changed = changed | (outputs ^ before);
        before = outputs;
        changes = changes + 1;
        if ($time - rose < least) least = $time - rose;
        if ($time - rose > most) most = $time - rose;
    end

    initial begin
        if (!$value$plusargs("vectors=%s", name)) $finish;
        if (!$value$plusargs("half=%d", half)) $finish;
        if (!$value$plusargs("late=%d", late)) $finish;
        if (!$value$plusargs("cycles=%d", cycles)) $finish;
        file = $fopen(name, "r");
        cycle = 0;
        clock = 0;
        rose = 0;
        changes = 0;
        least = ~64'd0;
        most = 0;
        differs = 0;
        glitches = 0;
        fields = $fscanf(file, "%d %h %h %h", count, inputs, expected, counts);
        // The models of the cells ignore clock edges in this time.
        #1000000;
        before = outputs;
        while (fields == 4 && cycle < cycles) begin
            #half;
            if (((outputs ^ expected) & counts) !== {OUTPUTS{1'b0}} && !differs) begin
                $display("cycle %0d inputs %h outputs %h expected %h counting %h", cycle, inputs, outputs, expected, counts);
                differs = 1;
            end
            changed = 0;
            rose = $time;
            clock = 1;
            cycle = cycle + 1;
            count = count - 1;
            #late if (count == 0) fields = $fscanf(file, "%d %h %h %h", count, inputs, expected, counts);
            #(half - late) clock = 0;
        end
        $display("end %0d %0d %0d %0d", cycle, changes, least, most);
        $finish;
    end
endmodule

// Applies recorded cycles to one module in Icarus. Each line of the file holds a number of cycles,
// the inputs, the expected outputs, and a mask of the output bits to compare. The bench prints the
// first difference, or the number of cycles that were equal. Argument: +vectors=FILE.
`timescale 1ns / 1ps
module vectors_bench;
    reg clock;
    reg [INPUTS-1:0] inputs;
    wire [OUTPUTS-1:0] outputs;
    reg [OUTPUTS-1:0] expected, counts;
    MODULE module_of_vectors (.CLOCK(clock)CONNECTIONS);

    integer file, fields;
    reg [63:0] cycle, count;
    reg [8*256-1:0] name;

    initial begin
        if (!$value$plusargs("vectors=%s", name)) $finish;
        file = $fopen(name, "r");
        cycle = 0;
        clock = 0;
        fields = 4;
        while (fields == 4) begin
            fields = $fscanf(file, "%d %h %h %h", count, inputs, expected, counts);
            if (fields == 4) while (count != 0) begin
                #1;
                if (((outputs ^ expected) & counts) !== {OUTPUTS{1'b0}}) begin
                    $display("cycle %0d inputs %h outputs %h expected %h counting %h", cycle, inputs, outputs, expected, counts);
                    $finish;
                end
                clock = 1;
                #1 clock = 0;
                cycle = cycle + 1;
                count = count - 1;
            end
        end
        $display("same %0d", cycle);
        $finish;
    end
endmodule

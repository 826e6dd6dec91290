// Replays what a host did to carrystep_engine, for Icarus, and reports every cycle in which any output
// changed; then asks the get port for all that the engine keeps. +stimuli=FILE
`timescale 1ns / 1ps
module engine_bench;
    reg clock, put_valid, start_valid, clear;
    reg [2:0] put_axis, put_word, get_axis = 0;
    reg [31:0] put_data;
    reg [5:0] start_mask;
    reg [1:0] get_item = 0;
    wire put_ready, start_ready, idle, fault, halted, protocol, started, get_valid;
    wire [5:0] step, dir, overrun, overspeed, underrun;
    wire [31:0] get_data;

    carrystep_engine core (
        .clock(clock), .put_valid(put_valid), .put_axis(put_axis), .put_word(put_word), .put_data(put_data),
        .put_ready(put_ready), .start_valid(start_valid), .start_mask(start_mask), .start_ready(start_ready),
        .clear(clear), .get_axis(get_axis), .get_item(get_item), .get_data(get_data), .get_valid(get_valid),
        .step(step), .dir(dir), .idle(idle), .fault(fault), .halted(halted), .overrun(overrun),
        .overspeed(overspeed), .underrun(underrun), .protocol(protocol), .started(started));

    wire [36:0] outputs = {put_ready, start_ready, idle, fault, halted, protocol, started,
                           step, dir, overrun, halted ? overspeed : 6'd0, halted ? underrun : 6'd0};
    reg [36:0] before;
    integer file, fields, axis, item;
    reg [63:0] cycle, count;
    reg [8*256-1:0] name;

    task tick;
        begin
            clock = 1;
            #1 clock = 0;
            #1;
        end
    endtask

    initial begin
        if (!$value$plusargs("stimuli=%s", name)) $finish;
        file = $fopen(name, "r");
        before = {37{1'bx}};
        cycle = 0;
        #1 clock = 0;
        #1;
        fields = 8;
        while (fields == 8) begin
            fields = $fscanf(file, "%d %b %h %h %h %b %h %b", count, put_valid, put_axis, put_word, put_data,
                             start_valid, start_mask, clear);
            if (fields == 8) while (count != 0) begin
                #1;
                if (outputs !== before) $display("%0d %h", cycle, outputs);
                before = outputs;
                tick;
                cycle = cycle + 1;
                count = count - 1;
            end
        end
        put_valid = 0;
        start_valid = 0;
        clear = 0;
        for (axis = 0; axis < 6; axis = axis + 1)
            for (item = 0; item < 4; item = item + 1) begin
                get_axis = axis;
                get_item = item;
                tick;
                while (!get_valid) tick;
                $display("K %h", get_data);
            end
        $finish;
    end
endmodule

// Replays the recorded inputs of a host to carrystep_engine in Icarus, and prints the outputs in
// every cycle in which any of them changed. After the last input it reads P, the position and the
// discarded steps of each axis through the `get` port. Arguments: +stimuli=FILE,
// -Pengine_bench.AXES=n.
`timescale 1ns / 1ps
module engine_bench;
    parameter AXES = 6;
    reg clock, put_valid, start_valid, clear, reset, stop, broken, home_valid, kick, enable, estop;
    reg [AXES-1:0] home_mask, limit_min, limit_max;
    reg [2:0] put_axis, put_word, get_axis = 0;
    reg [31:0] put_data;
    reg [AXES-1:0] start_mask;
    reg [1:0] get_item = 0;
    wire put_ready, start_ready, idle, fault, halted, resetting, started, enabled, get_valid;
    wire armed, ready, latch, room_valid;
    wire [AXES-1:0] step, dir, culprits, homing;
    wire [2:0] cause, latch_axis, room;
    wire [31:0] get_data;

    carrystep_engine core (
        .clock(clock), .put_valid(put_valid), .put_axis(put_axis), .put_word(put_word), .put_data(put_data),
        .put_ready(put_ready), .start_valid(start_valid), .start_mask(start_mask), .start_ready(start_ready),
        .clear(clear), .reset(reset), .resetting(resetting), .stop(stop), .broken(broken), .home_valid(home_valid), .home_mask(home_mask), .kick(kick), .enable(enable), .estop(estop), .limit_min(limit_min),
        .limit_max(limit_max), .get_axis(get_axis), .get_item(get_item), .get_data(get_data), .get_valid(get_valid),
        .latch(latch), .latch_axis(latch_axis), .room(room), .room_valid(room_valid), .armed(armed), .ready(ready), .homing(homing),
        .step(step), .dir(dir), .enabled(enabled), .idle(idle), .fault(fault), .halted(halted), .cause(cause),
        .culprits(culprits), .started(started));

    wire [4*AXES+20:0] outputs = {latch, latch_axis & {3{latch}}, room_valid, room & {3{room_valid}}, armed, ready, homing, put_ready, start_ready, idle, fault, halted, resetting, started, enabled,
                           fault ? cause : 3'd0, step, dir, culprits & {AXES{fault}}};
    reg [4*AXES+20:0] before;
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
        before = {4*AXES+21{1'bx}};
        cycle = 0;
        #1 clock = 0;
        #1;
        fields = 18;
        while (fields == 18) begin
            fields = $fscanf(file, "%d %b %h %h %h %b %h %b %b %b %b %b %h %b %b %b %h %h", count, put_valid, put_axis, put_word,
                             put_data, start_valid, start_mask, clear, reset, stop, broken, home_valid, home_mask, kick, enable, estop,
                             limit_min, limit_max);
            if (fields == 18) while (count != 0) begin
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
        reset = 0;
        stop = 0;
        broken = 0;
        home_valid = 0;
        kick = 0;
        for (axis = 0; axis < AXES; axis = axis + 1)
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

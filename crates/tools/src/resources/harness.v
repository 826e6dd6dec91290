// Connects all ports of carrystep_engine to registers, which shift from one input pin and to one
// output pin. Any package then has enough pins, and the timing analysis covers only paths that are
// inside the engine.
module budget_harness (input wire clock, input wire in, output reg out);
    localparam AXES = 6;
    localparam INPUTS = 53 + 4 * AXES;
    localparam OUTPUTS = 54 + 4 * AXES;

    reg [INPUTS - 1:0] inputs = 0;
    always @(posedge clock) inputs <= {inputs[INPUTS - 2:0], in};

    wire [31:0] get_data;
    wire [AXES - 1:0] step, dir, culprits, homing;
    wire [2:0] latch_axis, room;
    wire [3:0] cause;
    wire latch, room_valid, armed, ready, put_ready, start_ready, idle, fault, halted, started, enabled, get_valid;
    carrystep_engine core (
        .clock(clock), .put_valid(inputs[0]), .put_axis(inputs[3:1]), .put_word(inputs[6:4]), .put_data(inputs[38:7]),
        .put_ready(put_ready), .start_valid(inputs[39]), .start_ready(start_ready), .clear(inputs[40]),
        .stop(inputs[41]), .kick(inputs[42]), .enable(inputs[43]), .estop(inputs[44]), .get_axis(inputs[47:45]),
        .get_item(inputs[49:48]), .broken(inputs[51]), .home_valid(inputs[52]), .start_mask(inputs[53 +: AXES]),
        .limit_min(inputs[53 + AXES +: AXES]), .limit_max(inputs[53 + 2 * AXES +: AXES]),
        .home_mask(inputs[53 + 3 * AXES +: AXES]), .latch(latch), .latch_axis(latch_axis), .room(room),
        .room_valid(room_valid), .armed(armed), .ready(ready), .homing(homing), .get_data(get_data), .get_valid(get_valid), .step(step), .dir(dir),
        .enabled(enabled), .idle(idle), .fault(fault), .halted(halted), .cause(cause), .culprits(culprits),
        .started(started), .reset(1'b0), .resetting());

    reg [OUTPUTS - 1:0] outputs = 0;
    always @(posedge clock) begin
        outputs <= inputs[50] ? {get_data, step, dir, culprits, cause, put_ready, start_ready, idle, fault, halted,
                                 started, enabled, get_valid, latch, latch_axis, room, room_valid, armed, ready, homing} : {outputs[OUTPUTS - 2:0], 1'b0};
        out <= outputs[OUTPUTS - 1];
    end
endmodule

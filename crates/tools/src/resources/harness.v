// Connects all ports of carrystep_engine to registers, which shift from one input pin and to one
// output pin. Any package then has enough pins, and the timing analysis covers only paths that are
// inside the engine.
module budget_harness (input wire clock, input wire in, output reg out);
    localparam AXES = 6;
    localparam INPUTS = 49 + 4 * AXES;
    localparam OUTPUTS = 59 + 4 * AXES;

    reg [INPUTS - 1:0] inputs = 0;
    always @(posedge clock) inputs <= {inputs[INPUTS - 2:0], in};

    wire [31:0] state;
    wire [1:0] state_page;
    wire [AXES - 1:0] step, dir, culprits, homing;
    wire [2:0] state_axis, state_item, room;
    wire [3:0] cause;
    wire room_valid, armed, ready, put_ready, start_ready, idle, fault, halted, started, enabled, state_valid, refreshed;
    carrystep_engine core (
        .clock(clock), .put_valid(inputs[0]), .put_axis(inputs[3:1]), .put_word(inputs[6:4]), .put_data(inputs[38:7]),
        .put_ready(put_ready), .start_valid(inputs[39]), .start_ready(start_ready), .clear(inputs[40]),
        .stop(inputs[41]), .kick(inputs[42]), .enable(inputs[43]), .estop(inputs[44]), .snapshot(inputs[45]),
        .broken(inputs[47]), .home_valid(inputs[48]), .start_mask(inputs[49 +: AXES]),
        .limit_min(inputs[49 + AXES +: AXES]), .limit_max(inputs[49 + 2 * AXES +: AXES]),
        .home_mask(inputs[49 + 3 * AXES +: AXES]), .room(room), .room_valid(room_valid), .armed(armed), .ready(ready),
        .homing(homing), .state_valid(state_valid), .state_page(state_page), .state_axis(state_axis),
        .state_item(state_item), .state(state), .refreshed(refreshed), .step(step), .dir(dir),
        .enabled(enabled), .idle(idle), .fault(fault), .halted(halted), .cause(cause), .culprits(culprits),
        .started(started), .reset(1'b0), .resetting());

    reg [OUTPUTS - 1:0] outputs = 0;
    always @(posedge clock) begin
        outputs <= inputs[46] ? {state, state_page, state_axis, state_item, step, dir, culprits, cause, put_ready, start_ready, idle, fault, halted,
                                 started, enabled, state_valid, refreshed, room, room_valid, armed, ready, homing} : {outputs[OUTPUTS - 2:0], 1'b0};
        out <= outputs[OUTPUTS - 1];
    end
endmodule

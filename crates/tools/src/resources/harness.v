// Connects all ports of carrystep_engine to registers, which shift from one input pin and to one
// output pin. Any package then has enough pins, and the timing analysis covers only paths that are
// inside the engine.
module budget_harness (input wire clock, input wire in, output reg out);
    localparam AXES = 6;
    localparam INPUTS = 61 + 6 * AXES;
    localparam OUTPUTS = 77 + 5 * AXES;

    reg [INPUTS - 1:0] inputs = 0;
    always @(posedge clock) inputs <= {inputs[INPUTS - 2:0], in};

    wire [31:0] state;
    wire [1:0] state_page;
    wire [AXES - 1:0] step, dir, culprits, seeking, hits;
    wire [2:0] state_axis, state_item;
    wire [4:0] room;
    wire [3:0] cause, latch_edges;
    wire [7:0] levels;
    wire pwm, cut_busy, cut_refused;
    wire room_valid, armed, ready, latch_armed, put_ready, start_ready, idle, fault, halted, started, enabled, state_valid, refreshed;
    carrystep_engine core (
        .clock(clock), .put_valid(inputs[0]), .put_axis(inputs[3:1]), .put_word({inputs[59 + 6 * AXES], inputs[6:4]}), .put_data(inputs[38:7]),
        .put_ready(put_ready), .start_valid(inputs[39]), .start_ready(start_ready), .clear(inputs[40]),
        .stop(inputs[41]), .kick(inputs[42]), .enable(inputs[43]), .estop(inputs[44]), .snapshot(inputs[45]),
        .broken(inputs[47]), .seek_valid(inputs[48]), .start_mask(inputs[49 +: AXES]),
        .limit_min(inputs[49 + AXES +: AXES]), .limit_max(inputs[49 + 2 * AXES +: AXES]),
        .seek_mask(inputs[49 + 3 * AXES +: AXES]), .inputs_0(inputs[49 + 4 * AXES +: AXES]), .inputs_1(inputs[49 + 5 * AXES +: AXES]),
        .seek_source_valid(inputs[49 + 6 * AXES]), .seek_source(inputs[50 + 6 * AXES +: 7]),
        .cut(inputs[60 + 6 * AXES]), .cut_busy(cut_busy), .cut_refused(cut_refused),
        .latch_arm(inputs[57 + 6 * AXES]), .latch(inputs[58 + 6 * AXES]), .room(room), .room_valid(room_valid), .armed(armed), .ready(ready),
        .seeking(seeking), .hits(hits), .latch_armed(latch_armed), .latch_edges(latch_edges), .state_valid(state_valid), .state_page(state_page), .state_axis(state_axis),
        .state_item(state_item), .state(state), .refreshed(refreshed), .step(step), .dir(dir),
        .enabled(enabled), .idle(idle), .fault(fault), .halted(halted), .cause(cause), .culprits(culprits),
        .started(started), .outputs(levels), .pwm(pwm), .reset(1'b0), .resetting());

    reg [OUTPUTS - 1:0] outputs = 0;
    always @(posedge clock) begin
        outputs <= inputs[46] ? {state, state_page, state_axis, state_item, step, dir, culprits, cause, put_ready, start_ready, idle, fault, halted,
                                 started, enabled, state_valid, refreshed, room, room_valid, armed, ready, seeking, hits, latch_armed, latch_edges,
                                 levels, pwm, cut_busy, cut_refused} : {outputs[OUTPUTS - 2:0], 1'b0};
        out <= outputs[OUTPUTS - 1];
    end
endmodule

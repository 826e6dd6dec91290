// Carries every port of carrystep_engine on two pins, through registers, so that any package holds it and
// only paths inside the engine are timed.
module budget_harness (input wire clock, input wire in, output reg out);
    reg [71:0] inputs = 72'd0;
    always @(posedge clock) inputs <= {inputs[70:0], in};

    wire [31:0] get_data;
    wire [5:0] step, dir, culprits;
    wire [2:0] cause;
    wire put_ready, start_ready, idle, fault, halted, started, enabled, get_valid;
    carrystep_engine core (
        .clock(clock), .put_valid(inputs[0]), .put_axis(inputs[3:1]), .put_word(inputs[6:4]), .put_data(inputs[38:7]),
        .put_ready(put_ready), .start_valid(inputs[39]), .start_mask(inputs[45:40]), .start_ready(start_ready),
        .clear(inputs[46]), .stop(inputs[47]), .kick(inputs[48]), .enable(inputs[49]), .estop(inputs[50]),
        .limit_min(inputs[56:51]), .limit_max(inputs[62:57]), .get_axis(inputs[65:63]), .get_item(inputs[67:66]),
        .get_data(get_data), .get_valid(get_valid), .step(step), .dir(dir), .enabled(enabled), .idle(idle),
        .fault(fault), .halted(halted), .cause(cause), .culprits(culprits), .started(started));

    reg [60:0] outputs = 61'd0;
    always @(posedge clock) begin
        outputs <= inputs[68] ? {get_data, step, dir, culprits, cause, put_ready, start_ready, idle, fault, halted,
                                 started, enabled, get_valid} : {outputs[59:0], 1'b0};
        out <= outputs[60];
    end
endmodule

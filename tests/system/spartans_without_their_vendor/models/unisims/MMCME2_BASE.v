// Ports and attributes of the cell, written from memory of Xilinx UG472. Only CLKOUT0 and the
// feedback have a function. An attribute out of its range, an input of another period than
// CLKIN1_PERIOD says, and a VCO or phase detector out of its range (DS189, speed grade -1) are
// errors. Without feedback there is no lock.
`timescale 1 ps / 1 fs

module MMCME2_BASE #(
    parameter BANDWIDTH = "OPTIMIZED",
    parameter real CLKFBOUT_MULT_F = 5.0,
    parameter real CLKFBOUT_PHASE = 0.0,
    parameter real CLKIN1_PERIOD = 0.0,
    parameter real CLKOUT0_DIVIDE_F = 1.0,
    parameter real CLKOUT0_DUTY_CYCLE = 0.5,
    parameter real CLKOUT0_PHASE = 0.0,
    parameter integer DIVCLK_DIVIDE = 1,
    parameter real REF_JITTER1 = 0.0,
    parameter STARTUP_WAIT = "FALSE"
) (
    input CLKFBIN, CLKIN1, PWRDWN, RST,
    output CLKFBOUT, CLKFBOUTB, CLKOUT0, CLKOUT0B, LOCKED
);
    wire synthesised;
    carrystep_synthesiser #(
        .MULTIPLY(CLKFBOUT_MULT_F), .DIVIDE(DIVCLK_DIVIDE * CLKOUT0_DIVIDE_F)
    ) synthesiser (
        .reference(CLKIN1), .reset(RST !== 1'b0 || PWRDWN !== 1'b0 || glbl.GSR),
        .out(CLKOUT0), .locked(synthesised)
    );
    assign CLKOUT0B = !CLKOUT0;
    assign CLKFBOUT = CLKIN1;
    assign CLKFBOUTB = !CLKFBOUT;

    reg fed_back = 1'b0;
    always @(posedge CLKFBIN) fed_back <= 1'b1;
    assign LOCKED = synthesised && fed_back;

    real detector, vco;
    always @(posedge synthesised) begin
        detector = 1000000.0 / synthesiser.period / DIVCLK_DIVIDE;
        vco = detector * CLKFBOUT_MULT_F;
        if (detector < 9.99 || detector > 450.0)
            $display("Error: the phase detector has %0f MHz", detector);
        if (vco < 599.9 || vco > 1200.1) $display("Error: the VCO has %0f MHz", vco);
        if (synthesiser.period > 1010.0 * CLKIN1_PERIOD || synthesiser.period < 990.0 * CLKIN1_PERIOD)
            $display(
                "Error: CLKIN1 has %0f ps, CLKIN1_PERIOD is %0f ns", synthesiser.period, CLKIN1_PERIOD
            );
    end
    initial begin
        if (CLKFBOUT_MULT_F < 2.0 || CLKFBOUT_MULT_F > 64.0)
            $display("Error: CLKFBOUT_MULT_F is %0f", CLKFBOUT_MULT_F);
        if (CLKOUT0_DIVIDE_F < 1.0 || CLKOUT0_DIVIDE_F > 128.0)
            $display("Error: CLKOUT0_DIVIDE_F is %0f", CLKOUT0_DIVIDE_F);
        if (DIVCLK_DIVIDE < 1 || DIVCLK_DIVIDE > 106)
            $display("Error: DIVCLK_DIVIDE is %0d", DIVCLK_DIVIDE);
    end
endmodule

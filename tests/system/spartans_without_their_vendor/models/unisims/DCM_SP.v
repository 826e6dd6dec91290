// Ports and attributes of the cell. The ports are those of the vendor's model; attributes and ranges
// are written from memory of Xilinx UG331 and UG382. Only the frequency synthesiser has a function. An
// attribute out of its range, and an input of another period than CLKIN_PERIOD says, are errors.
`timescale 1 ps / 1 fs

module DCM_SP #(
    parameter real CLKDV_DIVIDE = 2.0,
    parameter integer CLKFX_DIVIDE = 1,
    parameter integer CLKFX_MULTIPLY = 4,
    parameter CLKIN_DIVIDE_BY_2 = "FALSE",
    parameter real CLKIN_PERIOD = 10.0,
    parameter CLKOUT_PHASE_SHIFT = "NONE",
    parameter CLK_FEEDBACK = "1X",
    parameter DESKEW_ADJUST = "SYSTEM_SYNCHRONOUS",
    parameter DFS_FREQUENCY_MODE = "LOW",
    parameter DLL_FREQUENCY_MODE = "LOW",
    parameter DSS_MODE = "NONE",
    parameter DUTY_CYCLE_CORRECTION = "TRUE",
    parameter FACTORY_JF = 16'hC080,
    parameter integer PHASE_SHIFT = 0,
    parameter STARTUP_WAIT = "FALSE"
) (
    input CLKFB, CLKIN, DSSEN, PSCLK, PSEN, PSINCDEC, RST,
    output CLK0, CLK180, CLK270, CLK2X, CLK2X180, CLK90, CLKDV, CLKFX, CLKFX180, LOCKED, PSDONE,
    output [7:0] STATUS
);
    carrystep_synthesiser #(.MULTIPLY(CLKFX_MULTIPLY), .DIVIDE(CLKFX_DIVIDE)) synthesiser (
        .reference(CLKIN), .reset(RST !== 1'b0 || glbl.GSR), .out(CLKFX), .locked(LOCKED)
    );
    assign CLKFX180 = !CLKFX;

    initial begin
        if (CLKFX_MULTIPLY < 2 || CLKFX_MULTIPLY > 32)
            $display("Error: CLKFX_MULTIPLY is %0d", CLKFX_MULTIPLY);
        if (CLKFX_DIVIDE < 1 || CLKFX_DIVIDE > 32)
            $display("Error: CLKFX_DIVIDE is %0d", CLKFX_DIVIDE);
        if (CLK_FEEDBACK != "NONE" && CLK_FEEDBACK != "1X" && CLK_FEEDBACK != "2X")
            $display("Error: CLK_FEEDBACK is %s", CLK_FEEDBACK);
        if (DFS_FREQUENCY_MODE != "LOW" && DFS_FREQUENCY_MODE != "HIGH")
            $display("Error: DFS_FREQUENCY_MODE is %s", DFS_FREQUENCY_MODE);
    end
    always @(posedge LOCKED)
        if (synthesiser.period > 1010.0 * CLKIN_PERIOD || synthesiser.period < 990.0 * CLKIN_PERIOD)
            $display(
                "Error: CLKIN has %0f ps, CLKIN_PERIOD is %0f ns", synthesiser.period, CLKIN_PERIOD
            );
endmodule

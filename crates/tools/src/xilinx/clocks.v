// Simulation models of the clock cells of Spartan FPGAs, for which yosys has none. A DCM and an
// MMCM output their reference clock unchanged and are always locked. A BUFGCE samples CE while its
// input clock is low.

module DCM #(
    parameter CLKFX_MULTIPLY = 4, CLKFX_DIVIDE = 1, CLKIN_PERIOD = 0, CLK_FEEDBACK = "1X", DFS_FREQUENCY_MODE = "LOW"
) (
    input CLKIN, CLKFB, RST, DSSEN, PSCLK, PSEN, PSINCDEC,
    output CLKFX, LOCKED
);
    assign CLKFX = CLKIN;
    assign LOCKED = 1'b1;
endmodule

module DCM_SP #(
    parameter CLKFX_MULTIPLY = 4, CLKFX_DIVIDE = 1, CLKIN_PERIOD = 0, CLK_FEEDBACK = "1X", DFS_FREQUENCY_MODE = "LOW"
) (
    input CLKIN, CLKFB, RST, DSSEN, PSCLK, PSEN, PSINCDEC,
    output CLKFX, LOCKED
);
    assign CLKFX = CLKIN;
    assign LOCKED = 1'b1;
endmodule

module MMCME2_BASE #(
    parameter CLKIN1_PERIOD = 0, DIVCLK_DIVIDE = 1, CLKFBOUT_MULT_F = 0, CLKOUT0_DIVIDE_F = 0
) (
    input CLKIN1, CLKFBIN, PWRDWN, RST,
    output CLKFBOUT, CLKOUT0, LOCKED
);
    assign CLKFBOUT = CLKFBIN;
    assign CLKOUT0 = CLKIN1;
    assign LOCKED = 1'b1;
endmodule

module BUFGCE (
    input I, CE,
    output O
);
    reg enabled = 1'b0;
    always @(I or CE) if (!I) enabled <= CE;
    assign O = I & enabled;
endmodule

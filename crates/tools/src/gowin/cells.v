// Simulation models of the clock cells of a Gowin part, for which yosys has none with a function.

// The PLL outputs its reference clock unchanged and is always locked.
module rPLL #(
    parameter FCLKIN = "27", DEVICE = "", IDIV_SEL = 0, FBDIV_SEL = 0, ODIV_SEL = 8,
    parameter DYN_IDIV_SEL = "false", DYN_FBDIV_SEL = "false", DYN_ODIV_SEL = "false",
    parameter PSDA_SEL = "0000", DYN_DA_EN = "false", DUTYDA_SEL = "1000",
    parameter CLKFB_SEL = "internal", CLKOUT_BYPASS = "false", CLKOUTP_BYPASS = "false",
    parameter CLKOUTD_BYPASS = "false", DYN_SDIV_SEL = 2, CLKOUTD_SRC = "CLKOUT",
    parameter CLKOUTD3_SRC = "CLKOUT"
) (
    input CLKIN, CLKFB, RESET, RESET_P,
    input [5:0] FBDSEL, IDSEL, ODSEL,
    input [3:0] PSDA, DUTYDA, FDLY,
    output CLKOUT, LOCK
);
    assign CLKOUT = CLKIN;
    assign LOCK = 1'b1;
endmodule

// A clock gate that samples its enable while its input clock is low.
module DQCE (
    input CLKIN, CE,
    output CLKOUT
);
    reg enabled = 1'b0;
    always @(CLKIN or CE) if (!CLKIN) enabled <= CE;
    assign CLKOUT = CLKIN & enabled;
endmodule


//! The PLL of an iCE40 in simulations of whole boards: it passes its reference clock on and is
//! locked from the start.

use carrystep_tools::ice40;

const PLL: &str = "
module bench_pll #(
    parameter FEEDBACK_PATH = 0, DELAY_ADJUSTMENT_MODE_FEEDBACK = 0,
    parameter DELAY_ADJUSTMENT_MODE_RELATIVE = 0, PLLOUT_SELECT = 0,
    parameter SHIFTREG_DIV_MODE = 0, FDA_FEEDBACK = 0, FDA_RELATIVE = 0,
    parameter DIVR = 0, DIVF = 0, DIVQ = 0, FILTER_RANGE = 0,
    parameter ENABLE_ICEGATE = 0, TEST_MODE = 0
) (
    input REFERENCECLK, EXTFEEDBACK, BYPASS, RESETB, LATCHINPUTVALUE, SDI, SCLK,
    input [7:0] DYNAMICDELAY,
    output PLLOUTCORE, PLLOUTGLOBAL, LOCK, SDO
);
    assign PLLOUTCORE = REFERENCECLK;
    assign PLLOUTGLOBAL = REFERENCECLK;
    assign LOCK = 1'b1;
endmodule
";

/// The Verilog of an iCE40 with yosys' models of its cells and the bench's PLL, whose reference
/// comes from a pad or from a wire.
///
/// # Panics If a cell has no model.
pub fn with_bench_pll(verilog: &str) -> String {
    let verilog =
        verilog.replace("SB_PLL40_CORE", "bench_pll").replace("SB_PLL40_PAD", "bench_pll");
    let pll = if verilog.contains(".PACKAGEPIN(") {
        PLL.replace("REFERENCECLK", "PACKAGEPIN")
    } else {
        PLL.to_owned()
    };
    ice40::simulated(&verilog).expect("models of its cells") + &pll
}

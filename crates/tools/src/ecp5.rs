//! ECP5: yosys, nextpnr-ecp5 and ecppack.

mod models;

pub use models::simulated;

use crate::flow::Flow;
use crate::tool::{ECPPACK, NEXTPNR_ECP5, YOSYS};
use carrystep_boards::Mapped;

/// The tools of the family.
pub static FLOW: Flow = Flow {
    yosys: &YOSYS,
    synth: "synth_ecp5",
    count,
    nextpnr: &NEXTPNR_ECP5,
    constraints: "core.lpf",
    options: &["--lpf", "core.lpf", "--textcfg", "placed.config"],
    placed: "placed.config",
    counts: ["TRELLIS_COMB:", "DP16KD:"],
    pack: &ECPPACK,
    pack_options: &["--compress", "placed.config", "--bit", "placed.bit"],
    bitstream: "placed.bit",
};

/// There are two LUTs for each cell of a carry chain, and six for each memory in LUTs.
fn count(cells: &mut Mapped, name: &str, number: u32) {
    match name {
        "LUT4" => cells.luts += number,
        "CCU2C" => {
            cells.luts += 2 * number;
            cells.carries += number;
        }
        "TRELLIS_DPR16X4" => cells.luts += 6 * number,
        "TRELLIS_FF" => cells.flip_flops += number,
        "DP16KD" => cells.block_rams += number,
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::FLOW;

    #[test]
    fn luts_are_counted_as_nextpnr_counts_them() {
        let stat = "   Number of cells:               2494\n     CCU2C                         105\n     \
                    DP16KD                          8\n     LUT4                         1418\n     \
                    PFUMX                         234\n     \
                    TRELLIS_DPR16X4                96\n     TRELLIS_FF                    569\n";
        let found = FLOW.counted(stat).expect("cells");
        assert_eq!((found.luts, found.flip_flops), (2204, 569), "2204 LUT4s according to its log");
        assert_eq!((found.carries, found.block_rams), (105, 8));
        assert!(FLOW.counted("").is_err());
    }
}

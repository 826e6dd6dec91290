//! Gowin: yosys of PyPI, nextpnr-himbaechel-gowin and gowin_pack.

mod models;

pub use models::simulated;

use crate::flow::Flow;
use crate::tool::{GOWIN_PACK, NEXTPNR_GOWIN, YOSYS_OF_PIP};
use carrystep_boards::Mapped;

/// The tools of the family.
pub static FLOW: Flow = Flow {
    yosys: &YOSYS_OF_PIP,
    synth: "synth_gowin",
    count,
    nextpnr: &NEXTPNR_GOWIN,
    constraints: "core.cst",
    options: &["--vopt", "cst=core.cst", "--router", "router2", "--write", "placed.json"],
    placed: "placed.json",
    counts: [" LUT4:", " BSRAM:"],
    pack: &GOWIN_PACK,
    pack_options: &["-d", "DIE", "-o", "placed.fs", "placed.json"],
    bitstream: "placed.fs",
};

/// There is one LUT for each bit of a carry chain.
fn count(cells: &mut Mapped, name: &str, number: u32) {
    match name {
        "LUT1" | "LUT2" | "LUT3" | "LUT4" => cells.luts += number,
        "ALU" => {
            cells.luts += number;
            cells.carries += number;
        }
        _ if name.starts_with("DFF") => cells.flip_flops += number,
        "DPB" | "DPX9B" | "SDPB" | "SDPX9B" | "SP" | "SPX9" => cells.block_rams += number,
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::FLOW;

    #[test]
    fn luts_are_counted_as_nextpnr_counts_them() {
        let stat = "     2513 cells\n      279   ALU\n      164   DFF\n      211   DFFE\n        1   DPB\n        \
                    6   DPX9B\n      122   LUT1\n      200   LUT2\n      431   LUT3\n      563   LUT4\n      \
                    229   MUX2_LUT5\n        6   SDPX9B\n        2   SPX9\n";
        let found = FLOW.counted(stat).expect("cells");
        assert_eq!((found.luts, found.flip_flops), (1595, 375));
        assert_eq!((found.carries, found.block_rams), (279, 15));
        assert!(FLOW.counted("").is_err());
    }
}

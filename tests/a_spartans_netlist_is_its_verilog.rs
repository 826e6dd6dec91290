//! A whole Spartan board, clocked from its pins: bytes into the UART, pulses out. Its Verilog, and the cells that yosys makes of it, in
//! the EDIF that the shipped build script hands to ISE, read back, show on every pin in every cycle what link and engine show in
//! Rust-HDL. Cells are yosys' models; DCM and MMCM are one model of the bench at both stages, and block RAMs are models of ours.
//!
//! A test run does it for a Spartan-6, `cargo xtask long equivalence` for every family.

use carrystep_spec::board::{Toolchain, board};
use carrystep_synthesis::xilinx;
use carrystep_tests::board_session::Session;
use carrystep_tests::{effort, mutants};

/// One board of each family, Spartan-3, 3E, 6 and 7.
const BOARDS: [&str; 4] = ["s3board", "nexys2", "papilio-pro", "arty-s7"];

/// The EDIF with one bit of the link's first instruction flipped.
fn with_a_flipped_bit(edif: &str) -> String {
    let program = edif.find("\"link.machine.program.words.0.0\"").expect("the program");
    let begin = program + edif[program..].find("(property INIT_00 (string \"").expect("its first words");
    let at = begin + edif[begin..].find("\"))").expect("the last digit") - 1;
    let digit = u8::from_str_radix(&edif[at..=at], 16).expect("a digit");
    format!("{}{:x}{}", &edif[..at], digit ^ 1, &edif[at + 1..])
}

fn from_verilog_to_edif(name: &str) {
    let board = board(name).expect("a board");
    let session = Session::of(board);
    let compare = |verilog: &str| session.difference(&xilinx::simulated(verilog).expect("models of its cells"));
    assert_eq!(compare(&session.verilog), None, "{name}: the Verilog");

    let (family, top) = (board.family.yosys().expect("a Spartan"), session.gateware.top());
    if board.family.toolchain() == Toolchain::Ise {
        let script = xilinx::script_for_ise(family, &top);
        assert!(session.file("build.sh").contains(&script), "{name}: the build script does not say {script}");
    }
    let written = xilinx::to_edif(&session.verilog, &top, family).expect("EDIF");
    assert_eq!(compare(&xilinx::from_edif(&written).expect("EDIF")), None, "{name}: the EDIF");
    let flipped = xilinx::from_edif(&with_a_flipped_bit(&written)).expect("EDIF");
    assert!(compare(&flipped).is_some(), "{name}: a flipped bit of a block RAM is not seen");
    if effort::is_every_board() {
        for (fault, verilog) in session.crossed() {
            let crossed = xilinx::to_edif(&verilog, &top, family).expect("EDIF");
            let crossed = xilinx::from_edif(&crossed).expect("EDIF");
            assert!(compare(&crossed).is_some(), "{name}: {fault} is not seen");
        }
    }
    effort::say(&format!("{name}: {} cycles on every pin", session.cycles()));
}

#[test]
fn from_bytes_to_pulses() {
    if !effort::is_every_board() {
        return from_verilog_to_edif("papilio-pro");
    }
    mutants::each(&BOARDS, |name| from_verilog_to_edif(name));
    effort::figures(
        "a board of each of 4 Spartan families from Verilog to the EDIF of its cells, two crossed wires and a flipped bit seen on each",
    );
}

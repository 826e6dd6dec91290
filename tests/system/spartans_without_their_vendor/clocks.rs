//! The clock modules of Spartan boards, on small models of the cells.

use carrystep_boards::board;
use carrystep_tests::effort;
use carrystep_tools::clock_modules::{
    CellModels, ClockFault, ClockFigures, NoModels, clock_module, simulated, spartans,
};
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of the models, as a person names one of the vendor's.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("system/spartans_without_their_vendor/models")
}

fn on(board_name: &str, module: &str, folder: &Path) -> Result<ClockFigures, ClockFault> {
    let models = CellModels::in_folder(folder).unwrap_or_else(|error| panic!("{error}"));
    let board = board(board_name).expect("a board");
    simulated(board, module, &models).unwrap_or_else(|error| panic!("{error}"))
}

fn module(board_name: &str) -> String {
    clock_module(board(board_name).expect("a board")).expect("a clock module")
}

#[test]
fn clock_of_every_spartan_is_right_from_its_first_edge() {
    let mut boards = 0;
    for board in spartans() {
        let (name, wanted_hz) = (&board.name, board.clocks[0].clock_hz);
        let found =
            on(name, &module(name), &folder()).unwrap_or_else(|fault| panic!("{name}: {fault}"));
        // Our models are exact, so that only the rounding of the oscillator to 1 ps is left.
        assert!((found.hz / wanted_hz as f64 - 1.0).abs() < 20e-6, "{name}: {found}");
        effort::say(&format!("{name}: {found}"));
        boards += 1;
    }
    assert_eq!(boards, 7);
}

/// The fault of a module with one thing changed.
fn fault(board_name: &str, what: &str, other: &str) -> ClockFault {
    let text = module(board_name);
    let changed = text.replace(what, other);
    assert_ne!(changed, text, "{board_name}: {what} is not there");
    on(board_name, &changed, &folder()).expect_err(other)
}

#[test]
fn faults_of_a_clock_module_are_seen() {
    let dcm = "papilio-one";
    let found = fault(dcm, ".CLKFX_MULTIPLY(5)", ".CLKFX_MULTIPLY(6)");
    assert!(
        matches!(found, ClockFault::Frequency { hz, .. } if (hz - 48e6).abs() < 1e5),
        "{found}"
    );
    let found = fault(dcm, ".CE(waited[10])", ".CE(1'b1)");
    assert!(matches!(found, ClockFault::Early { clocks: 0, .. }), "{found}");
    let found = fault(dcm, ".CE(waited[10])", ".CE(waited[9])");
    assert!(matches!(found, ClockFault::Early { clocks: 500..520, .. }), "{found}");
    let found = fault(dcm, "reg [10:0] waited = 11'd0", "reg [10:0] waited");
    assert!(matches!(found, ClockFault::Unknown { level: 'x', .. }), "{found}");
    // Each of these would be a setting that the tools of the vendor drop or refuse.
    for (board, what, other, says) in [
        (dcm, ".CLKFX_MULTIPLY(", ".CLKFX_MULTIPLIER(", "CLKFX_MULTIPLIER not found"),
        (dcm, ".CLKIN_PERIOD(31.250)", ".CLKIN_PERIOD(20.0)", "CLKIN_PERIOD is 20"),
        (dcm, ".CLKFX_DIVIDE(4)", ".CLKFX_DIVIDE(40)", "CLKFX_DIVIDE is 40"),
        (dcm, ".CLKFX(synthesised)", ".CLKFXX(synthesised)", "CLKFXX"),
        ("s3board", "\"NONE\"", "\"none\"", "CLK_FEEDBACK is none"),
        ("arty-s7", ".CLKFBOUT_MULT_F(60.0)", ".CLKFBOUT_MULT_F(30.0)", "the VCO has 360"),
        ("arty-s7", ".CLKIN1(pad)", ".CLKIN(pad)", "CLKIN"),
    ] {
        let found = fault(board, what, other);
        let ClockFault::Complaint { line } = &found else { panic!("{board}, {other}: {found}") };
        assert!(line.contains(says), "{board}, {other}: {line}");
    }
    // Without feedback an MMCM does not lock.
    let found = fault("arty-s7", ".CLKFBIN(feedback)", ".CLKFBIN(1'b0)");
    assert_eq!(found, ClockFault::TooFew { edges: 0 });
}

#[test]
fn faults_of_the_cells_are_seen() {
    let copy = tempfile::tempdir().expect("a folder");
    let src = copy.path().join("verilog/src");
    let cells = src.join("unisims");
    fs::create_dir_all(&cells).expect("a folder");
    assert_eq!(
        CellModels::in_folder(copy.path()).err(),
        Some(NoModels { folder: copy.path().to_owned() })
    );
    fs::copy(folder().join("glbl.v"), src.join("glbl.v")).expect("a copy");
    for cell in fs::read_dir(folder().join("unisims")).expect("models").flatten() {
        fs::copy(cell.path(), cells.join(cell.file_name())).expect("a copy");
    }
    let name = "papilio-one";
    // A folder like that of the vendor's repository, in which there is no IBUFG.
    assert!(!cells.join("IBUFG.v").exists());
    let right = on(name, &module(name), copy.path());
    assert!(right.is_ok(), "{right:?}");
    let planted = |cell: &str, text: &str| {
        let path = cells.join(format!("{cell}.v"));
        let before = fs::read_to_string(&path).expect("a model");
        fs::write(&path, text).expect("a model");
        let found = on(name, &module(name), copy.path());
        fs::write(&path, before).expect("a model");
        found.expect_err(cell)
    };
    // A gate that opens in the middle of a pulse.
    let found = planted(
        "BUFGCE",
        "`timescale 1 ps / 1 ps\nmodule BUFGCE (input I, CE, output O);\nreg late = 0;\n\
         always @(CE) late <= #8000 CE;\nassign O = I & late;\nendmodule\n",
    );
    assert!(matches!(found, ClockFault::Short { width_ps: 4000..5000, .. }), "{found}");
    // A clock that is not known before the lock, and that the gate lets through.
    let found = planted(
        "BUFGCE",
        "module BUFGCE (input I, CE, output O);\nassign O = CE ? I : 1'bx;\nendmodule\n",
    );
    assert!(matches!(found, ClockFault::Unknown { level: 'x', .. }), "{found}");
    fs::remove_file(cells.join("DCM_SP.v")).expect("a model");
    assert_eq!(
        on(name, &module(name), copy.path()),
        Err(ClockFault::NoModel { cell: "DCM_SP".to_owned() })
    );
}

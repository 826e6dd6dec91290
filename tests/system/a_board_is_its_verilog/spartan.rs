//! Spartan boards: the Verilog, and the cells that yosys makes of it, read back from the EDIF that
//! the shipped build script hands to ISE. The cells are simulated with yosys' models. At both
//! stages DCM and MMCM are replaced by one model of the bench, and block RAMs by our own models.

use carrystep_boards::{ISE, board};
use carrystep_tests::board_session::Session;
use carrystep_tests::{effort, jobs};
use carrystep_tools::xilinx::ReadTwice;
use carrystep_tools::{kept, xilinx};

/// One board of each family: Spartan-3, 3E, 6 and 7.
const BOARDS: [&str; 4] = ["s3board", "nexys2", "papilio-pro", "arty-s7"];

/// The EDIF with one bit of the link's first instruction flipped.
fn with_a_flipped_bit(edif: &str) -> String {
    let program = edif.find("\"link.processor.instructions.words.0.0\"").expect("the program");
    let begin =
        program + edif[program..].find("(property INIT_00 (string \"").expect("its first words");
    let at = begin + edif[begin..].find("\"))").expect("the last digit") - 1;
    let digit = u8::from_str_radix(&edif[at..=at], 16).expect("a digit");
    format!("{}{:x}{}", &edif[..at], digit ^ 1, &edif[at + 1..])
}

fn from_verilog_to_edif(name: &str) {
    let board = board(name).expect("a board");
    let session = Session::of(board);
    let compare = |verilog: &str| {
        session.difference(&xilinx::simulated(verilog).expect("models of its cells"))
    };
    let (family, top) = (board.family.facts().yosys().expect("a Spartan"), session.gateware.top());
    let edif = |verilog: &str| xilinx::to_edif(verilog, &top, family).expect("EDIF");
    let cells = |edif: &str| xilinx::from_edif(edif).expect("EDIF");

    let written = edif(&session.verilog);
    if board.family.facts().toolchain() == &ISE {
        let script = xilinx::script_for_ise(family, &top);
        assert!(
            session.file("build.sh").contains(&script),
            "{name}: the build script does not say {script}"
        );
    }
    // Here for one board in a test run; `spartans_without_their_vendor` does the same with all.
    let constraints = session.file(board.family.facts().toolchain().constraints_end());
    let compared = ReadTwice::of(&written).expect("spydrnet").against(&constraints);
    assert!(compared.is_ok(), "{name}: {compared:?}");
    assert_eq!(compare(&cells(&written)), None, "{name}: the EDIF");
    if effort::is_every_board() {
        assert_eq!(compare(&session.verilog), None, "{name}: the Verilog");
        let flipped = cells(&with_a_flipped_bit(&written));
        assert!(compare(&flipped).is_some(), "{name}: a flipped bit of a block RAM is not seen");
        for (fault, verilog) in session.crossed() {
            assert!(compare(&cells(&edif(&verilog))).is_some(), "{name}: {fault} is not seen");
        }
    }
    effort::say(&format!("{name}: {} cycles on every pin", session.cycles()));
    kept::say();
}

#[test]
fn spartan_netlists_equal_rust_hdl_on_every_pin() {
    if !effort::is_every_board() {
        return from_verilog_to_edif("papilio-pro");
    }
    jobs::each(&BOARDS, |name| from_verilog_to_edif(name));
    effort::figures(&format!(
        "{} Spartan boards, one of each family, from Verilog to the EDIF of its cells, two crossed wires and a flipped bit seen on each",
        BOARDS.len()
    ));
}

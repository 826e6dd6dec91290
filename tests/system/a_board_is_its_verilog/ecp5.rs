//! ECP5 boards: the Verilog of a whole board, and the netlist that yosys makes of it and nextpnr
//! places. We know no way back from a bitstream to Verilog for this family. At both stages the PLL
//! is a model that passes its reference on, and block RAMs are our own models.

use carrystep_boards::{Board, Family, boards};
use carrystep_tests::board_session::Session;
use carrystep_tests::{effort, jobs};
use carrystep_tools::{ecp5, kept};

/// The netlist with one bit of the link's first instructions flipped.
fn with_a_flipped_bit(netlist: &str) -> String {
    let program = netlist.find("\\link.processor.instructions.words.0.0  (").expect("the program");
    let begin = netlist[..program].rfind(".INITVAL_00(320'h").expect("its first words");
    let at = begin + netlist[begin..].find("),").expect("the last digit") - 1;
    let digit = u8::from_str_radix(&netlist[at..=at], 16).expect("a digit");
    format!("{}{:x}{}", &netlist[..at], digit ^ 1, &netlist[at + 1..])
}

/// The netlist with a wrong truth table in the LUT that drives `enable_n`.
fn with_a_wrong_lut(netlist: &str) -> String {
    let pin = netlist.find(".Z(enable_n)").expect("a LUT at enable_n");
    let begin = netlist[..pin].rfind(".INIT(16'h").expect("its table") + ".INIT(16'h".len();
    let (table, rest) = netlist[begin..].split_at(4);
    let table = u16::from_str_radix(table, 16).expect("four digits");
    format!("{}{:04x}{rest}", &netlist[..begin], !table)
}

fn from_verilog_to_netlist(board: &'static Board) {
    let session = Session::of(board);
    let compare =
        |verilog: &str| session.difference(&ecp5::simulated(verilog).expect("models of its cells"));
    let (name, top) = (&board.name, session.gateware.top());
    let netlist = |verilog: &str| ecp5::synthesise(verilog, &top).expect("a netlist").verilog;
    let made = netlist(&session.verilog);
    assert_eq!(compare(&made), None, "{name}: the netlist");
    if effort::is_every_board() {
        assert_eq!(compare(&session.verilog), None, "{name}: the Verilog");
        let flipped = with_a_flipped_bit(&made);
        assert!(compare(&flipped).is_some(), "{name}: a flipped bit of a block RAM is not seen");
        let wrong = with_a_wrong_lut(&made);
        assert!(compare(&wrong).is_some(), "{name}: a wrong LUT is not seen");
        for (fault, verilog) in session.crossed() {
            assert!(compare(&netlist(&verilog)).is_some(), "{name}: {fault} is not seen");
        }
    }
    effort::say(&format!("{name}: {} cycles on every pin", session.cycles()));
    kept::say();
}

#[test]
fn ecp5_netlists_equal_rust_hdl_on_every_pin() {
    let ecp5s: Vec<_> = boards().iter().filter(|board| board.family == Family::Ecp5).collect();
    if !effort::is_every_board() {
        // A board takes two minutes. `a_self_test_shows_every_pin` compares a netlist of this family
        // in every test run.
        return effort::say("no whole ECP5 board: `cargo xtask long equivalence` compares all");
    }
    jobs::each(&ecp5s, |board| from_verilog_to_netlist(board));
    effort::figures(&format!(
        "{} ECP5 boards from Verilog to the netlist, two crossed wires, a flipped bit and a wrong LUT seen on each",
        ecp5s.len()
    ));
}

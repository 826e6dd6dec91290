//! iCE40 boards: the Verilog of a whole board, and its bitstream read back. At both stages the PLL
//! is that of the bench. The designs contain no other hard blocks except block RAMs.

use carrystep_boards::{Board, Family, board, boards};
use carrystep_tests::board_clock::with_bench_pll as simulated;
use carrystep_tests::board_session::Session;
use carrystep_tests::{effort, jobs};
use carrystep_tools::ice40::{self, NextpnrPart};
use carrystep_tools::kept;

/// The configuration with one bit of the link's first instructions flipped. The link's program
/// fills its block RAM more than any other memory.
fn with_a_flipped_bit(asc: &str) -> String {
    let contents = |tile: &str| {
        tile.split("\n.").next().map_or(0, |rows| {
            rows.matches(|digit: char| digit.is_ascii_hexdigit() && digit != '0').count()
        })
    };
    let tiles = asc.match_indices("\n.ram_data ").map(|(at, _)| at + 1);
    let program =
        tiles.max_by_key(|&at| contents(&asc[at..])).expect("a block RAM with first contents");
    let row = asc[program..].lines().nth(1).expect("its first row");
    let begin = program + asc[program..].find(row).expect("its first row");
    // The first word is the last of its row.
    let at = row.rfind(|digit| digit != '0').expect("a bit that is set");
    let digit = u8::from_str_radix(&row[at..=at], 16).expect("a digit");
    format!("{}{:x}{}", &asc[..begin + at], digit & (digit - 1), &asc[begin + at + 1..])
}

fn from_verilog_to_bitstream(board: &'static Board) {
    let session = Session::of(board);
    let compare = |verilog: &str| session.difference(&simulated(verilog));
    let name = &board.name;
    assert_eq!(compare(&session.verilog), None, "{name}: the Verilog");
    for (fault, verilog) in session.crossed() {
        assert!(compare(&verilog).is_some(), "{name}: {fault} is not seen");
    }

    let part = NextpnrPart { device: &board.parts[0].name, package: &board.parts[0].package };
    let netlist =
        ice40::synthesise(&session.verilog, &session.gateware.top(), &session.gateware.part().name)
            .expect("a netlist");
    let clock_hz = session.gateware.build().timebase.clock_hz();
    let placed =
        netlist.place_on(part, &session.file(".pcf"), clock_hz, 1).expect("a placed design");
    let read_back = |asc: &str| placed.read_back(&netlist, asc).expect("a bitstream");
    assert_eq!(compare(&read_back(&placed.asc)), None, "{name}: the bitstream");
    if effort::is_every_board() {
        let flipped = read_back(&with_a_flipped_bit(&placed.asc));
        assert!(compare(&flipped).is_some(), "{name}: a flipped bit of a block RAM is not seen");
    }
    effort::say(&format!("{name}: {} cycles on every pin", session.cycles()));
    kept::say();
    if effort::is_every_board() && name == "icestick" {
        let longer = Session::with_a_limit(board);
        assert_eq!(
            longer.difference(&simulated(&longer.verilog)),
            None,
            "{name}, a limit: the Verilog"
        );
        assert_eq!(
            longer.difference(&simulated(&read_back(&placed.asc))),
            None,
            "{name}, a limit: the bitstream"
        );
        effort::say(&format!("{name}: {} cycles with a limit and its ramp", longer.cycles()));
    }
}

#[test]
fn ice40_bitstreams_equal_rust_hdl_on_every_pin() {
    let ice40s: Vec<_> = boards().iter().filter(|board| board.family == Family::Ice40).collect();
    if !effort::is_every_board() {
        return from_verilog_to_bitstream(board("icestick").expect("a board"));
    }
    jobs::each(&ice40s, |board| from_verilog_to_bitstream(board));
    effort::figures(&format!(
        "{} iCE40 boards from Verilog to the bitstream, two crossed wires and a flipped bit seen on each",
        ice40s.len()
    ));
}

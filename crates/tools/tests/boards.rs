//! Builds the committed gateware of two boards with the open tools. It must fit and reach its
//! clock, and its figures must be those of the table.
#![allow(clippy::expect_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_boards::{AllMeasured, Family, Measured, board, boards};
use carrystep_tools::board::page::{PAGE, built, least_clock, page, placed};
use carrystep_tools::kept;
use std::io::Write as _;
use std::path::Path;

/// Builds a board and compares the result with its figures.
fn builds(name: &str) {
    let board = board(name).expect("a board");
    let built = built(board).expect("a bitstream");
    assert!(built.reaches(board.clocks[0].clock_hz), "{name}: {} MHz", built.mhz);
    assert!(built.bitstream.len() > 30_000);
    let found = Measured::Placed(placed(board, &built, None));
    kept::say();
    assert_eq!(board.measured(), Some(found), "run `cargo xtask long boards`");
}

#[test]
fn page_shows_the_committed_figures() {
    let all: AllMeasured = boards()
        .iter()
        .map(|board| (board.name.clone(), board.measured().expect("figures")))
        .collect();
    let committed =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(PAGE))
            .expect(PAGE);
    assert!(committed == page(&all), "{PAGE}: run `cargo xtask long boards`");
}

/// The smallest part: an engine of six axes and the link in 1280 logic cells.
#[test]
fn icestick_holds_engine_and_link() {
    builds("icestick");
}

#[test]
fn up5k_holds_engine_and_link() {
    builds("icesugar");
}

/// A long run builds all of them; the command that is named writes their figures.
#[test]
fn gowin_boards_reach_their_clock_with_each_seed() {
    let is_asked = std::env::var_os("CARRYSTEP_BOARDS").is_some();
    let gowins = boards().iter().filter(|board| is_asked && board.family == Family::Gowin);
    let mut said = Vec::new();
    for board in gowins {
        let built = built(board).expect("a bitstream");
        assert!(built.bitstream.len() > 30_000, "{}", board.name);
        let least = least_clock(board).expect("clocks");
        assert!(least.is_some_and(|mhz| mhz * 1e6 >= board.clocks[0].clock_hz as f64));
        let found = Measured::Placed(placed(board, &built, least));
        let known = board.measured();
        assert_eq!(
            known,
            Some(found),
            "run `cargo run --release -p carrystep-tools -- boards {}`",
            board.name
        );
        let mhz = least.unwrap_or_default();
        said.push(format!(
            "{}: {} LUTs, {mhz:.1} MHz or more with five seeds",
            board.name, built.size.logic_cells
        ));
    }
    if is_asked {
        let _ = writeln!(std::io::stderr(), "FIGURES {}", said.join(", "));
    }
}

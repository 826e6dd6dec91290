//! Builds the committed gateware of two boards with the open tools. It must fit and reach its
//! clock, and its figures must be those of the table.
#![allow(clippy::expect_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_boards::{AllMeasured, Measured, board, boards};
use carrystep_tools::board::page::{PAGE, built, page, placed};
use carrystep_tools::kept;
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

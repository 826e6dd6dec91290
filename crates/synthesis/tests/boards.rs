//! The committed gateware of two boards, built by the open tools: it fits, it is in time, and it is as the table says.
#![allow(clippy::expect_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_spec::board::{AllMeasured, Measured, board, boards};
use carrystep_synthesis::board::page::{PAGE, built, page, placed};
use carrystep_synthesis::kept;
use std::path::Path;

/// Holds a board against its figures.
fn builds(name: &str) {
    let board = board(name).expect("a board");
    let built = built(board).expect("a bitstream");
    assert!(built.reaches(board.clocks[0].clock_hz), "{name}: {} MHz", built.mhz);
    assert!(built.bitstream.len() > 30_000);
    let found = Measured::Placed(placed(board, &built));
    kept::say();
    assert_eq!(board.measured(), Some(found), "run `cargo xtask long boards`");
}

#[test]
fn the_page_is_of_these_figures() {
    let all: AllMeasured =
        boards().iter().map(|board| (board.name.clone(), board.measured().expect("figures"))).collect();
    let committed =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(PAGE)).expect(PAGE);
    assert!(committed == page(&all), "{PAGE}: run `cargo xtask long boards`");
}

/// The smallest part: six axes, link and all in 1280 logic cells.
#[test]
fn the_icestick_holds_all_of_it() {
    builds("icestick");
}

#[test]
fn a_up5k_holds_all_of_it() {
    builds("icesugar");
}

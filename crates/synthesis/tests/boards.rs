//! The committed gateware of two boards, built by the open tools: it fits, it is in time, and it is as the table says.
#![allow(clippy::expect_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_spec::board::board;
use carrystep_synthesis::board::page::{PAGE, built, row};
use std::path::Path;

/// Holds a board against its row.
fn builds(name: &str) {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(PAGE)).expect(PAGE);
    let board = board(name).expect("a board");
    let built = built(board).expect("a bitstream");
    assert!(built.reaches(board.clocks[0].clock_hz), "{name}: {} MHz", built.mhz);
    assert!(built.bitstream.len() > 30_000);
    let row = row(board, &built);
    assert!(page.contains(&row), "{PAGE} has not {row}: run `cargo xtask long boards`");
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

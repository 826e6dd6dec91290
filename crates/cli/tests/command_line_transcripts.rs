//! The transcripts of `transcripts/` are documentation, and they are true.
//!
//! `TRYCMD=overwrite cargo test --test command_line_transcripts` writes them anew; what differs from run to
//! run, and the last digits of floats, is then to be elided again as `[..]`.

use std::path::Path;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/transcripts");

#[test]
fn transcripts_are_what_the_command_says() {
    trycmd::TestCases::new()
        .register_bin("carrystep", Path::new(env!("CARGO_BIN_EXE_carrystep")))
        .env("COLUMNS", "100") // help is wrapped to it
        .case(format!("{FOLDER}/*.md"));
}

/// The move file that the first transcript shows is the one that it runs.
#[test]
fn the_first_move_is_shown_as_it_is() {
    let read = |name: &str| std::fs::read_to_string(format!("{FOLDER}/{name}")).expect("a transcript");
    let shown = format!("```toml\n{}```\n", read("first-move.in/move.toml"));
    assert!(read("first-move.md").contains(&shown));
}

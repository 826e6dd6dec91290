//! The transcripts in `transcripts/` are documentation, and this test checks them against the
//! command.
//!
//! `TRYCMD=overwrite cargo test --test command_line_transcripts` rewrites them. Afterwards replace
//! everything that differs from run to run, and the last digits of floats, by `[..]` again.

use std::path::Path;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/transcripts");

#[test]
fn transcripts_equal_the_output_of_the_command() {
    trycmd::TestCases::new()
        .register_bin("carrystep", Path::new(env!("CARGO_BIN_EXE_carrystep")))
        .env("COLUMNS", "100") // The help is wrapped to this width.
        .case(format!("{FOLDER}/*.md"));
}

/// The first transcript must show the move file that it runs.
#[test]
fn first_transcript_shows_the_move_file_that_it_runs() {
    let read =
        |name: &str| std::fs::read_to_string(format!("{FOLDER}/{name}")).expect("a transcript");
    let shown = format!("```toml\n{}```\n", read("first-move.in/move.toml"));
    assert!(read("first-move.md").contains(&shown));
}

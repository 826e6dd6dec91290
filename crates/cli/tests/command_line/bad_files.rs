//! Files that are missing, are not text, or are not of the expected kind.

use crate::command::{Folder, GOOD, edit};
use std::process::Command;

const MOVE: &str = "[[move]]\nprofile = \"ranade\"\nto = { x = 2 }\n";

/// The machine of [`GOOD`] without the moves.
fn machine() -> &'static str {
    &GOOD[..GOOD.find("[[move]]").unwrap()]
}

#[test]
fn move_files_that_are_no_text_are_refused() {
    let folder = Folder::new();
    let every = |name: &str, says: &str| {
        for command in ["plan", "simulate"] {
            folder.run(&format!("{command} {name}")).refuses(says);
        }
        folder.run(&format!("check capture.vcd {name}")).refuses(says);
    };
    every("nowhere.toml", "cannot read nowhere.toml: No such file");
    every(".", "cannot read .: it is a folder, and an input must be a regular file");
    folder.write("empty.toml", "");
    every("empty.toml", "empty.toml:1:1: no machine");
    folder.write("latin.toml", b"[machine]\n# caf\xe9\n");
    every("latin.toml", "latin.toml:2:6: not UTF-8");
    folder.write("noise.toml", b"\x00\x01\x02\x7fELF\x02");
    every("noise.toml", "[noise.toml:1:9]");
    folder.write("escape.toml", "a = \"\u{1b}[31m\"\n");
    every("escape.toml", "[escape.toml:1:6]");
}

#[test]
fn errors_in_a_machine_file_are_reported_with_its_own_path() {
    let folder = Folder::new();
    let refused = |head: &str, column: usize, says: &str| {
        folder.write("move.toml", format!("{head}{MOVE}"));
        folder.run("plan move.toml").refuses_at("move.toml", (1, column), says);
    };
    refused("machine_file = \"nowhere.toml\"\n", 16, "there is no machine file nowhere.toml");
    refused("machine_file = \".\"\n", 16, "cannot read .: it is a folder");
    refused("machine_file = 3\n", 16, "expected path string");
    refused(
        &format!("machine_file = \"m.toml\"\n{}", machine()),
        16,
        "both machine_file and [machine] are given",
    );

    // The path is relative to the move file, and errors in the machine file name that file.
    let (bad, place) = edit(machine(), "speed_limit = 1000", "speed_limit = ^-1");
    folder.write("shop/machines/m.toml", bad);
    folder.write("shop/move.toml", format!("machine_file = \"machines/m.toml\"\n{MOVE}"));
    folder.run("plan shop/move.toml").refuses_at(
        "shop/machines/m.toml",
        place,
        "speed_limit = -1: must be over zero",
    );
    folder.run("verilog --machine shop/machines/m.toml --out out").refuses_at(
        "shop/machines/m.toml",
        place,
        "over zero",
    );
    folder
        .run("verilog --machine shop/move.toml --out out")
        .refuses("unknown field `machine_file`, expected `machine`");
    folder
        .run("verilog --machine nowhere.toml --out out")
        .refuses("cannot read nowhere.toml: No such file");
    assert!(!folder.path("out").exists());
}

#[test]
fn lines_and_columns_count_as_an_editor_does() {
    for (old, new) in [
        ("speed_limit = 1000", "\tspeed_limit = ^-1"),
        ("speed_limit = 1000", "# \u{e9}lan \u{2713}\nspeed_limit = ^-1"),
        ("to = { x = 2 }", "to = { \"\\u0078\" = 2, \"\u{17c}\" = 1, x = ^nan }"),
    ] {
        let (text, place) = edit(GOOD, old, new);
        for text in [text.replace('\n', "\r\n"), text] {
            let ran = Folder::with_move(text).run("plan move.toml");
            assert_eq!(ran.status, 2);
            assert!(ran.stderr.contains(&format!("move.toml:{}:", place.0)), "{}", ran.stderr);
        }
    }
}

#[test]
fn a_missing_tool_is_named_with_the_line_that_installs_it() {
    let folder = Folder::with_move(GOOD);
    for (level, tool) in [("icarus", "iverilog"), ("verilator", "verilator")] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
        let arguments = ["simulate", "move.toml", "--vcd", "a.vcd", "--level", level];
        let ran = folder.output(command.args(arguments).env("PATH", folder.path("no-tools")));
        assert_eq!(ran.status, 3, "{}", ran.stderr);
        assert!(
            ran.stderr.contains(&format!("{tool} is not installed: `sudo apt-get install {tool}")),
            "{}",
            ran.stderr
        );
        assert_eq!(folder.files(), ["move.toml"]);
    }
}

//! The self-tests of boards as Verilog: lint, latches, undriven wires, and constraints that fit the
//! ports.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod common;

use carrystep_boards::{Placer, board, boards};
use carrystep_verilog::{SELF_TEST_NAME, SELF_TEST_WAIVERS, SelfTestGateware, TextFile};
use common::run;
use std::collections::BTreeSet;

/// The board with the fewest pins, one with a gate, and the one with the most pins.
const SOME: [&str; 3] = ["icestick", "mojo-v3", "alchitry-cu"];

fn files(name: &str) -> Vec<TextFile> {
    let board = board(name).unwrap();
    SelfTestGateware::new(board, &board.parts[0], false).unwrap().files().unwrap()
}

fn folder(name: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for file in files(name) {
        std::fs::write(folder.path().join(file.name), file.text).unwrap();
    }
    std::fs::write(folder.path().join("self_test.vlt"), SELF_TEST_WAIVERS).unwrap();
    folder
}

#[test]
fn verilator_lint_reports_no_warning() {
    for name in SOME {
        let folder = folder(name);
        let source = format!("{SELF_TEST_NAME}.v");
        let (ok, said) =
            run("verilator", &["--lint-only", "-Wall", "self_test.vlt", &source], folder.path());
        assert!(ok && said.is_empty(), "{name}: {said}");
    }
}

#[test]
fn yosys_finds_no_latch_and_no_undriven_wire() {
    for name in SOME {
        let folder = folder(name);
        let top = format!("carrystep_{}_selftest", name.replace('-', "_"));
        // The clock module contains cells of the vendor, which this check does not know.
        let script = format!(
            "read_verilog {top}.v {SELF_TEST_NAME}.v; read_verilog -lib carrystep_clock.v; \
             hierarchy -check -top {top}; proc; flatten; opt_clean; check -assert; select -assert-none t:$dlatch"
        );
        let (ok, said) = run("yosys", &["-q", "-p", &script], folder.path());
        // The lines to the host of a board with a gate are held by tri-state buffers, which yosys
        // warns about.
        let warned = |line: &str| line.contains("Warning") && !line.contains("tri-state");
        assert!(ok && !said.lines().any(warned), "{name}: {said}");
    }
}

/// Every port of the top level has a pin, and no pin is assigned without its port.
#[test]
fn constraints_name_exactly_the_ports_of_the_top_level() {
    for board in boards().iter().filter(|board| board.family.facts().placer().is_some()) {
        let files = files(&board.name);
        let text = |end: &str| &files.iter().find(|file| file.name.ends_with(end)).unwrap().text;
        let (_, ports) = text("_selftest.v").split_once(" (\n").unwrap();
        let (ports, _) = ports.split_once("\n);").unwrap();
        let mut declared = BTreeSet::new();
        for line in ports.lines() {
            let line = line.trim().trim_end_matches(',');
            let (_, rest) = line.split_once(" wire ").unwrap();
            match rest.split_once(":0] ") {
                None => _ = declared.insert(rest.to_owned()),
                Some((top, name)) => {
                    let top: usize = top.trim_start_matches('[').parse().unwrap();
                    declared.extend((0..=top).map(|bit| format!("{name}[{bit}]")));
                }
            }
        }
        let is_icestorm = board.family.facts().placer() == Some(Placer::Ice40);
        let constraints = text(board.family.facts().toolchain().constraints_end()).lines();
        let named = constraints.filter_map(|line| {
            if is_icestorm {
                return line.strip_prefix("set_io")?.rsplit(' ').nth(1).map(str::to_owned);
            }
            let placed = ["LOCATE COMP \"", "IO_LOC \""];
            let rest = placed.into_iter().find_map(|start| line.strip_prefix(start))?;
            rest.split('"').next().map(str::to_owned)
        });
        assert_eq!(named.collect::<BTreeSet<_>>(), declared, "{}", board.name);
    }
}

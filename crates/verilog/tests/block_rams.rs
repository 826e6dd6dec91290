//! The block RAMs that a gateware is said to take are those that yosys makes of it, and a part that
//! has fewer is refused.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_boards::{Measured, block_rams, board, boards};
use carrystep_files::SourceText;
use carrystep_verilog::{Gateware, shipped_machine};

/// The figures of `data/measured.toml` are those of yosys.
#[test]
fn block_rams_of_shipped_gateware_are_those_of_yosys() {
    for board in boards() {
        let gateware = Gateware::shipped(board, &board.parts[0]).unwrap();
        let found = block_rams(gateware.build(), board.family);
        let measured = match board.measured().unwrap() {
            Measured::Placed(placed) => placed.block_rams,
            Measured::Mapped(mapped) => mapped.block_rams,
        };
        assert_eq!(found.of_all_kinds, measured, "{}", board.name);
    }
}

/// What is said of a board's shipped machine with these replacements: its error, or nothing.
fn said(name: &str, replaced: &[(&str, &str)]) -> String {
    let board = board(name).unwrap();
    let mut text = shipped_machine(board, &board.clocks[0]).unwrap();
    for (from, to) in replaced {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let machine = SourceText { path: "machine.toml".into(), text: text.into() };
    let made = Gateware::new(board, &board.parts[0], machine);
    made.err().map_or_else(String::new, |error| error.to_string())
}

/// Six adders in ticks of 250 ns at 64 MHz.
const SIX: (&str, &str) = (
    "clock_hz = 80000000\ntick_ns = 1000\nphases = 16",
    "clock_hz = 64000000\ntick_ns = 250\nphases = 4\nadders = 6",
);
const SHALLOW: (&str, &str) = ("queue_depth = 31", "queue_depth = 7");
const NO_LIMITS: (&str, &str) = ("limits = \"each\"", "limits = \"none\"");

#[test]
fn adders_that_do_not_fit_are_refused_with_those_that_do() {
    assert_eq!(said("orangecrab", &[SIX, SHALLOW, NO_LIMITS]), "");
    assert_eq!(
        said("orangecrab", &[SIX, SHALLOW]),
        "orangecrab: engine and link with adders = 6 and queue_depth = 7 take 57 block RAMs, and its \
         lfe5u-25f has 56: adders = 2 in ticks of 750 ns takes 21, a machine without limits and inputs \
         takes 51, its part lfe5u-85f has 208"
    );
    let six = ("tick_ns = 2000\nphases = 16", "phases = 4\nadders = 6");
    assert_eq!(
        said("tang-nano-20k", &[six, SHALLOW]),
        "tang-nano-20k: engine and link with adders = 6 and queue_depth = 7 take 57 block RAMs, and its \
         gw2ar-18c has 46: adders = 2 in ticks of 1000 ns takes 21"
    );
    assert_eq!(
        said("tang-nano-9k", &[six]),
        "tang-nano-9k: engine and link with adders = 6 and queue_depth = 31 take 75 block RAMs, and its \
         gw1nr-9c has 26: adders = 2 in ticks of 1000 ns with queue_depth = 15 takes 23"
    );
}

#[test]
fn queues_that_do_not_fit_are_refused_with_the_depth_that_does() {
    assert_eq!(
        said("icestick", &[("queue_depth = 7", "queue_depth = 15")]),
        "icestick: engine and link with adders = 1 and queue_depth = 15 take 19 block RAMs, and its \
         hx1k has 16: queue_depth = 7 takes 15"
    );
}

#[test]
fn adders_of_a_family_with_one_are_refused() {
    let two = ("tick_ns = 2000", "tick_ns = 2000\nadders = 2");
    assert_eq!(
        said("icestick", &[two]),
        "icestick: an engine in a part of the family iCE40 has one adder, not 2: leave out `adders` in \
         [machine], with a longer tick, or take a board of the family ECP5, Gowin or Spartan-7"
    );
}

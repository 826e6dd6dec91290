//! Proves that each stage equals the preceding one.

use crate::stages;
use carrystep_tests::effort;
use carrystep_tools::equivalence::{self, EquivalenceVerdict};
use carrystep_tools::kept;

#[test]
fn netlist_is_proved_equal_to_the_verilog() {
    let stages = stages::shipped();
    let verdict =
        equivalence::verilog_and_netlist(&stages.verilog, &stages.netlist, &stages.netlist.verilog);
    let verdict = verdict.expect("a verdict");
    effort::say(&format!("Verilog and netlist: {verdict:?}"));
    kept::say();
    assert!(matches!(verdict, EquivalenceVerdict::Proved(pairs) if pairs > 1000), "{verdict:?}");
}

#[test]
fn bitstream_is_proved_equal_to_the_netlist() {
    let stages = stages::shipped();
    let verdict =
        equivalence::netlist_and_bitstream(&stages.netlist, &stages.read_back).expect("a verdict");
    effort::say(&format!("netlist and bitstream: {verdict:?}"));
    kept::say();
    assert!(matches!(verdict, EquivalenceVerdict::Proved(pairs) if pairs > 800), "{verdict:?}");
}

#[test]
fn initial_memory_contents_are_equal_at_all_stages() {
    let stages = stages::shipped();
    let verilog = equivalence::memories_of_verilog(&stages.verilog, carrystep_verilog::ENGINE_NAME)
        .expect("memories");
    let [netlist, bitstream] =
        [&stages.netlist.verilog, &stages.read_back].map(|text| equivalence::memories(text));
    assert_eq!(verilog.len(), 9);
    assert!(verilog.values().all(|memory| memory.len() == 18));
    assert_eq!(verilog, netlist);
    assert_eq!(netlist, bitstream);

    // One digit of one memory is changed.
    let mut planted = stages.netlist.verilog.clone();
    let digit = planted
        .find(".INIT_0(")
        .and_then(|at| Some(at + planted[at..].find("),")?))
        .expect("contents")
        - 1;
    planted.replace_range(digit..=digit, if &planted[digit..=digit] == "1" { "2" } else { "1" });
    assert_ne!(equivalence::memories(&planted), verilog);
}

/// The induction does not cover initial values, so they are checked here.
#[test]
fn every_flip_flop_begins_at_zero() {
    let stages = stages::shipped();
    let registers: Vec<&str> =
        stages.read_back.lines().filter(|line| line.starts_with("reg ")).collect();
    assert_eq!(registers.len(), stages.netlist.verilog.matches("\n  SB_DFF").count());
    assert!(registers.iter().all(|line| line.ends_with("= 0;")), "{registers:?}");
}

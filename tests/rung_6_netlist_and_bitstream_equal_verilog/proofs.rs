//! Each stage is proved to be the one before it.

use crate::stages;
use carrystep_synthesis::equivalence::{self, Verdict};
use carrystep_synthesis::kept;
use carrystep_tests::effort;

#[test]
fn the_netlist_is_proved_to_be_the_verilog() {
    let stages = stages::shipped();
    let verdict = equivalence::verilog_and_netlist(&stages.verilog, &stages.netlist, &stages.netlist.verilog);
    let verdict = verdict.expect("a verdict");
    effort::say(&format!("Verilog and netlist: {verdict:?}"));
    kept::say();
    assert!(matches!(verdict, Verdict::Proved(pairs) if pairs > 1000), "{verdict:?}");
}

#[test]
fn the_bitstream_is_proved_to_be_the_netlist() {
    let stages = stages::shipped();
    let verdict = equivalence::netlist_and_bitstream(&stages.netlist, &stages.read_back).expect("a verdict");
    effort::say(&format!("netlist and bitstream: {verdict:?}"));
    kept::say();
    assert!(matches!(verdict, Verdict::Proved(pairs) if pairs > 800), "{verdict:?}");
}

#[test]
fn the_memories_begin_as_they_should() {
    let stages = stages::shipped();
    let verilog = equivalence::memories_of_verilog(&stages.verilog, carrystep_export::ENGINE_NAME).expect("memories");
    let [netlist, bitstream] = [&stages.netlist.verilog, &stages.read_back].map(|text| equivalence::memories(text));
    assert_eq!(verilog.len(), 8);
    assert!(verilog.values().all(|memory| memory.len() == 18));
    assert_eq!(verilog, netlist);
    assert_eq!(netlist, bitstream);

    // One digit of one memory.
    let mut planted = stages.netlist.verilog.clone();
    let digit = planted.find(".INIT_0(").and_then(|at| Some(at + planted[at..].find("),")?)).expect("contents") - 1;
    planted.replace_range(digit..=digit, if &planted[digit..=digit] == "1" { "2" } else { "1" });
    assert_ne!(equivalence::memories(&planted), verilog);
}

/// The induction knows nothing of beginnings.
#[test]
fn every_flip_flop_begins_at_zero() {
    let stages = stages::shipped();
    let registers: Vec<&str> = stages.read_back.lines().filter(|line| line.starts_with("reg ")).collect();
    assert_eq!(registers.len(), stages.netlist.verilog.matches("\n  SB_DFF").count());
    assert!(registers.iter().all(|line| line.ends_with("= 0;")), "{registers:?}");
}

//! What goes wrong in a netlist or a bitstream is caught.

use crate::stages::{self, Stages};
use carrystep_levels::Level;
use carrystep_levels::engine::replay::{self, Recording};
use carrystep_spec::{Command, Segment};
use carrystep_synthesis::equivalence::{self, Verdict};
use carrystep_synthesis::{SynthesisError, ice40};
use carrystep_tests::effort;

/// The text with the first `from` after `place` changed.
fn planted(text: &str, place: &str, from: &str, to: &str) -> String {
    let at = text.find(place).unwrap_or_else(|| panic!("no {place}"));
    assert!(text[at..].contains(from), "no {from}");
    text[..at].to_owned() + &text[at..].replacen(from, to, 1)
}

#[test]
fn faults_in_the_netlist_are_caught() {
    let stages = stages::shipped();
    let netlist = &stages.netlist.verilog;
    // The LUT of an adder's bit, and one that feeds a flip-flop of the guard.
    let lut = ") \\adder.r_SB_DFFSR_Q_10_D_SB_LUT4_O  (";
    let begin = netlist[..netlist.find(lut).expect("an adder's bit")].rfind("16'h").expect("its function");
    let function = u16::from_str_radix(&netlist[begin + 4..begin + 8], 16).expect("a number");
    let changed = format!("{}{:04x}{}", &netlist[..begin + 4], function ^ 0x0100, &netlist[begin + 8..]);
    let swapped = planted(&planted(netlist, lut, ".I1(", ".I0_("), lut, ".I2(", ".I1(").replacen(".I0_(", ".I2(", 1);
    let other_clock_enable = planted(netlist, "SB_DFFE \\adder.a_SB_DFFE_Q  (", ".E(", ".E(!");
    for (fault, text) in [("a LUT's bit", changed), ("two wires swapped", swapped), ("an enable", other_clock_enable)] {
        assert_ne!(text, *netlist);
        let verdict = equivalence::verilog_and_netlist(&stages.verilog, &stages.netlist, &text).expect("a verdict");
        assert!(matches!(verdict, Verdict::Open(..)), "nobody catches {fault}: {verdict:?}");
    }
}

/// A bit of a tile, flipped.
fn flipped(asc: &str, tile: &str, row: usize, column: usize) -> String {
    let mut lines: Vec<String> = asc.lines().map(str::to_owned).collect();
    let at = lines.iter().position(|line| line == tile).unwrap_or_else(|| panic!("no {tile}")) + 1 + row;
    let bit = if &lines[at][column..=column] == "1" { "0" } else { "1" };
    lines[at].replace_range(column..=column, bit);
    lines.join("\n") + "\n"
}

/// Whether proof or comparison sees that a bitstream is another.
fn is_caught(stages: &Stages, asc: &str) -> bool {
    let read_back = stages.placed.read_back(&stages.netlist, asc);
    let verdict = read_back.and_then(|text| {
        let same_memories = equivalence::memories(&stages.netlist.verilog) == equivalence::memories(&text);
        equivalence::netlist_and_bitstream(&stages.netlist, &text).map(|verdict| (verdict, same_memories))
    });
    match verdict {
        Ok((Verdict::Proved(_), same_memories)) => !same_memories,
        // What cannot be read or has a loop is no engine.
        Ok((Verdict::Open(..), _)) | Err(SynthesisError::Tool { .. } | SynthesisError::Unread { .. }) => true,
        Err(error) => panic!("{error}"),
    }
}

/// Bits that are set in logic tiles: tile, row, column. Each is there for a reason.
fn set_bits(asc: &str) -> Vec<(&str, usize, usize)> {
    let (mut tile, mut row) = ("", 0);
    let mut bits = Vec::new();
    for line in asc.lines() {
        if line.starts_with('.') {
            (tile, row) = (line, 0);
        } else if tile.starts_with(".logic_tile") {
            bits.extend(line.bytes().enumerate().filter(|(_, bit)| *bit == b'1').map(|(column, _)| (tile, row, column)));
            row += 1;
        }
    }
    bits
}

#[test]
fn flipped_bits_in_the_bitstream_are_caught() {
    let stages = stages::shipped();
    let asc = &stages.placed.asc;
    let bits = set_bits(asc);
    let count = if effort::is_long() { 60 } else { 3 };
    let mut seen = 0;
    for place in (0..count).map(|i| i * bits.len() / count + 101) {
        let (tile, row, column) = bits[place % bits.len()];
        let caught = is_caught(stages, &flipped(asc, tile, row, column));
        effort::say(&format!("{tile} row {row} column {column}: {}", if caught { "caught" } else { "no change" }));
        seen += usize::from(caught);
    }
    // A LUT may have bits for inputs that never come together, or that stand for one wire.
    assert!(seen * 10 >= count * 8, "{seen} of {count} flipped bits are seen");
}

#[test]
fn a_flipped_bit_of_a_memory_is_caught_on_the_bench() {
    let stages = stages::shipped();
    let asc = &stages.placed.asc;
    let tile = asc.lines().find(|line| line.starts_with(".ram_data")).expect("contents of a memory");
    // Some memory holds where P starts and the stop accelerations: any set bit of them will do.
    let (tile, row, column) = memory_bits(asc).next().unwrap_or((tile, 0, 0));
    let read_back = stages.placed.read_back(&stages.netlist, &flipped(asc, tile, row, column)).expect("a bitstream");
    assert_ne!(equivalence::memories(&read_back), equivalence::memories(&stages.netlist.verilog));

    // Every axis is asked for all that it keeps, and stopped by its ramp both ways.
    let segment = |axis: u8| Segment { ticks: 400, v: if axis.is_multiple_of(2) { 1 << 60 } else { -1 << 60 }, a: 0, j: 0, last: false };
    let mut program: Vec<Command> = (0..6).map(|axis| Command::Segment { axis, segment: segment(axis) }).collect();
    program.extend([Command::Start { mask: 0x3f }, Command::Wait { clocks: 200_000 }, Command::Clear]);
    let recording = Recording::new(&stages.build, &program, &Vec::new(), 600_000);
    let difference = |text: &str| {
        let text = ice40::simulated(text).expect("models of its memories");
        replay::difference(Level::Verilator, &text, &recording).expect("the tools")
    };
    assert_eq!(difference(&stages.read_back), None);
    assert!(difference(&read_back).is_some(), "the bench does not see {tile} row {row} column {column}");
}

fn memory_bits(asc: &str) -> impl Iterator<Item = (&str, usize, usize)> {
    let (mut tile, mut row) = ("", 0);
    asc.lines().filter_map(move |line| {
        if line.starts_with('.') {
            (tile, row) = (line, 0);
            return None;
        }
        row += 1;
        // Hexadecimal: a digit that is 1 becomes 0.
        let column = line.find('1').filter(|_| tile.starts_with(".ram_data"))?;
        Some((tile, row - 1, column))
    })
}

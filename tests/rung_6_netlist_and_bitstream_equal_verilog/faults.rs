//! Faults planted in the netlist or in the bitstream must be caught.

use crate::stages::{self, Stages};
use carrystep_core::{Command, Segment};
use carrystep_simulators::Level;
use carrystep_simulators::engine::replay::{self, Recording};
use carrystep_tests::effort;
use carrystep_tools::equivalence::{self, EquivalenceVerdict};
use carrystep_tools::{SynthesisError, ice40, kept};
use std::ops::Range;

/// The ranges of the text of a netlist that hold cells of a type.
fn cells(netlist: &str, cell: &str) -> Vec<Range<usize>> {
    let name = format!("\n  {cell} ");
    let begins = netlist.match_indices(&name).map(|(begin, _)| begin + 1);
    begins
        .map(|begin| begin..begin + netlist[begin..].find(");\n").expect("the cell's end"))
        .collect()
}

/// The text in the parentheses behind a name.
fn inside<'a>(text: &'a str, name: &str) -> &'a str {
    let begin = text.find(&format!("{name}(")).expect("a name") + name.len() + 1;
    &text[begin..begin + text[begin..].find(')').expect("a bracket")]
}

/// The netlist with one cell changed.
fn changed(netlist: &str, cell: &Range<usize>, change: impl Fn(&str) -> String) -> String {
    let text = change(&netlist[cell.clone()]);
    assert_ne!(text, netlist[cell.clone()]);
    format!("{}{text}{}", &netlist[..cell.start], &netlist[cell.end..])
}

#[test]
fn faults_in_the_netlist_are_caught() {
    let stages = stages::shipped();
    let netlist = &stages.netlist.verilog;
    let (luts, flip_flops) = (cells(netlist, "SB_LUT4"), cells(netlist, "SB_DFFE"));
    let inverted = changed(netlist, &luts[luts.len() / 2], |lut| {
        let function = u16::from_str_radix(&inside(lut, ".LUT_INIT")[4..], 16).expect("a number");
        lut.replace(inside(lut, ".LUT_INIT"), &format!("16'h{:04x}", !function))
    });
    let [one, other] = [&flip_flops[3], &flip_flops[4]];
    let d_of_other = format!(".D({})", inside(&netlist[other.clone()], ".D"));
    let crossed = changed(netlist, one, |cell| {
        cell.replace(&format!(".D({})", inside(cell, ".D")), &d_of_other)
    });
    let disabled = changed(netlist, &flip_flops[40], |cell| cell.replace(".E(", ".E(!"));
    for (fault, text) in [
        ("a LUT inverted", inverted),
        ("a wire crossed", crossed),
        ("an enable inverted", disabled),
    ] {
        let verdict = equivalence::verilog_and_netlist(&stages.verilog, &stages.netlist, &text)
            .expect("a verdict");
        effort::say(&format!("{fault}: {verdict:?}"));
        assert!(
            matches!(verdict, EquivalenceVerdict::Open(..)),
            "nobody catches {fault}: {verdict:?}"
        );
    }
    kept::say();
}

/// The bitstream with one bit of a tile flipped.
fn flipped(asc: &str, tile: &str, row: usize, column: usize) -> String {
    let mut lines: Vec<String> = asc.lines().map(str::to_owned).collect();
    let at = lines
        .iter()
        .position(|line| line.strip_prefix('.') == Some(tile))
        .unwrap_or_else(|| panic!("no {tile}"))
        + 1
        + row;
    let bit = if &lines[at][column..=column] == "0" { "1" } else { "0" };
    lines[at].replace_range(column..=column, bit);
    lines.join("\n") + "\n"
}

/// True if the proof or the comparison detects that the bitstream is wrong.
fn is_caught(stages: &Stages, asc: &str) -> bool {
    let read_back = stages.placed.read_back(&stages.netlist, asc);
    let verdict = read_back.and_then(|text| {
        let same_memories =
            equivalence::memories(&stages.netlist.verilog) == equivalence::memories(&text);
        equivalence::netlist_and_bitstream(&stages.netlist, &text)
            .map(|verdict| (verdict, same_memories))
    });
    match verdict {
        Ok((EquivalenceVerdict::Proved(_), same_memories)) => !same_memories,
        // A bitstream that cannot be read back or contains a loop is detected as wrong.
        Ok((EquivalenceVerdict::Open(..), _))
        | Err(SynthesisError::Tool { .. } | SynthesisError::Unread { .. }) => true,
        Err(error) => panic!("{error}"),
    }
}

/// Tile, row and column of all bits that are not 0 in the tiles of a kind, grouped by tile.
fn set<'a>(asc: &'a str, kind: &str) -> Vec<Vec<(&'a str, usize, usize)>> {
    let mut tiles = Vec::new();
    for part in asc.split("\n.").filter(|part| part.starts_with(kind)) {
        let mut lines = part.lines();
        let tile = lines.next().unwrap_or_default();
        let bits = lines.enumerate().flat_map(|(row, line)| {
            line.bytes()
                .enumerate()
                .filter(|(_, bit)| *bit != b'0')
                .map(move |(column, _)| (tile, row, column))
        });
        tiles.push(bits.collect());
    }
    tiles
}

/// Tiles with at least this number of bits are full of logic, so that nearly every bit has an
/// effect.
const BUSY: usize = 100;

/// The columns of a logic tile that hold the functions of its LUTs and the modes of its flip-flops;
/// the others connect wires. Each LUT has two rows (C. Wolf, Project IceStorm, "Logic tile").
const FUNCTIONS: Range<usize> = 36..46;

/// The column, in the first row of a LUT, of the bit that its function has while all its inputs are
/// 0. Inputs that are not connected are 0, so that every LUT in use has this bit in use, unless its
/// signals are never 0 together. Of the other 15 bits, a LUT of two signals uses 3.
const ALL_ZERO: usize = 40;

/// The bit for inputs that are all 0, of each LUT in use of these tiles.
fn functions<'a>(tiles: &[Vec<(&'a str, usize, usize)>]) -> Vec<(&'a str, usize, usize)> {
    let mut bits: Vec<_> = tiles
        .iter()
        .flatten()
        .filter(|(.., column)| FUNCTIONS.contains(column))
        .map(|&(tile, row, _)| (tile, row / 2 * 2, ALL_ZERO))
        .collect();
    bits.dedup();
    bits
}

/// Flips some of these bits, one at a time, at equal distances. Returns how many are caught.
fn caught_of(stages: &Stages, bits: &[(&str, usize, usize)], count: usize) -> usize {
    let flip = |i: usize| {
        let (tile, row, column) = bits[(2 * i + 1) * bits.len() / (2 * count)];
        let caught = is_caught(stages, &flipped(&stages.placed.asc, tile, row, column));
        let what = if caught { "caught" } else { "no change" };
        effort::say(&format!("{tile} row {row} column {column}: {what}"));
        caught
    };
    (0..count).filter(|&i| flip(i)).count()
}

#[test]
fn flipped_bits_in_the_bitstream_are_caught() {
    let stages = stages::shipped();
    let tiles = set(&stages.placed.asc, "logic_tile");
    let busy: Vec<_> = tiles.into_iter().filter(|bits| bits.len() >= BUSY).collect();
    let is_wire = |(_, _, column): &(&str, usize, usize)| !FUNCTIONS.contains(column);
    let connections: Vec<_> = busy.concat().into_iter().filter(is_wire).collect();
    let count = if effort::is_long() { 30 } else { 2 };
    let seen = caught_of(stages, &connections, count);
    // A few of these bits enable the clock of a column, which the Verilog read back does not show.
    assert!(seen * 10 >= count * 9, "{seen} of {count} flipped connections are caught");
    let count = if effort::is_long() { 30 } else { 4 };
    let seen = caught_of(stages, &functions(&busy), count);
    assert!(seen * 10 >= count * 9, "{seen} of {count} flipped bits of functions are caught");
    kept::say();
}

#[test]
fn a_flipped_bit_of_a_memory_is_caught_on_the_bench() {
    let stages = stages::shipped();
    let asc = &stages.placed.asc;
    // These memory contents are the start values of P and the stop accelerations for both
    // directions, and nothing else.
    let contents: Vec<_> = set(asc, "ram_data").concat();
    let (tile, row, column) = contents[contents.len() / 2];
    let read_back = stages
        .placed
        .read_back(&stages.netlist, &flipped(asc, tile, row, column))
        .expect("a bitstream");
    assert_ne!(equivalence::memories(&read_back), equivalence::memories(&stages.netlist.verilog));

    // The queues run dry, so that every axis ramps down, once from forward and once from backward
    // motion. No clear follows, which would set P to its start value: P is compared at the end, and
    // it depends on every bit of the stop acceleration. The longest ramp takes 6 ms, 480 000
    // clocks.
    let recordings = [1_i64 << 52, -1 << 52].map(|v| {
        let segment = Segment { ticks: 50, v, a: 0, j: 0, last: false };
        let mut program: Vec<_> = (0..6).map(|axis| Command::Segment { axis, segment }).collect();
        program.extend([Command::Start { mask: 0x3f }, Command::Wait { clocks: 600_000 }]);
        Recording::new(&stages.build, &program, &Vec::new(), 2_400_000)
    });
    let is_equal = |text: &str| {
        let text = ice40::simulated(text).expect("models of its memories");
        let mut found =
            recordings.iter().map(|one| replay::difference(Level::Verilator, &text, one));
        found.all(|difference| difference.expect("the tools").is_none())
    };
    let halts = |one: &Recording| one.outputs.last().is_some_and(|(_, last)| last.halted);
    assert!(recordings.iter().all(halts), "the ramps end within the recordings");
    assert!(is_equal(&stages.read_back));
    assert!(!is_equal(&read_back), "the bench does not see {tile} row {row} column {column}");
}

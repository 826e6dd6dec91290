//! A path that goes to and fro within its tolerance: it comes back to the same places any number of
//! times, and each of them must count for its own time only.

use crate::common;
use crate::common::follow::within;
use crate::common::measure::{planned, programmed};
use crate::common::reader;
use crate::common::replay::Replay;

/// Number of moves.
const MOVES: usize = 1600;
/// The line of the first of them.
const FIRST: usize = 3;
/// A row may name a line so far from the one that its time suggests.
const NEAR: usize = 720;

/// The planner once took the first of all equally near places for ever: rows named the first line, and
/// planning each of them looked at all moves so far. Strokes of 0.015 mm are within the tolerance of
/// their middle, so the tool need not move at all. With strokes of 0.1 mm it has to, and is on all
/// strokes at once, because they overlap.
#[test]
fn each_row_names_a_line_of_its_own_time() {
    let machine = common::machine(&reader::file("machine.toml"));
    for stroke in [0.015, 0.04, 0.1] {
        let mut text = "G64 P0.01 F300\nG0 X0 Y0 Z0\n".to_owned();
        for number in 0..MOVES {
            text += &format!("G1 X{}\n", if number % 2 == 0 { stroke } else { 0.0 });
        }
        let items = reader::read(&text);
        let rows = planned(&machine, &items);
        let mut replay = Replay::new(&machine);
        rows.iter().for_each(|row| {
            replay.run(row);
        });
        replay.assert_limits(&machine);
        let path = programmed(&machine, &items);
        assert_eq!(within(&machine, &path, &rows, 1.0, &|motors| motors), Ok(()), "{stroke} mm");
        let lines: Vec<usize> = rows.iter().map(|row| row.line as usize).collect();
        assert!(lines.is_sorted(), "{stroke} mm");
        for (number, line) in lines.iter().enumerate() {
            let even = FIRST + number * MOVES / lines.len();
            assert!(
                line.abs_diff(even) < NEAR,
                "{stroke} mm: row {number} of {} names {line}",
                lines.len()
            );
        }
    }
}

//! A minimal reader of test programs: G0 to G3 with I and J, F, and G64 P, absolute, in mm. It
//! shares nothing with an interpreter of the whole language.

use carrystep_job::{Arc, Element, Item, Tolerance};
use std::f64::consts::TAU;
use std::path::Path;

/// The moves of a program.
pub fn read(text: &str) -> Vec<Item> {
    let (mut at, mut mode, mut feed, mut tolerance) = ([0.0_f64; 3], 0, None, 0.01);
    let mut items = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let code = line.split('(').next().unwrap_or_default();
        let (mut to, mut centre, mut moves) = (at, [at[0], at[1]], false);
        for word in code.split_whitespace() {
            let value: f64 = word[1..].parse().unwrap();
            match &word[..1] {
                "G" if value <= 3.0 => mode = value as u32,
                "X" | "Y" | "Z" => {
                    to[usize::from(word.as_bytes()[0] - b'X')] = value;
                    moves = true;
                }
                "I" => centre[0] += value,
                "J" => centre[1] += value,
                "F" => feed = Some(value / 60.0),
                "P" => tolerance = value,
                _ => {}
            }
        }
        if !moves {
            continue;
        }
        items.push(Item::Move(Element {
            to: to.to_vec(),
            arc: (mode >= 2).then(|| arc(at, to, centre, mode == 3)),
            feed: if mode == 0 { None } else { feed },
            tolerance: Tolerance { linear: tolerance, rotary: tolerance },
            line: number as u64 + 1,
            block: 0,
        }));
        at = to;
    }
    items
}

fn arc(from: [f64; 3], to: [f64; 3], centre: [f64; 2], counterclockwise: bool) -> Arc {
    let direction = |p: [f64; 3]| (p[1] - centre[1]).atan2(p[0] - centre[0]);
    let turn = (direction(to) - direction(from)).rem_euclid(TAU);
    let turn = if turn < 1e-9 { TAU } else { turn };
    let angle = if counterclockwise {
        turn
    } else if turn > TAU - 1e-9 {
        -TAU
    } else {
        turn - TAU
    };
    Arc { plane: [0, 1], centre, angle }
}

/// A file of `sim/jobs/`.
pub fn file(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/jobs");
    std::fs::read_to_string(folder.join(name)).unwrap()
}

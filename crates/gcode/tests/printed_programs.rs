//! Random moves that are printed as a program, in any style, are read back.

use crate::support::{canons, is_apart, point};
use carrystep_gcode::{AXIS_LETTERS, Canon, Pace, Point, Turn};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

/// How a move is written, where the language leaves a choice.
#[derive(Debug, Clone)]
struct Style {
    /// Codes, feeds and coordinates are written also if they are still in effect.
    repeats: bool,
    number: bool,
    comment: bool,
    upper: bool,
    blank: &'static str,
    zeros: bool,
}

fn style() -> impl Strategy<Value = Style> {
    let blank = select(&["", " ", "\t "][..]);
    (any::<[bool; 5]>(), blank).prop_map(|([repeats, number, comment, upper, zeros], blank)| {
        Style { repeats, number, comment, upper, blank, zeros }
    })
}

/// A place, a feed in mm per minute for G1 or `None` for G0, and the style.
fn printed_move() -> impl Strategy<Value = (Point, Option<u32>, Style)> {
    (point(), prop::option::of(1_u32..5000), style())
}

/// Writes moves as a program, and keeps what the interpreter has to give.
#[derive(Default)]
struct Printer {
    text: String,
    expected: Vec<Canon>,
    code: &'static str,
    feed: u32,
    at: Point,
}

impl Printer {
    fn print(&mut self, to: &Point, kind: Option<u32>, style: &Style) {
        let mut line = Vec::new();
        let code = match (kind, style.zeros) {
            (None, false) => "G0",
            (None, true) => "G00",
            (Some(_), false) => "G1",
            (Some(_), true) => "G01",
        };
        if style.repeats || !self.code.ends_with(&code[code.len() - 1..]) {
            line.push(code.to_owned());
        }
        for ((letter, to), at) in AXIS_LETTERS.iter().zip(to).zip(self.at) {
            if style.repeats || *to != at {
                let plus = if style.zeros && *to >= 0.0 { "+0" } else { "" };
                line.push(format!("{letter}{plus}{to:.2}"));
            }
        }
        if let Some(feed) = kind.filter(|&feed| style.repeats || feed != self.feed) {
            line.push(format!("f{feed}"));
            self.feed = feed;
        }
        if style.comment {
            line.insert(line.len() / 2, "(G0 X1)".to_owned());
        }
        if style.number {
            line.insert(0, "n12".to_owned());
        }
        let line = line.join(style.blank);
        self.text += &if style.upper { line.to_uppercase() } else { line };
        self.text += "\n";
        if is_apart(to, &self.at) {
            self.expected.push(match kind {
                None => Canon::Traverse { to: *to },
                Some(feed) => {
                    Canon::Feed { to: *to, pace: Pace::PerSecond(f64::from(feed) / 60.0) }
                }
            });
        }
        (self.at, self.code) = (*to, code);
    }
}

proptest! {
    #[test]
    fn a_printed_program_has_the_moves_that_were_printed(moves in vec(printed_move(), 1..60)) {
        let mut printer = Printer::default();
        for (to, kind, style) in &moves {
            printer.print(to, *kind, style);
        }
        let mut found = canons(&printer.text);
        found.retain(|canon| !matches!(canon, Canon::Comment(_)));
        printer.expected.push(Canon::End);
        prop_assert_eq!(found, printer.expected, "{}", printer.text);
    }

    #[test]
    fn the_order_of_words_their_case_and_blanks_do_not_matter(
        words in Just(vec!["G1", "X1.25", "y-2", "Z+.5", "F600", "G21", "G90", "S1000", "M3", "N7"])
            .prop_shuffle(),
        blanks in vec(select(&["", " ", "\t", " (a) "][..]), 10),
        upper: bool,
    ) {
        let mut words = words;
        words.retain(|word| *word != "N7");
        let words = words.iter().zip(&blanks).map(|(word, blank)| format!("{word}{blank}"));
        let line: String = words.collect();
        let line = if upper { line.to_uppercase() } else { line.to_lowercase() };
        let mut found = canons(&format!("N7{line}\n"));
        found.retain(|canon| !matches!(canon, Canon::Comment(_)));
        let to = [1.25, -2.0, 0.5, 0.0, 0.0, 0.0];
        prop_assert_eq!(&found[1], &Canon::Feed { to, pace: Pace::PerSecond(10.0) });
        let spindle = Canon::Spindle { turn: Turn::Clockwise, rpm: 1000.0 };
        prop_assert_eq!(&found[0], &spindle);
    }
}

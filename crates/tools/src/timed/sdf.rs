//! Reads the delays that nextpnr writes (`--sdf`): paths through cells, set-up and hold times, and
//! wires.

use super::unread;
use crate::SynthesisError;
use std::collections::HashMap;

/// A pin of a cell: the cell's name and the pin's.
pub(super) type Pin = (String, String);

/// Set-up and hold time of an input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Check {
    /// Time before the clock edge during which the input must not change, ps.
    pub setup: u64,
    /// Time after the clock edge during which the input must not change, ps.
    pub hold: u64,
    /// The clock pin.
    pub clock: String,
    /// Whether the edge is the falling one.
    pub falls: bool,
}

/// All delays of a design, ps.
#[derive(Debug, Default)]
pub(super) struct Delays {
    /// From a pin of a cell to another pin of the same cell.
    pub paths: HashMap<(Pin, String), u64>,
    /// The checks of each input.
    pub checks: HashMap<Pin, Check>,
    /// From an output of a cell to an input of a cell.
    pub wires: HashMap<(Pin, Pin), u64>,
}

/// A list in parentheses, or a word.
enum Item {
    Word(String),
    List(Vec<Item>),
}

impl Delays {
    /// Reads the text. Where a delay has several values (minimum, typical, maximum; rising,
    /// falling), the largest is used. nextpnr 0.4 writes the same value everywhere.
    pub(super) fn of(text: &str) -> Result<Self, SynthesisError> {
        let items = items(text)?;
        let [Item::List(file)] = items.as_slice() else {
            return Err(unread("SDF: not one list"));
        };
        let mut delays = Self::default();
        for item in file.iter().skip(1) {
            let Item::List(entry) = item else { return Err(unread("SDF: a word between entries")) };
            match entry.as_slice() {
                [Item::Word(word), Item::Word(unit)] if word == "TIMESCALE" && unit != "1ps" => {
                    return Err(unread(format!("SDF: a time scale of {unit}, not 1ps")));
                }
                [Item::Word(word), cell @ ..] if word == "CELL" => delays.read_cell(cell)?,
                _ => {}
            }
        }
        Ok(delays)
    }

    fn read_cell(&mut self, entries: &[Item]) -> Result<(), SynthesisError> {
        let mut name = String::new();
        for entry in entries {
            match list(entry)? {
                ("INSTANCE", []) => name.clear(),
                ("INSTANCE", [Item::Word(word)]) => name.clone_from(word),
                ("DELAY", kinds) => {
                    for kind in kinds {
                        let ("ABSOLUTE", delays) = list(kind)? else {
                            return Err(unread(format!("SDF: a delay of {name} is not absolute")));
                        };
                        for delay in delays {
                            self.read_delay(&name, delay)?;
                        }
                    }
                }
                ("TIMINGCHECK", checks) => {
                    for check in checks {
                        self.read_check(&name, check)?;
                    }
                }
                ("CELLTYPE", _) => {}
                (other, _) => return Err(unread(format!("SDF: {other} of {name}"))),
            }
        }
        Ok(())
    }

    fn read_delay(&mut self, cell: &str, entry: &Item) -> Result<(), SynthesisError> {
        match list(entry)? {
            ("IOPATH", [Item::Word(from), Item::Word(to), values @ ..]) => {
                let key = ((cell.to_owned(), from.clone()), to.clone());
                let delay = largest(values)?;
                if self.paths.insert(key, delay).is_some() {
                    return Err(unread(format!("SDF: two delays of {cell} from {from} to {to}")));
                }
            }
            ("INTERCONNECT", [Item::Word(from), Item::Word(to), values @ ..]) => {
                let delay = largest(values)?;
                if self.wires.insert((pin(from)?, pin(to)?), delay).is_some() {
                    return Err(unread(format!("SDF: two wires from {from} to {to}")));
                }
            }
            (other, _) => return Err(unread(format!("SDF: {other} of {cell}"))),
        }
        Ok(())
    }

    /// Reads a check. nextpnr writes one for each edge of the input; both must be equal.
    fn read_check(&mut self, cell: &str, entry: &Item) -> Result<(), SynthesisError> {
        let ("SETUPHOLD", [input, clock, setup, hold]) = list(entry)? else {
            return Err(unread(format!("SDF: a check of {cell} is not SETUPHOLD")));
        };
        let (_, input) = edge(input)?;
        let (falls, clock) = edge(clock)?;
        let check = Check {
            setup: largest(std::slice::from_ref(setup))?,
            hold: largest(std::slice::from_ref(hold))?,
            clock: clock.to_owned(),
            falls,
        };
        match self.checks.insert((cell.to_owned(), input.to_owned()), check.clone()) {
            Some(before) if before != check => {
                Err(unread(format!("SDF: two checks of {cell}/{input} that differ")))
            }
            _ => Ok(()),
        }
    }
}

/// The first word of a list, and what follows it.
fn list(item: &Item) -> Result<(&str, &[Item]), SynthesisError> {
    match item {
        Item::List(items) => match items.as_slice() {
            [Item::Word(word), rest @ ..] => Ok((word, rest)),
            _ => Err(unread("SDF: a list without a first word")),
        },
        Item::Word(word) => Err(unread(format!("SDF: the word {word} instead of a list"))),
    }
}

/// Whether an edge falls, and the pin.
fn edge(item: &Item) -> Result<(bool, &str), SynthesisError> {
    match list(item)? {
        ("posedge", [Item::Word(pin)]) => Ok((false, pin)),
        ("negedge", [Item::Word(pin)]) => Ok((true, pin)),
        (other, _) => Err(unread(format!("SDF: the edge {other}"))),
    }
}

/// The pin `CELL/PIN`.
fn pin(name: &str) -> Result<Pin, SynthesisError> {
    let (cell, pin) = name.rsplit_once('/').ok_or_else(|| unread(format!("SDF: no pin {name}")))?;
    Ok((cell.to_owned(), pin.to_owned()))
}

/// The largest of the values `(A:B:C)`, whole ps.
fn largest(values: &[Item]) -> Result<u64, SynthesisError> {
    let mut largest = None;
    for value in values {
        let (numbers, []) = list(value)? else { return Err(unread("SDF: a value of two words")) };
        for number in numbers.split(':') {
            let number: u64 =
                number.parse().map_err(|_| unread(format!("SDF: {number} is no whole ps")))?;
            largest = largest.max(Some(number));
        }
    }
    largest.ok_or_else(|| unread("SDF: a delay without a value"))
}

/// Splits a text into words and lists. A backslash takes the next character into the word.
fn items(text: &str) -> Result<Vec<Item>, SynthesisError> {
    let mut open: Vec<Vec<Item>> = vec![Vec::new()];
    let mut characters = text.chars().peekable();
    let unclosed = || unread("SDF: parentheses do not match");
    while let Some(character) = characters.next() {
        let top = open.last_mut().ok_or_else(unclosed)?;
        match character {
            '(' => open.push(Vec::new()),
            ')' => {
                let list = open.pop().ok_or_else(unclosed)?;
                open.last_mut().ok_or_else(unclosed)?.push(Item::List(list));
            }
            '"' => {
                top.push(Item::Word(characters.by_ref().take_while(|&next| next != '"').collect()));
            }
            space if space.is_whitespace() => {}
            first => {
                let mut word = String::new();
                let mut next = Some(first);
                while let Some(character) = next {
                    word.push(match character {
                        '\\' => characters.next().ok_or_else(unclosed)?,
                        plain => plain,
                    });
                    next = characters
                        .next_if(|&next| !next.is_whitespace() && !matches!(next, '(' | ')' | '"'));
                }
                top.push(Item::Word(word));
            }
        }
    }
    match (open.pop(), open.is_empty()) {
        (Some(items), true) => Ok(items),
        _ => Err(unclosed()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"(DELAYFILE (SDFVERSION "3.0") (TIMESCALE 1ps)
        (CELL (CELLTYPE "top") (INSTANCE ) (DELAY (ABSOLUTE
            (INTERCONNECT \$a\[0\]_LC/O b.c/I0 (1:2:3) (4:5:2)))))
        (CELL (CELLTYPE "ICESTORM_LC") (INSTANCE b.c)
            (DELAY (ABSOLUTE (IOPATH CLK O (540:540:540) (540:540:540))))
            (TIMINGCHECK
                (SETUPHOLD (posedge I0) (negedge CLK) (468:468:468) (7:7:7))
                (SETUPHOLD (negedge I0) (negedge CLK) (468:468:468) (7:7:7)))))"#;

    #[test]
    fn wires_paths_and_checks_are_read() {
        let delays = Delays::of(TEXT).expect("delays");
        let pin = |cell: &str, pin: &str| (cell.to_owned(), pin.to_owned());
        assert_eq!(delays.wires[&(pin("$a[0]_LC", "O"), pin("b.c", "I0"))], 5);
        assert_eq!(delays.paths[&(pin("b.c", "CLK"), "O".to_owned())], 540);
        let check = Check { setup: 468, hold: 7, clock: "CLK".to_owned(), falls: true };
        assert_eq!(delays.checks[&pin("b.c", "I0")], check);
    }

    /// Whatever is cut off or changed, there is an answer, and never a delay that was not written.
    #[test]
    fn damaged_text_is_refused() {
        for end in 0..TEXT.len() {
            assert!(Delays::of(&TEXT[..end]).is_err(), "{end}");
        }
        for (before, after) in [
            ("1ps", "1ns"),
            ("1:2:3", "1:2:x"),
            ("(540:540:540) (540:540:540)", ""),
            ("SETUPHOLD", "WIDTH"),
            ("ABSOLUTE", "INCREMENT"),
            ("(negedge I0) (negedge CLK) (468", "(negedge I0) (negedge CLK) (469"),
            ("b.c/I0", "b.c"),
        ] {
            assert!(Delays::of(&TEXT.replace(before, after)).is_err(), "{before}");
        }
    }
}

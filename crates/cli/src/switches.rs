//! The switches of a virtual board: limits at positions, and whatever its user presses on standard input.
//!
//! ```text
//! estop 1     pressed, 0 released; so `min x 1`, `max x 0`
//! end         ends it, as Ctrl-C does
//! ```

use crate::failure::Failure;
use carrystep_core::engine::Limits;
use carrystep_files::Machine;
use carrystep_virtual_board::Switches;
use std::io::BufRead as _;
use std::sync::mpsc::{Receiver, channel};

/// One end of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Min,
    Max,
}

/// A limit switch at a position.
#[derive(Debug, Clone, Copy)]
struct Limit {
    axis: usize,
    end: End,
    steps: i32,
}

/// All of them.
#[derive(Debug)]
pub struct Panel {
    limits: Vec<Limit>,
    axes: Vec<String>,
    /// Pressed by hand.
    hand: Switches,
    wiring: Limits,
    lines: Receiver<String>,
}

/// What a look at the panel brings.
pub struct Look {
    /// The switches.
    pub switches: Switches,
    /// The user has had enough.
    pub ends: bool,
    /// Lines that mean nothing.
    pub unknown: Vec<String>,
}

impl Panel {
    /// The panel of a machine, with these limits, `AXIS=STEPS`.
    pub fn new(machine: &Machine, min: &[String], max: &[String]) -> Result<Self, Failure> {
        if machine.guard.limits == Limits::None && !(min.is_empty() && max.is_empty()) {
            return Err(Failure::input(
                "--min and --max are limit switches, and the machine has no input for them: [machine.guard] limits is \"none\"",
            ));
        }
        let axes: Vec<String> = machine.axes.iter().map(|axis| axis.name.clone()).collect();
        let mut limits = Vec::new();
        for (end, option, texts) in [(End::Min, "--min", min), (End::Max, "--max", max)] {
            for text in texts {
                let read = text.split_once('=').and_then(|(name, steps)| {
                    let axis = axes.iter().position(|axis| axis == name)?;
                    Some(Limit { axis, end, steps: steps.parse().ok()? })
                });
                let wrong = || {
                    let names = machine.axis_names();
                    Failure::input(format!(
                        "{option} {text}: expected AXIS=STEPS, a whole number, of an axis of {names}"
                    ))
                };
                limits.push(read.ok_or_else(wrong)?);
            }
        }
        Ok(Self { limits, axes, hand: Switches::default(), wiring: machine.guard.limits, lines: lines() })
    }

    /// The switches where the axes are at these positions.
    pub fn look(&mut self, position: impl Fn(usize) -> i32) -> Look {
        let (mut ends, mut unknown) = (false, Vec::new());
        while let Ok(line) = self.lines.try_recv() {
            match line.trim() {
                "" => {}
                "end" => ends = true,
                _ if self.press(&line) => {}
                other => unknown.push(other.to_owned()),
            }
        }
        let mut switches = self.hand;
        for limit in &self.limits {
            let bit = 1 << limit.axis;
            match limit.end {
                End::Min if position(limit.axis) <= limit.steps => switches.limit_min |= bit,
                End::Max if position(limit.axis) >= limit.steps => switches.limit_max |= bit,
                End::Min | End::Max => {}
            }
        }
        Look { switches: wired(switches, self.wiring), ends, unknown }
    }

    /// Does what a line says; false where it says nothing.
    fn press(&mut self, line: &str) -> bool {
        let words: Vec<&str> = line.split_whitespace().collect();
        let level = match words.last() {
            Some(&"0") => false,
            Some(&"1") => true,
            _ => return false,
        };
        let bits = match words[..] {
            ["estop", _] => {
                self.hand.estop = level;
                return true;
            }
            ["min", _, _] => &mut self.hand.limit_min,
            ["max", _, _] => &mut self.hand.limit_max,
            _ => return false,
        };
        let Some(axis) = self.axes.iter().position(|axis| axis == words[1]) else { return false };
        *bits = *bits & !(1 << axis) | u8::from(level) << axis;
        true
    }
}

/// The switches on the inputs of this wiring: where both ends share a wire, either of them closes it.
fn wired(switches: Switches, wiring: Limits) -> Switches {
    let any = switches.limit_min | switches.limit_max;
    let limit_min = match wiring {
        Limits::Pair | Limits::None => return switches,
        Limits::Each => any,
        Limits::One => u8::from(any != 0),
    };
    Switches { limit_min, limit_max: 0, ..switches }
}

/// Lines of standard input as they come; none after its end.
fn lines() -> Receiver<String> {
    let (to, from) = channel();
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            if to.send(line).is_err() {
                return;
            }
        }
    });
    from
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn switches_are_on_the_inputs_of_their_wiring() {
        let pressed = Switches { estop: true, limit_min: 0b0010, limit_max: 0b0100 };
        let wires = |wiring| {
            let Switches { estop, limit_min, limit_max } = wired(pressed, wiring);
            (estop, limit_min, limit_max)
        };
        assert_eq!(wires(Limits::Pair), (true, 0b0010, 0b0100));
        assert_eq!(wires(Limits::Each), (true, 0b0110, 0));
        assert_eq!(wires(Limits::One), (true, 1, 0));
        assert_eq!(wired(Switches::default(), Limits::One), Switches::default());
    }
}

//! The switches of a virtual board: limit switches at fixed positions, and switches that the user
//! operates through standard input.
//!
//! ```text
//! estop 1     presses the e-stop, `estop 0` releases it; likewise `min x 1`, `max x 0`, `probe 1`,
//!             `interlock 1` opens the interlock, and `input 2 1` activates general input 2
//! end         ends the board, as Ctrl-C does
//! ```

use crate::failure::Failure;
use carrystep_core::engine::LimitWiring;
use carrystep_files::Machine;
use carrystep_virtual_board::Switches;
use std::io::BufRead as _;
use std::sync::mpsc::{Receiver, channel};

/// The lines that the panel knows, each as an example.
pub const KNOWN: &str = "estop 1, min x 1, max x 0, probe 1, interlock 1, input 0 1, end";

/// The greatest number of general inputs.
const GENERAL: u8 = 8;

/// One end of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Min,
    Max,
    /// The plate of the probe: it is touched at this position and below.
    Plate,
}

/// A limit switch or a plate at a position, in steps.
#[derive(Debug, Clone, Copy)]
struct Limit {
    axis: usize,
    end: End,
    steps: i32,
}

/// All switches of a board.
#[derive(Debug)]
pub struct SwitchPanel {
    limits: Vec<Limit>,
    axes: Vec<String>,
    /// The switches that the user has pressed.
    hand: Switches,
    wiring: LimitWiring,
    lines: Receiver<String>,
}

/// The result of polling the panel.
pub struct Look {
    /// The state of the inputs.
    pub switches: Switches,
    /// True if the user wants to end the board.
    pub ends: bool,
    /// Lines that are no command.
    pub unknown: Vec<String>,
}

impl SwitchPanel {
    /// The panel of a machine with the given limit switches and plates of the probe, each
    /// `AXIS=STEPS`.
    ///
    /// # Errors
    /// An option is malformed, names no axis, or the machine has no inputs for it.
    pub fn new(
        machine: &Machine,
        min: &[String],
        max: &[String],
        plates: &[String],
    ) -> Result<Self, Failure> {
        if !(plates.is_empty() || machine.has_probe()) {
            return Err(Failure::input(
                "--probe is a plate for the probe, and the machine has none: probe in [machine.inputs]",
            ));
        }
        if machine.guard.limits == LimitWiring::None && !(min.is_empty() && max.is_empty()) {
            return Err(Failure::input(
                "--min and --max are limit switches, and the machine has no input for them: [machine.guard] limits is \"none\"",
            ));
        }
        let axes: Vec<String> = machine.axes.iter().map(|axis| axis.name.clone()).collect();
        let mut limits = Vec::new();
        let options =
            [(End::Min, "--min", min), (End::Max, "--max", max), (End::Plate, "--probe", plates)];
        for (end, option, texts) in options {
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
        Ok(Self {
            limits,
            axes,
            hand: Switches::default(),
            wiring: machine.guard.limits,
            lines: lines(),
        })
    }

    /// Reads pending commands and returns the state of the inputs for these positions (steps).
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
                End::Plate if position(limit.axis) <= limit.steps => switches.touch_probe(true),
                End::Min | End::Max | End::Plate => {}
            }
        }
        Look { switches: wired(switches, self.wiring), ends, unknown }
    }

    /// Executes a line that presses or releases a switch. Returns false if it is no such line.
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
            ["probe", _] => {
                self.hand.touch_probe(level);
                return true;
            }
            ["interlock", _] => {
                self.hand.open_interlock(level);
                return true;
            }
            ["input", number, _] => {
                let number = number.parse().ok().filter(|number| *number < GENERAL);
                let Some(number) = number else { return false };
                self.hand.set_input(number, level);
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

/// The levels of the inputs in this wiring. If several switches share a wire, each of them closes
/// it.
fn wired(switches: Switches, wiring: LimitWiring) -> Switches {
    let any = switches.limit_min | switches.limit_max;
    let limit_min = match wiring {
        LimitWiring::Pair | LimitWiring::None => return switches,
        LimitWiring::Each => any,
        LimitWiring::One => u8::from(any != 0),
    };
    Switches { limit_min, limit_max: 0, ..switches }
}

/// The lines of standard input as they arrive; none after its end.
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
    fn switches_drive_the_inputs_of_their_wiring() {
        let (limit_min, limit_max) = (0b0010, 0b0100);
        let pressed = Switches { estop: true, limit_min, limit_max, ..Switches::default() };
        let wires = |wiring| {
            let Switches { estop, limit_min, limit_max, .. } = wired(pressed, wiring);
            (estop, limit_min, limit_max)
        };
        assert_eq!(wires(LimitWiring::Pair), (true, 0b0010, 0b0100));
        assert_eq!(wires(LimitWiring::Each), (true, 0b0110, 0));
        assert_eq!(wires(LimitWiring::One), (true, 1, 0));
        assert_eq!(wired(Switches::default(), LimitWiring::One), Switches::default());
    }
}

//! Status reports: `<Idle|MPos:0.000,0.000,0.000|Bf:15,128|FS:0,0|WCO:0.000,0.000,0.000>`.
//!
//! State, place and speeds are in each report. The offset between machine and work places comes in
//! the first report, in the next one when it has changed, and in each 10th (each 30th while the
//! machine is busy); the overrides come in the second report, when they have changed, and in each
//! 10th (20th), but never in a report with the offset.

use crate::overrides::Overrides;
use crate::parameters::{INCH, places};
use crate::settings::Settings;
use crate::state::State;
use std::fmt::{self, Write as _};

/// Reports from one offset to the next at rest, and while the machine is busy.
const OFFSET: [u8; 2] = [10, 30];
/// The same for overrides.
const OVERRIDES: [u8; 2] = [10, 20];

/// Inputs that are active.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Pins {
    /// Limit switches, one bit for each letter: x is bit 0, c is bit 5.
    pub limits: u8,
    /// The probe.
    pub probe: bool,
    /// The safety door: the interlock of the board.
    pub door: bool,
    /// The e-stop, which Grbl's reports call the reset pin.
    pub reset: bool,
}

/// Spindle and coolant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Accessories {
    /// The spindle turns; true: counterclockwise.
    pub spindle: Option<bool>,
    /// Flood coolant.
    pub flood: bool,
    /// Mist coolant.
    pub mist: bool,
}

/// What a report is about.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Seen {
    /// The state.
    pub state: State,
    /// The machine place, mm or degrees, of each axis in the order X, Y, Z, A, B, C.
    pub machine: Vec<f64>,
    /// Machine place less work place, of each axis.
    pub offset: Vec<f64>,
    /// Free places of the queue, in lines.
    pub blocks: usize,
    /// Free bytes of the receive buffer.
    pub bytes: usize,
    /// N of the line that is executed.
    pub line: Option<u64>,
    /// Speed along the path, mm/min.
    pub feed: f64,
    /// Speed of the spindle, turns per minute.
    pub rpm: f64,
    /// Inputs.
    pub pins: Pins,
    /// Overrides.
    pub overrides: Overrides,
    /// Spindle and coolant.
    pub accessories: Accessories,
}

/// Which fields come in which report.
#[derive(Debug, Clone, Default)]
pub struct Reporter {
    /// Reports until the offset comes again, and until the overrides do.
    until_offset: u8,
    until_overrides: u8,
    /// What was shown last.
    offset: Vec<f64>,
    overrides: Overrides,
    accessories: Accessories,
}

impl Reporter {
    /// As at the beginning, and behind a reset: the next report has the offset.
    pub fn restart(&mut self) {
        (self.until_offset, self.until_overrides) = (0, 0);
    }

    /// The next report, without the end of its line.
    pub fn report(&mut self, seen: &Seen, settings: &Settings) -> String {
        let Seen { state, machine, offset, .. } = seen;
        let inches = settings.inches;
        let mut text = format!("<{state}|");
        // Writing to a string cannot fail.
        let _ = if settings.report & 1 == 1 {
            write!(text, "MPos:{}", places(machine, inches))
        } else {
            let work: Vec<f64> = machine.iter().zip(offset).map(|(at, off)| at - off).collect();
            write!(text, "WPos:{}", places(&work, inches))
        };
        if settings.report & 2 != 0 {
            let _ = write!(text, "|Bf:{},{}", seen.blocks, seen.bytes);
        }
        if let Some(line) = seen.line.filter(|&line| line > 0) {
            let _ = write!(text, "|Ln:{line}");
        }
        let _ = if inches {
            write!(text, "|FS:{:.1},{:.0}", seen.feed / INCH, seen.rpm)
        } else {
            write!(text, "|FS:{:.0},{:.0}", seen.feed, seen.rpm)
        };
        text.push_str(&pins(seen.pins));
        text.push_str(&self.now_and_then(seen, inches));
        text.push('>');
        text
    }

    /// The fields that come only now and then.
    fn now_and_then(&mut self, seen: &Seen, inches: bool) -> String {
        let busy = usize::from(seen.state.is_busy());
        if self.offset != seen.offset {
            self.until_offset = 0;
        }
        if (self.overrides, self.accessories) != (seen.overrides, seen.accessories) {
            self.until_overrides = 0;
        }
        if self.until_offset == 0 {
            self.offset.clone_from(&seen.offset);
            self.until_offset = OFFSET[busy] - 1;
            // They come with the next report if this one would have had them.
            self.until_overrides = self.until_overrides.saturating_sub(1);
            return format!("|WCO:{}", places(&seen.offset, inches));
        }
        self.until_offset -= 1;
        if self.until_overrides > 0 {
            self.until_overrides -= 1;
            return String::new();
        }
        (self.overrides, self.accessories) = (seen.overrides, seen.accessories);
        self.until_overrides = OVERRIDES[busy] - 1;
        let Overrides { feed, rapid, spindle } = seen.overrides;
        let Accessories { spindle: turns, flood, mist } = seen.accessories;
        let mut text = format!("|Ov:{feed},{rapid},{spindle}");
        if seen.accessories != Accessories::default() {
            text.push_str("|A:");
            text.push_str(match turns {
                None => "",
                Some(false) => "S",
                Some(true) => "C",
            });
            text.push_str(if flood { "F" } else { "" });
            text.push_str(if mist { "M" } else { "" });
        }
        text
    }
}

/// The active inputs, or nothing.
fn pins(pins: Pins) -> String {
    if pins == Pins::default() { String::new() } else { format!("|Pn:{pins}") }
}

impl fmt::Display for Pins {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let limits = "XYZABC".chars().enumerate();
        let limits = limits.map(|(bit, letter)| (self.limits >> bit & 1 == 1, letter));
        let others = [(self.probe, 'P'), (self.door, 'D'), (self.reset, 'R')];
        limits
            .chain(others)
            .filter(|(active, _)| *active)
            .try_for_each(|(_, letter)| f.write_char(letter))
    }
}

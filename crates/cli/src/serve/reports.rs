//! What status reports say of a machine.

use super::accessories::Coolant;
use super::requests::{Motion, Requests};
use super::terms;
use carrystep_gcode::Turn;
use carrystep_grbl::{Accessories, Seen};
use carrystep_link::Status;
use carrystep_program::Point;
use carrystep_runner::LINES;
use std::time::{Duration, Instant};

/// Time over which the speed of reports is measured.
const SPEED: Duration = Duration::from_millis(60);

/// Numbers of lines that are remembered for `Ln:`.
const NUMBERS: usize = 4 * LINES;

impl Requests {
    /// Notes what the axes do.
    pub fn see(&mut self, status: &Status) {
        self.rests = status.answer.idle || status.answer.halted;
        let at = self.at(&status.positions);
        let (when, before, speed) = self.speed;
        let passed = when.elapsed();
        if self.rests {
            self.speed = (Instant::now(), at, 0.0);
        } else if passed >= SPEED {
            let way: f64 = (0..3).map(|axis| (at[axis] - before[axis]).powi(2)).sum();
            self.speed = (Instant::now(), at, way.sqrt() / passed.as_secs_f64() * 60.0);
        } else {
            self.speed = (when, before, speed);
        }
        let moved = self.positions.iter().zip(status.positions).zip(&mut self.ways);
        for ((before, now), way) in moved.filter(|((before, now), _)| *before != now) {
            *way = now.wrapping_sub(*before).signum() as i8;
        }
        self.belts.see(&status.positions);
        self.positions = status.positions;
    }

    /// What a report is about.
    pub fn seen(&self) -> Seen {
        let (lines, letters) = (self.lines.interpreter(), self.lines.letters());
        let modes = lines.modes();
        let of_axes = |at: &Point| terms::of_axes(letters, |letter| at[letter]);
        let line = self.line.filter(|_| self.motion == Motion::Moves && !self.jogs);
        let spindle = match self.accessories.has_spindle() {
            true => self.accessories.turns(),
            false if modes.spindle == Turn::Off => None,
            false => Some(modes.spindle == Turn::Counterclockwise),
        };
        let spindle = spindle.filter(|_| !self.checks);
        let is_on = |coolant, of_lines| self.accessories.is_on(coolant).unwrap_or(of_lines);
        Seen {
            state: self.state(),
            machine: of_axes(&self.at(&self.positions)),
            offset: of_axes(&modes.offset),
            blocks: self.growing.free(),
            bytes: self.input.free(),
            line: line.and_then(|line| self.number(line)),
            feed: self.speed.2,
            rpm: if spindle.is_some() { modes.rpm } else { 0.0 },
            pins: self.pins,
            overrides: self.overrides,
            accessories: Accessories {
                spindle,
                flood: is_on(Coolant::Flood, modes.flood),
                mist: is_on(Coolant::Mist, modes.mist),
            },
        }
    }

    /// N of a line, if it has one.
    fn number(&self, line: u64) -> Option<u64> {
        let known = self.numbers.iter().rev().find(|(known, _)| *known == line);
        known.map(|(_, number)| *number)
    }

    /// Notes N of the line that was executed last.
    pub fn numbered(&mut self, text: &str) {
        let digits = text.strip_prefix('N').unwrap_or_default();
        let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
        if let Ok(number) = digits[..end].parse() {
            if self.numbers.len() == NUMBERS {
                self.numbers.pop_front();
            }
            self.numbers.push_back((self.lines.lines(), number));
        }
    }
}

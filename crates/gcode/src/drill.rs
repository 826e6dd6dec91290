//! Begins a drilling cycle: which holes the words of a line ask for.
//!
//! R, the bottom, P and Q stay in effect for the following lines of the same cycle. With G91, R is
//! measured from the level at which the first of these lines began, and the bottom from R.

use crate::codes::Group;
use crate::cycle::{Cycle, Hole, Pattern, Stage};
use crate::error::{ErrorKind, Fault};
use crate::motion::{AXIS_WORDS, MOST, MOST_SECONDS, Moved, Mover};
use crate::request::Request;
use crate::state::{CycleWords, Motion};

impl Mover<'_> {
    /// Begins the cycle G`number`.
    pub(crate) fn drill(&mut self, number: u16) -> Result<Moved, Fault> {
        let code = self.code;
        let fault = |kind| Fault::new(code.column, kind);
        if self.request.code(Group::Once).is_some_and(|code| code.tenths == 530) {
            return Err(fault(ErrorKind::MachineMotion(code.to_string())));
        }
        if self.state.modal.inverse_time {
            return Err(fault(ErrorKind::NotInInverseTime(code.to_string())));
        }
        let plane = self.state.modal.plane;
        let [first, second, normal] = plane.axes();
        let at = self.state.program;
        let mut words = self.state.modal.cycle;
        let initial = *words.initial_level.get_or_insert(at[normal]);
        let hole = self.sticky_words(number, &mut words)?;
        let request = &mut *self.request;
        let holes = request.take_whole(b'l', MOST, "1 to 10^9")?.unwrap_or(1);
        if holes == 0 {
            return Err(request.out_of_range(b'l', 0.0, "1 to 10^9"));
        }
        let pattern = self.pattern([first, second])?;
        let is_incremental = self.state.modal.incremental;
        let r = if is_incremental { initial + words.r } else { words.r };
        let bottom = if is_incremental { r + words.bottom } else { words.bottom };
        if bottom > r {
            return Err(fault(ErrorKind::CycleUpwards(bottom - r)));
        }
        // The drill moves along the normal axis, also if the hole has no depth.
        let mut away = self.state.machine;
        away[normal] = f64::INFINITY;
        let cycle = Cycle {
            hole,
            plane,
            frame: self.state.frame.clone(),
            pace: self.pace(&away)?,
            at,
            pattern,
            hole_number: 0,
            holes,
            r,
            bottom,
            clear: if self.state.modal.retract_to_initial { initial.max(r) } else { r },
            stage: if initial < r { Stage::Raise } else { Stage::Over },
        };
        let mut end = cycle.end();
        for level in [bottom, r, cycle.clear] {
            end[normal] = level;
            self.near(&self.state.frame.to_machine(&end))?;
        }
        self.state.modal.cycle = words;
        self.arrive(end, self.state.frame.to_machine(&end));
        Ok(Moved::Cycle(Box::new(cycle)))
    }

    /// The places of the holes, from the polar words or the axis words of the line.
    fn pattern(&mut self, axes: [usize; 2]) -> Result<Pattern, Fault> {
        if let Some((first, by)) = self.polar_words()? {
            return Ok(Pattern::Polar(first, by));
        }
        let unit = self.state.unit();
        let at = axes.map(|axis| self.state.program[axis]);
        let words = axes.map(|axis| self.request.take(AXIS_WORDS[axis]).map(|word| word * unit));
        if self.state.modal.incremental {
            let by = words.map(|word| word.unwrap_or(0.0));
            return Ok(Pattern::Straight([at[0] + by[0], at[1] + by[1]], by));
        }
        let first = [words[0].unwrap_or(at[0]), words[1].unwrap_or(at[1])];
        Ok(Pattern::Straight(first, [0.0; 2]))
    }

    /// The words that stay in effect, new or from the lines before.
    fn sticky_words(&mut self, number: u16, words: &mut CycleWords) -> Result<Hole, Fault> {
        let code = self.code;
        let unit = self.state.unit();
        let normal = AXIS_WORDS[self.state.modal.plane.axes()[2]];
        let is_first = self.state.modal.motion != Motion::Cycle(number);
        let request = &mut *self.request;
        let word = |request: &mut Request, letter, kept: f64, unit, what| {
            if is_first || request.has(letter) {
                request.need(letter, code, what).map(|value| value * unit)
            } else {
                Ok(kept)
            }
        };
        words.r = word(request, b'r', words.r, unit, "R, the level above the hole")?;
        words.bottom = word(request, normal, words.bottom, unit, "the bottom of the hole")?;
        match number {
            82 => {
                words.dwell = word(request, b'p', words.dwell, 1.0, "P, the time at the bottom")?;
                if !(0.0..=MOST_SECONDS).contains(&words.dwell) {
                    return Err(request.out_of_range(b'p', words.dwell, "0 to 10^9 s"));
                }
                Ok(Hole::Dwell(words.dwell))
            }
            83 => {
                words.peck = word(request, b'q', words.peck, unit, "Q, the depth of a peck")?;
                if words.peck <= 0.0 {
                    return Err(request.out_of_range(b'q', words.peck, "above 0"));
                }
                Ok(Hole::Peck(words.peck))
            }
            _ => Ok(Hole::Drill),
        }
    }
}

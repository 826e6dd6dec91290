//! Canonical moves as events, step by step: each move with its start, its feed and the tolerance in
//! force, rests, and what is switched.

use crate::entry::Entry;
use crate::error::Fault;
use crate::event::{Event, ProgrammedMove, Reading};
use crate::laser::LaserPower;
use crate::letter::LINEAR;
use crate::letters::Letters;
use crate::outputs::{Effect, ProgramOutputs};
use crate::switch::Switch;
use carrystep_files::Machine;
use carrystep_gcode::{AXES, AXIS_LETTERS, Arc, Canon, Pace, PathMode, Point, Step, Turn};
use carrystep_job::Tolerance;
use std::collections::VecDeque;

/// Distance from the programmed path that is allowed where the program says nothing, mm and
/// degrees.
pub const DEFAULT_TOLERANCE: f64 = 0.01;

/// Smaller differences of X, Y and Z are rounding errors of a rotated coordinate system, mm. With
/// them, a turn of a rotary axis alone would be a move in mm, at a feed in mm.
const SAME: f64 = 1e-9;

/// What makes events of steps.
#[derive(Debug, Clone)]
pub(crate) struct Translator {
    letters: Letters,
    pub outputs: ProgramOutputs,
    tolerance_mm: Option<f64>,
    /// The place up to which the steps have been read.
    pub at: Point,
    /// The block of the step that is being added.
    block: u64,
    /// The axes of which it is not known where the program began. They must not move.
    unknown: [bool; AXES],
    mode: PathMode,
    /// What M3, M4, M5 and S have said last.
    pub turns: (Turn, f64),
    /// The power of the laser in the last move; `None` if that is not known to who plans the next.
    pub power: Option<LaserPower>,
    /// What the last steps give and has not been taken yet.
    pub waiting: VecDeque<Event>,
}

impl Translator {
    /// Begins at this place, with a tolerance in mm in place of that of G64 if there is one.
    pub fn new(machine: &Machine, letters: &Letters, start: Point, tolerance: Option<f64>) -> Self {
        Self {
            letters: letters.clone(),
            outputs: ProgramOutputs::new(machine),
            tolerance_mm: tolerance,
            at: start,
            block: 0,
            unknown: [false; AXES],
            mode: PathMode::Blend { tolerance_mm: None, joining_mm: None },
            turns: (Turn::Off, 0.0),
            power: None,
            waiting: VecDeque::new(),
        }
    }

    /// The tolerance in force.
    fn tolerance(&self) -> Tolerance {
        let [linear, rotary] = self.letters.finest().map(|step| step.unwrap_or(DEFAULT_TOLERANCE));
        let exact = Tolerance { linear, rotary };
        let of_g64 = match self.mode {
            PathMode::Exact => return exact,
            PathMode::ExactStop => None,
            PathMode::Blend { tolerance_mm, .. } => tolerance_mm,
        };
        match self.tolerance_mm.or(of_g64) {
            // G64 P0 rounds nothing.
            Some(0.0) => exact,
            linear => {
                Tolerance { linear: linear.unwrap_or(DEFAULT_TOLERANCE), rotary: DEFAULT_TOLERANCE }
            }
        }
    }

    /// Adds the way from where the machine is to the place where the block begins, with what is
    /// switched on it.
    pub fn enter(&mut self, entry: &Entry, machine: Point) -> Result<(), Fault> {
        let line = entry.block.line;
        let rest = |seconds| Event::Rest { seconds, line };
        let place = std::mem::replace(&mut self.at, machine);
        let mode = std::mem::replace(&mut self.mode, PathMode::ExactStop);
        // A laser is off on this way.
        let turns = std::mem::replace(&mut self.turns, (Turn::Off, 0.0));
        self.power = None;
        self.block = entry.block.number;
        let height = |place: Point| match entry.height {
            Some(height) => [place[0], place[1], height, place[3], place[4], place[5]],
            None => place,
        };
        for to in [height(machine), height(place)] {
            if to != self.at {
                self.go(line, to, None, None)?;
            }
        }
        let modes = &entry.modes;
        if modes.spindle != Turn::Off {
            let effect = self.outputs.spindle(modes.spindle, modes.rpm)?;
            self.change(effect, false, Switch::Spindle, line);
        }
        if modes.mist || modes.flood {
            let effect = self.outputs.coolant(modes.mist, modes.flood);
            self.change(effect, false, Switch::Coolant, line);
        }
        if entry.dwell > 0.0 {
            self.waiting.push_back(rest(entry.dwell));
        }
        if place != self.at {
            self.go(line, place, None, Some(Pace::PerSecond(entry.feed)))?;
        }
        if !entry.outputs.is_none() {
            let (change, with_motion) = (entry.outputs, false);
            self.waiting.push_back(Event::Outputs { change, with_motion, line });
        }
        self.waiting.push_back(rest(0.0));
        (self.mode, self.turns, self.unknown) = (mode, turns, entry.unknown);
        Ok(())
    }

    /// Adds what a step gives.
    ///
    /// # Errors
    /// What the machine cannot do.
    pub fn add(&mut self, Step { line, block, canon, .. }: Step) -> Result<(), Fault> {
        self.block = block;
        let rest = Event::Rest { seconds: 0.0, line };
        match canon {
            Canon::Traverse { to } => self.go(line, to, None, None)?,
            Canon::Feed { to, pace } => self.go(line, to, None, Some(pace))?,
            Canon::Arc(arc) => self.go(line, arc.to, Some(arc), Some(arc.pace))?,
            Canon::Probe { to, pace, contact, required } => {
                self.switch(Switch::Probe, line);
                let turns = std::mem::replace(&mut self.turns, (Turn::Off, 0.0));
                self.go(line, to, None, Some(pace))?;
                self.turns = turns;
                self.waiting.push_back(rest);
                let reading = Reading::Probe { contact, required };
                self.waiting.push_back(Event::Reading { reading, line });
            }
            Canon::Dwell { seconds } => self.waiting.push_back(Event::Rest { seconds, line }),
            Canon::Path(mode) => self.mode = mode,
            Canon::Spindle { turn, rpm } => {
                let effect = self.outputs.spindle(turn, rpm)?;
                let (before, _) = std::mem::replace(&mut self.turns, (turn, rpm));
                // The tool does not rest for another power of a laser.
                let stays = (before == Turn::Off) == (turn == Turn::Off);
                if !(stays && self.outputs.has_laser()) {
                    self.change(effect, false, Switch::Spindle, line);
                }
            }
            Canon::Coolant { mist, flood } => {
                let effect = self.outputs.coolant(mist, flood);
                self.change(effect, false, Switch::Coolant, line);
            }
            Canon::DigitalOutput { index, on, with_motion } => {
                let effect = self.outputs.digital(index, on)?;
                self.change(effect, with_motion, Switch::Output, line);
            }
            Canon::AnalogOutput { index, value, with_motion } => {
                let effect = self.outputs.analog(index, value)?;
                self.change(effect, with_motion, Switch::Output, line);
            }
            Canon::ReadInput { input, until, seconds } => {
                self.switch(Switch::Input, line);
                let reading = Reading::Input { input, until, seconds };
                self.waiting.push_back(Event::Reading { reading, line });
            }
            Canon::ChangeTool { .. } => self.switch(Switch::ToolChange, line),
            Canon::Pause { .. } => self.switch(Switch::Pause, line),
            Canon::End => self.waiting.push_back(Event::End { line }),
            // Nothing overrides a feed in a plan, and the rest is for the operator.
            Canon::Overrides { .. }
            | Canon::SelectTool { .. }
            | Canon::Comment(_)
            | Canon::Message(_) => {}
        }
        Ok(())
    }

    /// Changes outputs, as far as the machine has them for what is switched.
    fn change(&mut self, effect: Effect, with_motion: bool, switch: Switch, line: u64) {
        let Effect { change, is_all } = effect;
        if !change.is_none() {
            self.waiting.push_back(Event::Outputs { change, with_motion, line });
        }
        if !is_all {
            self.switch(switch, line);
        }
    }

    fn switch(&mut self, switch: Switch, line: u64) {
        self.waiting.push_back(Event::Switch { switch, line });
    }

    fn go(
        &mut self,
        line: u64,
        mut to: Point,
        arc: Option<Arc>,
        pace: Option<Pace>,
    ) -> Result<(), Fault> {
        let differs = |letter: usize| (to[letter] - self.at[letter]).abs();
        let turns = (LINEAR..AXES).any(|letter| differs(letter) > 0.0);
        if arc.is_none() && turns && (0..LINEAR).all(|letter| differs(letter) < SAME) {
            to[..LINEAR].copy_from_slice(&self.at[..LINEAR]);
        }
        let in_plane = |letter| arc.is_some_and(|arc| arc.plane.axes()[..2].contains(&letter));
        for letter in 0..AXES {
            let moves = to[letter] != self.at[letter] || in_plane(letter);
            if moves && self.letters.axis(letter).is_none() {
                return Err(Fault::NoAxis(AXIS_LETTERS[letter]));
            }
            if moves && self.unknown[letter] {
                return Err(Fault::Began(AXIS_LETTERS[letter]));
            }
        }
        let from = std::mem::replace(&mut self.at, to);
        let tolerance = self.tolerance();
        let block = self.block;
        let mut one = ProgrammedMove { from, to, arc, feed: None, tolerance, line, block };
        one.feed = pace.map(|pace| match pace {
            Pace::PerSecond(speed) => speed,
            Pace::Seconds(seconds) => one.length() / seconds,
        });
        let power = self.outputs.laser(self.turns.0, self.turns.1, one.feed);
        if let Some(power) = power.filter(|_| one.length() > 0.0)
            && self.power.replace(power) != Some(power)
        {
            self.waiting.push_back(Event::Laser { power, line });
        }
        self.waiting.push_back(Event::Move(one));
        if self.mode == PathMode::ExactStop {
            self.waiting.push_back(Event::Rest { seconds: 0.0, line });
        }
        Ok(())
    }
}

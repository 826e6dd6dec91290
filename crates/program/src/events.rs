//! Canonical moves as events for a machine: each move with its start, its feed and the tolerance in
//! force, rests, and what is switched.

use crate::entry::Entry;
use crate::error::{Fault, ProgramError};
use crate::event::{Event, ProgrammedMove, Reading};
use crate::file::{Found, ProgramFile, Resumed};
use crate::laser::LaserPower;
use crate::letter::LINEAR;
use crate::letters::Letters;
use crate::outputs::{Effect, ProgramOutputs};
use crate::switch::Switch;
use carrystep_gcode::{
    AXES, AXIS_LETTERS, Arc, Canon, Interpreter, Offsets, Options, Pace, PathMode, Point, Step,
    Turn,
};
use carrystep_job::Tolerance;
use std::collections::VecDeque;
use std::fs::File;
use std::path::PathBuf;

/// Distance from the programmed path that is allowed where the program says nothing, mm and
/// degrees.
pub const DEFAULT_TOLERANCE: f64 = 0.01;

/// Smaller differences of X, Y and Z are rounding errors of a rotated coordinate system, mm. With
/// them, a turn of a rotary axis alone would be a move in mm, at a feed in mm.
const SAME: f64 = 1e-9;

/// The events of a program, from its beginning.
#[derive(Debug)]
pub struct Events {
    steps: Interpreter<File>,
    path: PathBuf,
    /// Whether all lines so far were of the program itself, and not of files beside it.
    one_file: bool,
    name: String,
    letters: Letters,
    outputs: ProgramOutputs,
    tolerance_mm: Option<f64>,
    at: Point,
    /// The block of the step that is being added.
    block: u64,
    /// The axes of which it is not known where the program began. They must not move.
    unknown: [bool; AXES],
    /// Number of places to wait at or to read something so far, and what was changed at some of them.
    waits: u64,
    resumed: Vec<Resumed>,
    mode: PathMode,
    /// What M3, M4, M5 and S have said last.
    turns: (Turn, f64),
    /// The power of the laser in the last move; `None` if that is not known to who plans the next.
    power: Option<LaserPower>,
    /// What the last canonical move gives and has not been taken yet.
    waiting: VecDeque<Event>,
}

impl Events {
    /// Reads a program from its beginning, or from its entry.
    ///
    /// # Errors
    /// The file cannot be read, is not the one that was opened, or its O-words are wrong.
    pub fn new(file: &ProgramFile) -> Result<Self, ProgramError> {
        file.same()?;
        let Some(entry) = file.entry() else { return Self::begin(file, file.settings().start) };
        let mut events = Self::begin(file, entry.program_start())?;
        events.pass_over(entry.block.number, |_, _, _| ())?;
        let machine = file.settings().start;
        let error = |fault| ProgramError::new(file.path(), entry.block.line, fault);
        events.enter(entry, machine).map_err(error)?;
        Ok(events)
    }

    /// Reads a program that begins at this place from its beginning.
    pub(crate) fn begin(file: &ProgramFile, start: Point) -> Result<Self, ProgramError> {
        let settings = file.settings();
        let offsets = settings.offsets.clone();
        let options = Options { start, blocks: settings.blocks, offsets, ..Options::default() };
        let steps = Interpreter::open(file.path(), &options)
            .map_err(|error| ProgramError::of_gcode(file.path(), error))?;
        Ok(Self {
            steps,
            path: file.path().to_owned(),
            one_file: true,
            name: file.path().display().to_string(),
            letters: file.letters().clone(),
            outputs: ProgramOutputs::new(file.machine()),
            tolerance_mm: settings.tolerance_mm,
            at: start,
            block: 0,
            unknown: [false; AXES],
            waits: 0,
            resumed: settings.resumed.clone(),
            mode: PathMode::Blend { tolerance_mm: None, joining_mm: None },
            turns: (Turn::Off, 0.0),
            power: None,
            waiting: VecDeque::new(),
        })
    }

    /// Whether all lines so far were of the program itself, and not of files beside it.
    pub fn one_file(&self) -> bool {
        self.one_file
    }

    /// The offsets that the machine keeps, behind the last line that was read.
    pub fn offsets(&self) -> Offsets {
        self.steps.offsets()
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

    /// Executes the blocks before this one without their motion. `watch` sees each step and what it
    /// would give.
    pub(crate) fn pass_over(
        &mut self,
        block: u64,
        mut watch: impl FnMut(&Canon, &ProgramOutputs, &VecDeque<Event>),
    ) -> Result<(), ProgramError> {
        // Places to wait at are counted from the block on.
        let resumed = std::mem::take(&mut self.resumed);
        while let Some(step) = self.steps.step_before(block) {
            let step = step.map_err(|error| ProgramError::of_gcode(&self.path, error))?;
            let (line, canon) = (step.line, step.canon.clone());
            self.one_file &= *step.file == *self.name;
            self.add(step).map_err(|fault| ProgramError::new(&self.path, line, fault))?;
            watch(&canon, &self.outputs, &self.waiting);
            self.waiting.clear();
        }
        (self.waits, self.resumed) = (0, resumed);
        Ok(())
    }

    /// The interpreter.
    pub(crate) const fn steps(&mut self) -> &mut Interpreter<File> {
        &mut self.steps
    }

    /// The place up to which the events have been read.
    pub(crate) const fn at(&self) -> &Point {
        &self.at
    }

    /// Adds the way from where the machine is to the place where the block begins, with what is
    /// switched on it.
    fn enter(&mut self, entry: &Entry, machine: Point) -> Result<(), Fault> {
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

    fn add(&mut self, Step { line, block, canon, .. }: Step) -> Result<(), Fault> {
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
                self.reads(Reading::Probe { contact, required }, line);
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
                self.reads(Reading::Input { input, until, seconds }, line);
            }
            Canon::ChangeTool { .. } => self.wait(Switch::ToolChange, line)?,
            Canon::Pause { .. } => self.wait(Switch::Pause, line)?,
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

    /// A place to wait at. What was changed there is in force for the next line.
    fn wait(&mut self, switch: Switch, line: u64) -> Result<(), Fault> {
        self.switch(switch, line);
        (self.waits, self.power) = (self.waits + 1, None);
        if self.changed().is_some() && self.steps.is_amid_line() {
            return Err(Fault::ResumedAmidLine);
        }
        self.resume();
        Ok(())
    }

    /// Something is read. What was found is in force for the next line: of the line itself, only
    /// steps are left that have no place, or that were computed before.
    fn reads(&mut self, reading: Reading, line: u64) {
        self.waiting.push_back(Event::Reading { reading, line });
        (self.waits, self.power) = (self.waits + 1, None);
        self.resume();
    }

    /// What was changed at the place that was reached last.
    fn changed(&self) -> Option<&Resumed> {
        self.resumed.iter().find(|resumed| resumed.number == self.waits)
    }

    /// Goes on with what was changed and found at the place that was reached last.
    fn resume(&mut self) {
        let Some(Resumed { at, offsets, found, .. }) = self.changed().cloned() else { return };
        match found {
            Found::Nothing => {}
            Found::Probe { at, tripped } => self.steps.probed(at, tripped),
            Found::Input(value) => self.steps.input_read(value),
        }
        offsets.iter().for_each(|offsets| self.steps.set_offsets(offsets));
        if at != self.at || !matches!(found, Found::Input(_)) {
            self.steps.set_place(at);
            self.at = at;
        }
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

impl Iterator for Events {
    type Item = Result<Event, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(event) = self.waiting.pop_front() {
                return Some(Ok(event));
            }
            let step = match self.steps.next()? {
                Ok(step) => step,
                Err(error) => return Some(Err(ProgramError::of_gcode(&self.path, error))),
            };
            let line = step.line;
            self.one_file &= *step.file == *self.name;
            if let Err(fault) = self.add(step) {
                return Some(Err(ProgramError::new(&self.path, line, fault)));
            }
        }
    }
}

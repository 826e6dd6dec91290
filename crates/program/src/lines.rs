//! Lines of a sender on a machine: each is executed whole or not at all, and gives what the planner
//! is given.

use crate::error::Fault;
use crate::event::{Event, Reading};
use crate::items::Items;
use crate::letters::Letters;
use crate::switch::Switch;
use crate::translate::Translator;
use carrystep_files::Machine;
use carrystep_gcode::{GcodeError, LineInterpreter, Offsets, Options, Point, Step, Turn};
use carrystep_job::{Item, JobError, Planner};
use thiserror::Error;

/// The name of the lines in errors.
const NAME: &str = "sender";

/// Where the motion ends, whatever follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineBreak {
    /// M0, M1, M60 and M6: somebody has to let the machine go on.
    Pause,
    /// M2 and M30.
    End,
    /// G38.2 to G38.5: the probe may end the motion of this line early.
    Probe(ProbeLine),
}

/// What a line with G38.2 to G38.5 wants of the probe.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProbeLine {
    /// True: it closes (G38.2, G38.3). False: it opens (G38.4, G38.5).
    pub contact: bool,
    /// Whether it is an error if that does not happen (G38.2, G38.4).
    pub required: bool,
}

/// A part of what a line does.
#[derive(Debug, Clone, PartialEq)]
pub enum PlannedLine {
    /// What the planner is given.
    Item(Item),
    /// The motion ends here.
    Break(LineBreak),
}

/// Why a line was not executed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LineFault {
    /// It is a mistake.
    #[error(transparent)]
    Gcode(#[from] GcodeError),
    /// The machine cannot do it.
    #[error(transparent)]
    Machine(#[from] Fault),
    /// It reads what only a program in a file can read.
    #[error("{0} is only done in programs of `carrystep run`")]
    Reads(Switch),
    /// It probes, on a machine without a probe.
    #[error(
        "the machine has no probe: give its level with probe = \"high\" or \"low\" in machine.inputs"
    )]
    NoProbe,
}

impl LineFault {
    /// Whether a move would leave the travel of an axis.
    pub const fn is_travel(&self) -> bool {
        matches!(self, Self::Machine(Fault::Travel { .. }))
    }
}

/// The lines of a sender, in their order.
#[derive(Debug)]
pub struct Lines {
    interpreter: LineInterpreter,
    translator: Translator,
    items: Items,
    machine: Machine,
    letters: Letters,
    /// What refuses elements; it plans nothing.
    check: Planner,
    tolerance_mm: Option<f64>,
}

impl Lines {
    /// Begins at this machine place with these offsets.
    ///
    /// # Errors
    /// Jobs cannot be planned for this machine.
    pub fn new(
        machine: &Machine,
        start: Point,
        offsets: Offsets,
        tolerance_mm: Option<f64>,
    ) -> Result<Self, Fault> {
        let letters = Letters::new(machine)?;
        let options = Options { start, offsets, ..Options::default() };
        let check = planner(machine, &letters, &letters.coordinates(&start))?;
        Ok(Self {
            interpreter: LineInterpreter::new(NAME, &options),
            translator: Translator::new(machine, &letters, start, tolerance_mm),
            items: Items::new(letters.clone(), start),
            machine: machine.clone(),
            letters,
            check,
            tolerance_mm,
        })
    }

    /// Executes a line.
    ///
    /// # Errors
    /// Why it was not executed. Then it has changed nothing.
    pub fn execute(&mut self, text: &str) -> Result<Vec<PlannedLine>, LineFault> {
        let steps = self.interpreter.execute(text)?;
        self.planned(steps)
    }

    /// Executes a line for its motion alone: modes and offsets are those of before.
    ///
    /// # Errors
    /// As [`Lines::execute`].
    pub fn execute_aside(&mut self, text: &str) -> Result<Vec<PlannedLine>, LineFault> {
        let steps = self.interpreter.execute_aside(text)?;
        // A laser is off in such a motion.
        let turns = std::mem::replace(&mut self.translator.turns, (Turn::Off, 0.0));
        let parts = self.planned(steps);
        self.translator.turns = turns;
        parts
    }

    fn planned(&mut self, steps: Vec<Step>) -> Result<Vec<PlannedLine>, LineFault> {
        let before = (self.translator.clone(), self.items.clone());
        let parts = self.parts(steps);
        if parts.is_err() {
            self.interpreter.undo();
            (self.translator, self.items) = before;
        }
        parts
    }

    fn parts(&mut self, steps: Vec<Step>) -> Result<Vec<PlannedLine>, LineFault> {
        let mut parts = Vec::new();
        for step in steps {
            self.translator.add(step)?;
            while let Some(event) = self.translator.waiting.pop_front() {
                self.part(&event, &mut parts)?;
            }
        }
        Ok(parts)
    }

    fn part(&mut self, event: &Event, parts: &mut Vec<PlannedLine>) -> Result<(), LineFault> {
        match *event {
            Event::Switch { switch: Switch::Input, .. } => {
                return Err(LineFault::Reads(Switch::Input));
            }
            Event::Switch { switch: Switch::Probe, .. } => {
                return if self.machine.has_probe() { Ok(()) } else { Err(LineFault::NoProbe) };
            }
            Event::Reading { reading: Reading::Probe { contact, required }, .. } => {
                parts.push(PlannedLine::Break(LineBreak::Probe(ProbeLine { contact, required })));
                return Ok(());
            }
            Event::Switch { switch: Switch::Pause | Switch::ToolChange, .. } => {
                parts.push(PlannedLine::Break(LineBreak::Pause));
                return Ok(());
            }
            Event::End { .. } => {
                parts.push(PlannedLine::Break(LineBreak::End));
                return Ok(());
            }
            _ => {}
        }
        let from = self.letters.coordinates(&self.items.end);
        for item in self.items.items(event) {
            if let Item::Move(element) = &item {
                let refused = |error: JobError| Fault::of_planner(&self.machine, error);
                self.check.check(&from, element).map_err(refused)?;
            }
            parts.push(PlannedLine::Item(item));
        }
        Ok(())
    }

    /// Number of lines that were executed or refused.
    pub const fn lines(&self) -> u64 {
        self.interpreter.lines()
    }

    /// The machine place at which the motion of all lines so far ends.
    pub const fn end(&self) -> Point {
        self.items.end
    }

    /// A planner for the items that come from this place on: the coordinates of the
    /// letters in the order of their first motors.
    ///
    /// # Errors
    /// The place is beyond the range of the machine's steps.
    pub fn planner(&self, from: &[f64]) -> Result<Planner, Fault> {
        planner(&self.machine, &self.letters, from)
    }

    /// The coordinates of the letters at a machine place, in the order of their first motors.
    pub fn coordinates(&self, at: &Point) -> Vec<f64> {
        self.letters.coordinates(at)
    }

    /// The machine is here, and nothing of what was executed is to be done any more. Modes and
    /// offsets stay.
    pub fn place(&mut self, at: Point) {
        self.interpreter.set_place(at);
        (self.translator.at, self.translator.power) = (at, None);
        self.items = Items::new(self.letters.clone(), at);
    }

    /// The same, with the modes of the beginning and these offsets.
    pub fn restart(&mut self, at: Point, offsets: Offsets) {
        self.interpreter.restart(at, offsets);
        self.translator = Translator::new(&self.machine, &self.letters, at, self.tolerance_mm);
        self.place(at);
    }

    /// The probe of the last line has tripped at this machine place or not, and the machine rests
    /// there or a little further. What was executed is done.
    pub fn probed(&mut self, at: Point, tripped: bool, rests: Point) {
        self.interpreter.probed(at, tripped, rests);
        self.place(rests);
    }

    /// The interpreter, for its modes, parameters and offsets.
    pub const fn interpreter(&self) -> &LineInterpreter {
        &self.interpreter
    }

    /// The letters of the machine's axes.
    pub const fn letters(&self) -> &Letters {
        &self.letters
    }
}

fn planner(machine: &Machine, letters: &Letters, from: &[f64]) -> Result<Planner, Fault> {
    Planner::new(machine, letters.linear(), from).map_err(Fault::Plan)
}

//! A program, its machine, and how it is to be run.

use crate::entry::{Entry, FromBlock};
use crate::error::{Fault, ProgramError};
use crate::letter::unit;
use crate::letters::Letters;
use crate::row_outputs::RowOutputs;
use bigdecimal::BigDecimal;
use carrystep_files::unit::digits;
use carrystep_files::{Axis, InputError, Machine, decimal};
use carrystep_gcode::{DEFAULT_BLOCKS, Offsets, Point};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Endings of names of programs, without the point, in lower case.
const ENDINGS: [&str; 3] = ["ngc", "nc", "gcode"];

/// Whether a file is a program, by the ending of its name: `.ngc`, `.nc` or `.gcode`.
pub fn is_program(path: &Path) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known)))
}

/// How a program is to be run.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Machine place at the beginning: x, y, z in mm, a, b, c in degrees. With `from`, the entry
    /// begins there.
    pub start: Point,
    /// Tolerance in mm instead of G64's; greater than 0.
    pub tolerance_mm: Option<f64>,
    /// Lines that loops and subroutines may run again.
    pub blocks: u64,
    /// The block with which the program begins, instead of its first one.
    pub from: Option<FromBlock>,
    /// Work offsets and tool length at the beginning.
    pub offsets: Offsets,
    /// What was changed where the program has waited, in the order of these places. The program is
    /// planned from the last of them on.
    pub resumed: Vec<Resumed>,
}

/// What was changed or found where a program has stopped, so that the rest of it begins at another
/// place, with other offsets, or otherwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Resumed {
    /// The number of the place at which it has waited or read something, counted from 1 in the order
    /// in which they are executed.
    pub number: u64,
    /// The machine place: x, y, z in mm, then a, b, c in degrees.
    pub at: Point,
    /// Work offsets and tool length; `None` if they stay as they are.
    pub offsets: Option<Offsets>,
    /// What the program has read there.
    pub found: Found,
}

/// What a program has read where it has stopped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Found {
    /// It was a pause or a tool change.
    Nothing,
    /// The machine place at which the probe has tripped, or the target if it has not.
    Probe {
        /// x, y, z in mm, then a, b, c in degrees.
        at: Point,
        /// Whether it has tripped.
        tripped: bool,
    },
    /// The value of an input; `None` if it did not become what was wanted in time.
    Input(Option<f64>),
}

impl Default for Settings {
    /// Machine zero, the tolerances of the program, [`DEFAULT_BLOCKS`], no offsets, the whole program.
    fn default() -> Self {
        Self {
            start: Point::default(),
            tolerance_mm: None,
            blocks: DEFAULT_BLOCKS,
            offsets: Offsets::default(),
            resumed: Vec::new(),
            from: None,
        }
    }
}

/// What shows that a file is still the one that was read first.
type Signs = (u64, Option<SystemTime>);

/// A program on a machine.
#[derive(Debug, Clone)]
pub struct ProgramFile {
    path: PathBuf,
    machine: Machine,
    letters: Letters,
    settings: Settings,
    signs: Signs,
    entry: Option<Entry>,
}

impl ProgramFile {
    /// As `open`, but without the entry.
    pub(crate) fn whole(
        path: &Path,
        machine: Machine,
        machine_path: &Path,
        settings: Settings,
    ) -> Result<Self, InputError> {
        let file =
            carrystep_files::open(path).map_err(|error| InputError::new(error.to_string()))?;
        let there = file.metadata().map_err(|error| InputError::new(error.to_string()))?;
        let letters =
            Letters::new(&machine).map_err(|fault| ProgramError::new(machine_path, 0, fault))?;
        carrystep_job::check_line(&machine)
            .map_err(|error| ProgramError::new(machine_path, 0, Fault::Plan(error)))?;
        let signs = (there.len(), there.modified().ok());
        let path = path.to_owned();
        let this = Self { path, machine, letters, settings, signs, entry: None };
        this.check_start()?;
        Ok(this)
    }

    /// The same program, entered in its middle.
    pub(crate) fn entered(self, entry: Entry) -> Self {
        Self { entry: Some(entry), ..self }
    }

    /// Refuses a start beyond `travel`, or of an axis that does not exist.
    fn check_start(&self) -> Result<(), InputError> {
        for (letter, &at) in self.settings.start.iter().enumerate() {
            let name = carrystep_gcode::AXIS_LETTERS[letter];
            let Some(axis) = self.letters.axis(letter) else {
                if at == 0.0 {
                    continue;
                }
                let axes = self.machine.letter_names();
                return Err(InputError::new(format!(
                    "the start gives {name}: the axes are {axes}"
                )));
            };
            let axis = &self.machine.axes[axis];
            let steps = at * axis.unit.steps;
            if let Some([low, high]) = axis.travel
                && !(low as f64 - 0.5..=high as f64 + 0.5).contains(&steps)
            {
                let [low, high] = [low, high].map(|steps| digits(steps as f64 / axis.unit.steps));
                let unit = unit(letter);
                let message = format!(
                    "the job starts at {name} = {at}, beyond the travel of {low} to {high} {unit}"
                );
                return Err(InputError::new(message).help("give another place with --at"));
            }
        }
        Ok(())
    }

    /// The path of the file, as the user gave it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The machine.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// The letters of the machine's axes.
    pub fn letters(&self) -> &Letters {
        &self.letters
    }

    /// What changes at the outputs with each row of the program, from its first one on.
    pub fn row_outputs(&self) -> RowOutputs {
        RowOutputs::new(&self.machine, &self.letters)
    }

    /// How the program is to be run.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// How the program is entered, if it does not begin with its first block.
    pub const fn entry(&self) -> Option<&Entry> {
        self.entry.as_ref()
    }

    /// The steps of each motor at a place, rounded half away from zero in exact decimals.
    pub fn steps(&self, place: &Point) -> Vec<i64> {
        let steps = |(motor, axis): (usize, &Axis)| {
            let part = |&letter: &usize| {
                let leader = self.letters.axis(letter)?;
                let coefficient = self.machine.coefficient(motor, leader);
                let exact = BigDecimal::try_from(place[letter]).ok()?;
                (coefficient != 0).then(|| exact * BigDecimal::from(coefficient))
            };
            let sum: BigDecimal = self.letters.all().iter().filter_map(part).sum();
            decimal::round_half_away(&(sum * &axis.steps_per_unit)).unwrap_or(i64::MAX)
        };
        self.machine.axes.iter().enumerate().map(steps).collect()
    }

    /// The machine place where the program begins, or where it was resumed last.
    pub fn begins(&self) -> &Point {
        self.settings.resumed.last().map_or(&self.settings.start, |resumed| &resumed.at)
    }

    /// The steps of each axis at the place where the program begins, or where it was resumed last.
    pub fn start_steps(&self) -> Vec<i64> {
        self.steps(self.begins())
    }

    /// The same program, resumed at a place where it has waited.
    pub fn resumed(&self, change: Resumed) -> Self {
        let mut this = self.clone();
        this.settings.resumed.push(change);
        this
    }

    /// Checks that the file is still the one that was opened.
    ///
    /// # Errors
    /// [`Fault::Changed`].
    pub fn same(&self) -> Result<(), ProgramError> {
        let now = std::fs::metadata(&self.path).map(|there| (there.len(), there.modified().ok()));
        match now {
            Ok(now) if now == self.signs => Ok(()),
            _ => Err(ProgramError::new(&self.path, 0, Fault::Changed)),
        }
    }
}

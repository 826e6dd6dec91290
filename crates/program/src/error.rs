//! What can be wrong with a program on a machine, where it is, and what to do.

use crate::letter::{letter_of, unit};
use carrystep_files::unit::digits;
use carrystep_files::{InputError, SourceText};
use carrystep_gcode::{ErrorKind, GcodeError};
use carrystep_job::JobError;
use std::fmt;
use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Most bytes of a line that an error quotes; the interpreter reads no longer ones.
const LONGEST_LINE: u64 = 1 << 16;

/// A mistake without its place.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Fault {
    /// The program is not G-code that can be run.
    #[error(transparent)]
    Gcode(ErrorKind),
    /// The planner refuses the path.
    #[error("{}", planner_message(.0))]
    Plan(JobError),
    /// A move leaves `travel`.
    #[error("{axis} would go to {place} {unit}, beyond its travel of {low} to {high} {unit}")]
    Travel {
        /// Name of the axis.
        axis: String,
        /// Its unit.
        unit: &'static str,
        /// Where it would go.
        place: String,
        /// The lowest place.
        low: String,
        /// The highest place.
        high: String,
    },
    /// A move of a letter that the machine does not have.
    #[error("{0} moves, and the machine has no axis {0}")]
    NoAxis(char),
    /// An axis whose name is no letter.
    #[error("the axis '{0}' has no letter in G-code")]
    AxisName(String),
    /// An axis in another unit than G-code has.
    #[error("the axis '{axis}' is in {unit}, and G-code moves it in {wanted}")]
    Unit {
        /// Name of the axis.
        axis: String,
        /// Its unit.
        unit: String,
        /// The unit that it must have.
        wanted: &'static str,
    },
    /// An axis in mm behind one in degrees.
    #[error("the axis '{0}' comes after an axis in degrees")]
    Order(String),
    /// A machine whose moves start at the edge of a step.
    #[error("the machine's moves start with phase = \"zero\"")]
    Phase,
    /// M4 on a machine whose spindle has no output for its direction.
    #[error("M4: no output of the machine reverses the spindle")]
    NoReverse,
    /// A speed above the spindle's.
    #[error("the spindle would turn at {rpm} turns per minute: it has {most} at most")]
    SpindleSpeed {
        /// The speed, turns per minute.
        rpm: f64,
        /// `spindle_rpm` of the machine.
        most: u32,
    },
    /// M62 to M65 name an output that does not exist.
    #[error("output {index} would change: the machine has {count} outputs, numbered from 0")]
    NoOutput {
        /// Number of the output.
        index: u32,
        /// Number of outputs of the machine.
        count: u32,
    },
    /// M62 to M65 name an output that the machine file gives another use.
    #[error("output {index} would change: it is the machine's `{key}`")]
    OutputInUse {
        /// Number of the output.
        index: u32,
        /// Key of the machine file.
        key: &'static str,
    },
    /// M67 or M68 name something else than a PWM that is free.
    #[error("analog output {index} would change: the machine has no such output")]
    NoAnalogOutput {
        /// Number of the output.
        index: u32,
    },
    /// M67 or M68 give a duty that no PWM has.
    #[error("the PWM would have a duty of {value}: it is from 0 to 1")]
    Duty {
        /// The value.
        value: f64,
    },
    /// The plan has no row: nothing could be simulated or checked.
    #[error(
        "the program does nothing on this machine: no axis moves by a step, no output changes, and \
         there is no dwell"
    )]
    Nothing,
    /// The program has no such executed block.
    #[error("there is no block {block}: the program has {last}, numbered from 1")]
    NoBlock {
        /// The block.
        block: u64,
        /// The number of the last one.
        last: u64,
    },
    /// A program is entered in its middle, and where it goes depends on where it began.
    #[error("the place of {0} depends on where the program began, which is not known")]
    Began(char),
    /// The program has moved z, and its highest z may be that where it began.
    #[error(
        "the highest z before this block depends on where the program began, which is not known"
    )]
    Height,
    /// The height of an entry is not above the place.
    #[error("the safe height z = {safe} mm is below {place} mm, where the block begins")]
    SafeHeight {
        /// The height, mm.
        safe: f64,
        /// z where the block begins, mm.
        place: f64,
    },
    /// A height is given for a machine without z.
    #[error("a safe height is given, and the machine has no axis z")]
    NoHeight,
    /// The file is not the one that was read first.
    #[error("the file has changed while it was used")]
    Changed,
    /// Something was changed while the program waited, and the line of the wait goes on with a move
    /// that was computed before.
    #[error(
        "the line in which the program waits has a move of its own, which knows nothing of what was \
         changed in the pause"
    )]
    ResumedAmidLine,
}

impl Fault {
    /// What to do about it.
    pub fn help(&self) -> Option<String> {
        Some(match self {
            Self::Gcode(ErrorKind::TooManyBlocks(_)) => {
                "check the condition of the loop, or allow more with --blocks".into()
            }
            Self::Gcode(kind) => kind.help().to_owned(),
            Self::Plan(JobError::Broken { .. } | JobError::Ended) => {
                "this is a bug of carrystep; please report it with the program".into()
            }
            Self::Plan(JobError::SlowLine { .. }) => {
                "raise baud in [machine.link], or use spi = true there".into()
            }
            Self::Plan(_) => return None,
            Self::Travel { .. } => {
                "check the work offsets and --at, or correct travel in the machine file".into()
            }
            Self::NoAxis(axis) => {
                format!("remove {axis} from the program, or add a [[machine.axis]] of this name")
            }
            Self::AxisName(_) => "call the axes of a machine for jobs x, y, z, a, b, c".into(),
            Self::Unit { wanted, .. } => {
                format!("give the axis unit = \"{wanted}\" and its steps_per_unit")
            }
            Self::Order(_) => "write x, y and z before a, b and c in the machine file".into(),
            Self::Phase => "remove phase from the machine file".into(),
            Self::NoReverse => {
                "use M3, or give spindle_reverse an output in [machine.outputs]".into()
            }
            Self::SpindleSpeed { .. } => {
                "lower S, or correct spindle_rpm in the machine file".into()
            }
            Self::NoOutput { .. } => "correct P, or raise count in [machine.outputs]".into(),
            Self::OutputInUse { .. } => {
                "use M3 to M9 for it, or take another output in [machine.outputs]".into()
            }
            Self::NoAnalogOutput { .. } => "analog output 0 is the PWM, if [machine.outputs] has \
                                            pwm_divider and no spindle_rpm"
                .into(),
            Self::Duty { .. } => "divide Q by its greatest value".into(),
            Self::Nothing => "check that this is the program that you mean, and that its end is \
                              behind its moves"
                .into(),
            Self::NoBlock { .. } => {
                "`carrystep plan JOB.ngc --list-blocks` shows the blocks".into()
            }
            Self::Began(axis) => {
                format!("give the machine place where it began, with --began-at {axis}=...")
            }
            Self::Height => {
                "give a safe height with --safe-z, or the machine place where it began, with \
                             --began-at z=..."
                    .into()
            }
            Self::SafeHeight { .. } => "give a greater --safe-z, or none".into(),
            Self::NoHeight => "leave out --safe-z".into(),
            Self::ResumedAmidLine => {
                "end the program, and write the move in a line of its own behind the wait".into()
            }
            Self::Changed => "leave the file alone until the command has ended".into(),
        })
    }
}

/// The planner's message without its line, which the place of the error has.
fn planner_message(error: &JobError) -> String {
    let text = error.to_string();
    let line = format!("line {}", planner_line(error));
    let rest = text.strip_prefix(&line).and_then(|rest| rest.strip_prefix([':', ',']));
    rest.map_or_else(|| text.clone(), |rest| rest.trim_start().to_owned())
}

/// The line of the planner's error; 0 if it belongs to none.
fn planner_line(error: &JobError) -> u64 {
    match error {
        JobError::Coordinates { line, .. }
        | JobError::Number { line, .. }
        | JobError::Radii { line, .. }
        | JobError::Arc { line }
        | JobError::Travel { line, .. }
        | JobError::Far { line, .. }
        | JobError::Broken { line, .. } => *line,
        _ => 0,
    }
}

/// A mistake and its place.
#[derive(Debug, Clone)]
pub struct ProgramError {
    /// The mistake.
    pub fault: Box<Fault>,
    /// The program or machine file.
    pub path: PathBuf,
    /// Line in it, from 1; 0 if the mistake belongs to the whole file.
    pub line: u64,
    /// Column in characters, from 1; 0 if the mistake belongs to the whole line.
    pub column: u32,
}

impl ProgramError {
    /// A mistake in a line of a file; line 0 is the whole file.
    pub fn new(path: &Path, line: u64, fault: Fault) -> Self {
        Self { fault: Box::new(fault), path: path.to_owned(), line, column: 0 }
    }

    /// A mistake that the interpreter has found.
    pub(crate) fn of_gcode(path: &Path, error: GcodeError) -> Self {
        let GcodeError { line, column, kind, .. } = error;
        Self { column, ..Self::new(path, line, Fault::Gcode(kind)) }
    }

    /// A path that the planner refuses, on this machine.
    pub(crate) fn of_planner(
        path: &Path,
        machine: &carrystep_files::Machine,
        error: JobError,
    ) -> Self {
        let line = planner_line(&error);
        Self::new(path, line, Fault::of_planner(machine, error))
    }
}

impl Fault {
    /// What the planner refuses, in the units of the machine.
    pub(crate) fn of_planner(machine: &carrystep_files::Machine, error: JobError) -> Self {
        match &error {
            JobError::Travel { axis, steps, low, high, .. } => {
                let known = machine.axes.iter().find(|known| known.letter == *axis);
                let steps_per_unit = known.map_or(1.0, |axis| axis.unit.steps);
                let [place, low, high] =
                    [steps, low, high].map(|&steps| digits(steps as f64 / steps_per_unit));
                let unit = letter_of(axis).map_or("", unit);
                Self::Travel { axis: axis.clone(), unit, place, low, high }
            }
            _ => Self::Plan(error),
        }
    }
}

impl fmt::Display for ProgramError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        for number in [self.line, self.column.into()].into_iter().take_while(|&n| n > 0) {
            write!(f, ":{number}")?;
        }
        write!(f, ": {}", self.fault)
    }
}

impl std::error::Error for ProgramError {}

impl From<ProgramError> for InputError {
    /// Reads the line of the mistake again, so that the message can quote it.
    fn from(error: ProgramError) -> Self {
        let excerpt = Excerpt::read(&error.path, error.line);
        let mut told = match excerpt {
            Some(Excerpt { source, start, length, lines_before }) => {
                let line = &source.text[start..start + length];
                let column = (error.column.max(1) - 1) as usize;
                let at = line.char_indices().nth(column).map_or(length, |(at, _)| at);
                // Without a column, the whole line is marked.
                let end = if error.column == 0 { length } else { (at + 1).min(length) };
                let end = (end..=length).find(|&end| line.is_char_boundary(end)).unwrap_or(length);
                let place = start + at..start + end;
                Self { lines_before, ..Self::at(&source, place, error.fault.to_string()) }
            }
            None => Self::new(error.to_string()),
        };
        told.help = error.fault.help();
        told
    }
}

/// A line of a file with the lines before and behind it.
struct Excerpt {
    source: SourceText,
    start: usize,
    length: usize,
    lines_before: usize,
}

impl Excerpt {
    /// `None` if the file has no such line, or can no longer be read.
    fn read(path: &Path, line: u64) -> Option<Self> {
        let mut file = BufReader::new(File::open(path).ok().filter(|_| line > 0)?);
        let (mut before, mut text) = (String::new(), String::new());
        let (mut start, mut length) = (0, 0);
        for number in 1..=line + 1 {
            let mut bytes = Vec::new();
            let read = (&mut file).take(LONGEST_LINE).read_until(b'\n', &mut bytes).ok()?;
            if read == 0 && number <= line {
                return None;
            }
            let shown = String::from_utf8_lossy(&bytes);
            if number < line {
                before = shown.into_owned();
                continue;
            }
            if number == line {
                start = before.len();
                length = shown.trim_end_matches(['\r', '\n']).len();
                text = std::mem::take(&mut before);
            }
            text.push_str(&shown);
        }
        let shown_before = u64::from(start > 0);
        let lines_before = usize::try_from(line - 1 - shown_before).ok()?;
        let source = SourceText { path: path.to_owned(), text: text.into() };
        Some(Self { source, start, length, lines_before })
    }
}

//! What a plan does with its time, for `--json` and for the page of `--report`.

use crate::failure::Failure;
use crate::output::OutputFile;
use crate::program_table::JERK_TIME;
use carrystep_files::{AxisLimit, Machine};
use carrystep_plan::PlannedMove;
use carrystep_program::{ProgramError, ProgramFile, Row, Survey, SurveyedRows};
use carrystep_report::{
    AxisSetup, Detail, Drawing, Motion, PageError, Recorder, TimeUse, common_rows, write_page,
};
use serde::Serialize;
use std::collections::BTreeSet;
use std::io::{BufRead as _, BufReader, Read as _};

/// Most characters of a line that the page shows.
const LONGEST_SHOWN: usize = 120;
/// Most bytes of a line; the interpreter reads no longer ones.
const LONGEST_LINE: u64 = 1 << 16;

/// What a plan does with its time.
#[derive(Debug)]
pub struct Recorded {
    pub time_use: TimeUse,
    /// If a page is wanted.
    pub drawing: Option<Drawing>,
}

/// What is recorded of a plan: more if a page is wanted.
pub fn detail(report: bool) -> Detail {
    if report { Detail::Drawing } else { Detail::Figures }
}

/// Records the moves of a file.
#[derive(Debug)]
pub struct MoveRecorder {
    recorder: Recorder,
    moves: u64,
}

impl MoveRecorder {
    /// A recorder for the moves of this machine, which begin at zero.
    pub fn new(machine: &Machine, detail: Detail) -> Self {
        let axes = machine.axes.iter().enumerate().map(|(number, axis)| {
            let linear = axis.unit.name == machine.axes[0].unit.name;
            let jerk = axis.jerk_limit.as_ref().map(|limit| limit.float);
            AxisSetup { linear, ..setup(machine, number, 0.0, jerk) }
        });
        let tick_seconds = machine.timebase.tick_seconds();
        Self { recorder: Recorder::new(axes.collect(), tick_seconds, false, detail), moves: 0 }
    }

    /// Adds the next move.
    pub fn add(&mut self, planned: &PlannedMove) {
        self.moves += 1;
        let axes: Vec<_> = planned.axes.iter().map(|axis| &axis.segments[..]).collect();
        for (ticks, segments) in common_rows(&axes) {
            self.recorder.row(&Motion {
                ticks,
                segments: &segments,
                line: self.moves,
                feed: f64::INFINITY,
                given: planned.given,
                off: 0.0,
                corner: 0.0,
            });
        }
    }

    /// The plan has ended.
    pub fn finish(self) -> Recorded {
        let (time_use, drawing) = self.recorder.finish();
        Recorded { time_use, drawing }
    }
}

/// The rows of a program, of which figures and drawing are kept as they pass.
#[derive(Debug)]
pub struct RecordedRows {
    rows: SurveyedRows,
    recorder: Recorder,
}

impl RecordedRows {
    /// Plans a program from its beginning.
    pub fn new(file: &ProgramFile, detail: Detail) -> Result<Self, ProgramError> {
        Ok(Self { rows: SurveyedRows::new(file)?, recorder: of_program(file, detail) })
    }

    /// What was kept; after the last row, of the program.
    pub fn finish(self, file: &ProgramFile) -> (Survey, Recorded) {
        let (time_use, drawing) = self.recorder.finish();
        (self.rows.finish(file), Recorded { time_use, drawing })
    }
}

impl Iterator for RecordedRows {
    type Item = Result<Row, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        let row = self.rows.next()?;
        if let Ok(row) = &row {
            self.recorder.row(&motion(row));
        }
        Some(row)
    }
}

/// A recorder for the rows of a program.
fn of_program(file: &ProgramFile, detail: Detail) -> Recorder {
    let machine = file.machine();
    let starts = file.steps(&file.settings().start);
    let axes = machine.axes.iter().zip(file.letters().of_axes()).enumerate();
    let axes = axes.map(|(number, (axis, &letter))| {
        let jerk = axis.jerk_limit.as_ref().map(|limit| limit.float);
        let jerk = jerk.unwrap_or_else(|| axis.accel_limit.float / JERK_TIME);
        let start = starts[number] as f64 / axis.unit.steps;
        let unit = carrystep_program::unit(letter);
        let linear = unit == "mm";
        AxisSetup { unit: unit.to_owned(), linear, ..setup(machine, number, start, Some(jerk)) }
    });
    Recorder::new(axes.collect(), machine.timebase.tick_seconds(), true, detail)
}

/// A row of a program.
fn motion(row: &Row) -> Motion<'_> {
    let Row { ticks, segments, line, feed, off, corner, .. } = row;
    let (ticks, line, feed, off, corner) = (*ticks, *line, *feed, *off, *corner);
    Motion { ticks, segments, line, feed, given: false, off, corner }
}

/// The axis of this number, with its jerk limit in steps/s^3.
fn setup(machine: &Machine, number: usize, start: f64, jerk: Option<f64>) -> AxisSetup {
    let axis = &machine.axes[number];
    let steps = axis.unit.steps;
    let one = |motor: usize| {
        let mut motors = vec![0.0; machine.axes.len()];
        motors[motor] = 1.0;
        (motor, machine.letter_steps(number, &motors))
    };
    let leads = machine.leader(number) == number;
    let name = &axis.name;
    let limit = |limit: &AxisLimit| Some(limit.float / steps);
    AxisSetup {
        name: axis.name.clone(),
        unit: axis.unit.name.clone(),
        steps_per_unit: steps,
        start,
        limits: [limit(&axis.speed_limit), limit(&axis.accel_limit), jerk.map(|jerk| jerk / steps)],
        linear: true,
        counts: if leads { machine.step_of_tool(number) } else { 0.0 },
        letter: machine.leaders().into_iter().map(one).filter(|(_, part)| *part != 0.0).collect(),
        title: match machine.belt(number) {
            Some(belt) => format!("motor {name}: {belt}"),
            None => format!("axis {name}"),
        },
    }
}

/// Writes the page of a plan into an output. `document` is what `--json` prints.
pub fn write(
    out: &mut OutputFile,
    title: &str,
    document: &impl Serialize,
    recorded: &Recorded,
    source: &[(u64, String)],
) -> Result<(), Failure> {
    let Some(drawing) = &recorded.drawing else { return Ok(()) };
    write_page(out, title, document, drawing, source).map_err(|error| match error {
        PageError::Write(error) => Failure::input(error.to_string()),
        other => Failure::Run(other.to_string()),
    })
}

/// The lines of a program that the page names one by one. A program that calls subroutines in
/// other files has none, because their numbers would be taken for its own.
pub fn source(
    file: &ProgramFile,
    one_file: bool,
    time_use: &TimeUse,
) -> Result<Vec<(u64, String)>, Failure> {
    let of = |cause: &carrystep_report::TimeOf| {
        cause.lines.iter().map(|lines| lines.from).collect::<Vec<_>>()
    };
    let wanted: BTreeSet<u64> = time_use.causes.iter().flat_map(of).collect();
    let mut found = Vec::new();
    let alone = one_file && time_use.lines_together == 1;
    let Some(&last) = wanted.last().filter(|_| alone) else { return Ok(found) };
    let failed = |error: &dyn std::fmt::Display| {
        Failure::input(format!("{}: {error}", file.path().display()))
    };
    let mut text = BufReader::new(carrystep_files::open(file.path()).map_err(|e| failed(&e))?);
    for number in 1..=last {
        let mut bytes = Vec::new();
        let mut line = (&mut text).take(LONGEST_LINE);
        if line.read_until(b'\n', &mut bytes).map_err(|error| failed(&error))? == 0 {
            break;
        }
        if wanted.contains(&number) {
            let line = String::from_utf8_lossy(&bytes);
            found.push((number, line.trim().chars().take(LONGEST_SHOWN).collect()));
        }
    }
    Ok(found)
}

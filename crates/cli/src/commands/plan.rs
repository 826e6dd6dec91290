//! `carrystep plan`: the integer segments of a move file, or the reason why it cannot be planned.

use crate::arguments::PlanArguments as Arguments;
use crate::commands::plan_program;
use crate::document::Named;
use crate::failure::Failure;
use crate::json;
use crate::output::OutputFile;
use crate::segments::{SegmentJson, add_segment, segments};
use crate::spool::Spool;
use crate::table::{self, LimitsJson};
use crate::{job, output, recorded};
use carrystep_core::Segment;
use carrystep_files::{Axis, Machine, MoveSource};
use carrystep_plan::PlannedMove;
use carrystep_program::is_program;
use carrystep_report::TimeUse;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write as _;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct Planned<'a> {
    passed: bool,
    tick_ns: u64,
    limits: LimitsJson,
    /// Where the time goes.
    time_use: TimeUse,
    moves: Vec<MoveJson<'a>>,
}

/// What `--json-lines` prints for each move.
#[derive(JsonSchema, Serialize)]
pub struct PlannedLine<'a> {
    /// The number of the move, counted from 1.
    number: u64,
    #[serde(flatten)]
    planned: MoveJson<'a>,
}

/// What `--json-lines` prints at the end.
#[derive(JsonSchema, Serialize)]
pub struct PlanEnd {
    passed: bool,
    tick_ns: u64,
    /// Number of moves.
    moves: u64,
    limits: LimitsJson,
    /// Where the time goes.
    time_use: TimeUse,
}

#[derive(JsonSchema, Serialize)]
struct MoveJson<'a> {
    start_tick: u64,
    rest_ticks: u64,
    ticks: u64,
    seconds: f64,
    axes: Vec<AxisJson<'a>>,
}

#[derive(JsonSchema, Serialize)]
struct AxisJson<'a> {
    axis: &'a str,
    shape: &'a str,
    steps: i64,
    /// Exact target minus rounded target so far, in steps.
    rounding_steps: f64,
    #[serde(serialize_with = "segments")]
    #[schemars(with = "Vec<SegmentJson>")]
    segments: &'a [Segment],
}

/// Plans a move file or a program and shows the plan.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if is_program(&arguments.file) {
        return plan_program::run(arguments);
    }
    arguments.program.refuse_for_moves()?;
    if arguments.list_blocks {
        let message = "--list-blocks is an option of G-code programs";
        return Err(Failure::input(message));
    }
    let source = job::load(&arguments.file, arguments.fit_ns)?;
    let report = arguments.report.as_deref().map(OutputFile::create).transpose()?;
    if arguments.json_lines {
        lines(source, report)
    } else if arguments.json {
        document(source, report)
    } else {
        table(source, arguments.segments, report)
    }
}

/// Prints a document with all moves.
fn document(source: MoveSource, report: Option<OutputFile>) -> Result<(), Failure> {
    let machine = source.machine.clone();
    let (mut moves, mut separator) = (Spool::new(), "");
    let end = planned(source, report, |planned| {
        let text = json::indented(&move_json(&machine, planned))
            .map_err(|error| Failure::Run(error.to_string()))?;
        moves.add(|all| {
            all.push_str(separator);
            // The moves are within two others, which serde_json indents by two blanks each.
            for line in text.lines() {
                all.push_str("\n    ");
                all.push_str(line);
            }
        })?;
        separator = ",";
        Ok(())
    })?;
    moves.add(|all| all.push_str("\n  "))?;
    let PlanEnd { passed, tick_ns, limits, time_use, .. } = end;
    let around = Planned { passed, tick_ns, limits, time_use, moves: Vec::new() };
    output::print_json_around(&around, || moves.print())
}

/// Prints each move as soon as it is planned.
fn lines(source: MoveSource, report: Option<OutputFile>) -> Result<(), Failure> {
    let machine = source.machine.clone();
    let mut number = 0;
    let end = planned(source, report, |planned| {
        number += 1;
        output::print_json_line(&PlannedLine { number, planned: move_json(&machine, planned) })
    })?;
    output::print_json(&end)
}

/// Plans all moves, and writes the page if one is wanted.
fn planned(
    source: MoveSource,
    report: Option<OutputFile>,
    watch: impl FnMut(&PlannedMove) -> Result<(), Failure>,
) -> Result<PlanEnd, Failure> {
    let (machine, title) = (source.machine.clone(), source.path.display().to_string());
    let detail = recorded::detail(report.is_some());
    let (survey, recorded) = job::recorded(source, detail, watch)?;
    let end = PlanEnd {
        passed: true,
        tick_ns: machine.timebase.tick_ns(),
        moves: survey.totals().moves,
        limits: table::limits(&machine, survey.totals()),
        time_use: recorded.time_use.clone(),
    };
    if let Some(mut out) = report {
        recorded::write(&mut out, &title, &Named::new(&end), &recorded, &[])?;
        out.keep()?;
    }
    Ok(end)
}

fn move_json<'a>(machine: &'a Machine, planned: &'a PlannedMove) -> MoveJson<'a> {
    let axes = planned.axes.iter().zip(&machine.axes);
    MoveJson {
        start_tick: planned.start_tick,
        rest_ticks: planned.rest_ticks,
        ticks: planned.ticks,
        seconds: planned.seconds,
        axes: axes
            .map(|(planned, axis)| AxisJson {
                axis: &axis.name,
                shape: planned.shape,
                steps: planned.steps,
                rounding_steps: planned.rounding_steps,
                segments: &planned.segments,
            })
            .collect(),
    }
}

/// Prints a table for each move, and one of the limits.
fn table(source: MoveSource, segments: bool, report: Option<OutputFile>) -> Result<(), Failure> {
    let machine = source.machine.clone();
    let (mut moves, mut number) = (Spool::new(), 0);
    let end = planned(source, report, |planned| {
        number += 1;
        moves.add(|text| add_move(text, &machine, (number, planned), segments))
    })?;
    moves.print()?;
    output::print(&format!("{}\n", end.limits))
}

/// Adds the table of a move, which has this number in the file.
fn add_move(
    text: &mut String,
    machine: &Machine,
    (number, planned): (u64, &PlannedMove),
    segments: bool,
) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{}", heading(number, planned));
    let rows = planned.axes.iter().zip(&machine.axes);
    let timebase = &machine.timebase;
    let cells = rows.clone().map(|(planned, Axis { name, unit, .. })| {
        [
            name.clone(),
            planned.steps.to_string(),
            unit.own(planned.steps as f64, 0),
            planned.shape.to_owned(),
            planned.segments.len().to_string(),
            unit.own(planned.peaks.steps_per_s(timebase), 1),
            unit.own(planned.peaks.steps_per_s2(timebase), 2),
        ]
    });
    let head = ["axis", "steps", "distance", "shape", "seg.", "speed", "acceleration"];
    let _ = table::columns(text, head, cells, |column| column == 0 || column == 3);
    for (planned, axis) in rows {
        text.push_str(&rounded(axis, planned.rounding_steps));
        for (index, segment) in planned.segments.iter().filter(|_| segments).enumerate() {
            let name = if index == 0 { axis.name.as_str() } else { "" };
            add_segment(text, name, segment);
        }
    }
}

/// The line that reports the rounding to whole steps; empty if there is none.
fn rounded(axis: &Axis, rounding: f64) -> String {
    // A rounding that four decimal places do not show is not reported.
    if rounding.abs() < 5e-5 {
        return String::new();
    }
    let Axis { name, unit, .. } = axis;
    let own = if unit.is_step() { String::new() } else { format!(", {}", unit.own(-rounding, 0)) };
    format!("{name} is rounded by {:+.4} steps{own}\n", -rounding)
}

fn heading(number: u64, planned: &PlannedMove) -> String {
    let rest = match planned.rest_ticks {
        0 => String::new(),
        ticks => format!(" after {ticks} ticks of rest for set-up and hold"),
    };
    let PlannedMove { kind, seconds, ticks, .. } = planned;
    format!("move {number}: {kind}, {seconds} s, {ticks} ticks{rest}")
}

//! `carrystep plan`: the integer segments of a move file, or the reason why it cannot be planned.

use crate::arguments::PlanArguments as Arguments;
use crate::failure::{Failure, refused};
use crate::table::{self, LimitsJson, LimitsSum};
use crate::{interrupt, job, output};
use carrystep_core::Segment;
use carrystep_files::{Axis, Move, MoveFile};
use carrystep_plan::{Plan, PlannedMove, plan, planned_moves};
use schemars::JsonSchema;
use serde::{Serialize, Serializer};
use std::fmt::Write as _;

/// Number of bytes from which the table is printed.
const BLOCK: usize = 1 << 16;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct Planned<'a> {
    passed: bool,
    tick_ns: u64,
    limits: LimitsJson,
    moves: Vec<MoveJson<'a>>,
}

/// What `--json-lines` prints for each move.
#[derive(JsonSchema, Serialize)]
pub struct PlannedLine<'a> {
    /// The number of the move, counted from 1.
    number: usize,
    #[serde(flatten)]
    planned: MoveJson<'a>,
}

/// What `--json-lines` prints at the end.
#[derive(JsonSchema, Serialize)]
pub struct PlanEnd {
    passed: bool,
    tick_ns: u64,
    /// Number of moves.
    moves: usize,
    limits: LimitsJson,
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

/// Numbers of 64 bits are strings, because many JSON readers keep only 53 bits.
#[derive(JsonSchema, Serialize)]
struct SegmentJson {
    ticks: u32,
    v: String,
    a: String,
    j: String,
    last: bool,
}

/// Writes the segments one after another. All of them as text would need several times the memory
/// of the plan.
fn segments<S: Serializer>(segments: &[Segment], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(segments.iter().map(|s| SegmentJson {
        ticks: s.ticks,
        v: s.v.to_string(),
        a: s.a.to_string(),
        j: s.j.to_string(),
        last: s.last,
    }))
}

/// Plans a move file and shows the plan.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let file = job::load(&arguments.file, arguments.fit_ns)?;
    if arguments.json_lines {
        return lines(&file);
    }
    let plan = plan::<f64>(&file).map_err(|error| refused(&file, &error))?;
    if arguments.json {
        return output::print_json(&json(&file, &plan));
    }
    table(&file, &plan, arguments.segments)
}

fn json<'a>(file: &'a MoveFile, plan: &'a Plan) -> Planned<'a> {
    let moves = plan.moves.iter().zip(&file.moves);
    Planned {
        passed: true,
        tick_ns: plan.build.timebase.tick_ns(),
        limits: table::limits(file, plan),
        moves: moves.map(|(planned, asked)| move_json(file, planned, asked)).collect(),
    }
}

/// Prints each move as soon as it is planned.
fn lines(file: &MoveFile) -> Result<(), Failure> {
    let mut sum = LimitsSum::new(&file.machine);
    let moves = planned_moves::<f64>(file).map_err(|error| refused(file, &error))?;
    for (index, (planned, asked)) in moves.zip(&file.moves).enumerate() {
        interrupt::check()?;
        let planned = planned.map_err(|error| refused(file, &error))?;
        sum.add(&planned);
        let line = PlannedLine { number: index + 1, planned: move_json(file, &planned, asked) };
        output::print_json_line(&line)?;
    }
    output::print_json(&PlanEnd {
        passed: true,
        tick_ns: file.machine.timebase.tick_ns(),
        moves: file.moves.len(),
        limits: sum.limits(),
    })
}

fn move_json<'a>(file: &'a MoveFile, planned: &'a PlannedMove, asked: &Move) -> MoveJson<'a> {
    MoveJson {
        start_tick: planned.start_tick,
        rest_ticks: planned.rest_ticks,
        ticks: planned.ticks,
        seconds: planned.seconds,
        axes: (planned.axes.iter().zip(&file.machine.axes).zip(&asked.rounding))
            .map(|((planned, axis), &rounding_steps)| AxisJson {
                axis: &axis.name,
                shape: planned.shape,
                steps: planned.steps,
                rounding_steps,
                segments: &planned.segments,
            })
            .collect(),
    }
}

/// Prints the table in blocks, because that of many moves has tens of megabytes.
fn table(file: &MoveFile, plan: &Plan, segments: bool) -> Result<(), Failure> {
    let mut text = String::new();
    for (index, planned) in plan.moves.iter().enumerate() {
        add_move(&mut text, file, (index, planned), segments);
        if text.len() >= BLOCK {
            output::print(&text)?;
            text.clear();
        }
    }
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{}", table::limits(file, plan));
    output::print(&text)
}

/// Adds the table of a move, which has this index in the file.
fn add_move(
    text: &mut String,
    file: &MoveFile,
    (index, planned): (usize, &PlannedMove),
    segments: bool,
) {
    let asked = &file.moves[index];
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{}", heading(index + 1, planned, &asked.profile.to_string()));
    let rows = planned.axes.iter().zip(&file.machine.axes).zip(&asked.rounding);
    let timebase = &file.machine.timebase;
    let cells = rows.clone().map(|((planned, Axis { name, unit, .. }), _)| {
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
    for ((planned, axis), rounding) in rows {
        text.push_str(&rounded(axis, *rounding));
        for (index, Segment { ticks, v, a, j, last }) in
            planned.segments.iter().filter(|_| segments).enumerate()
        {
            let name = if index == 0 { axis.name.as_str() } else { "" };
            let mark = if *last { "  last" } else { "" };
            let _ =
                writeln!(text, "{name:<4}  {ticks:>7} ticks  V {v:>19}  A {a:>19}  J {j}{mark}");
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

fn heading(number: usize, planned: &PlannedMove, profile: &str) -> String {
    let rest = match planned.rest_ticks {
        0 => String::new(),
        ticks => format!(" after {ticks} ticks of rest for set-up and hold"),
    };
    format!("move {number}: {profile}, {} s, {} ticks{rest}", planned.seconds, planned.ticks)
}

//! The outcome of a run on a board, as it is printed.
//!
//! The fields are names in the JSON of `carrystep run`; its schema is generated from them.

use crate::control::StoppedBy;
use crate::found::{BlockFound, OverridesFound};
use crate::work::NamedOffset;
use carrystep_files::Unit;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// How a run on a board ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum How {
    /// All moves were made.
    Done,
    /// Stopped on request, by Ctrl-C or `carrystep stop`.
    Stopped,
    /// The machine stopped by itself.
    Fault,
}

/// The outcome of a run on a board; `--json` prints it as it is.
#[derive(Debug, JsonSchema, Serialize)]
pub struct Driven {
    /// All moves were made, and the machine is where they end.
    pub passed: bool,
    /// The port.
    pub port: String,
    /// The gateware's build id.
    pub build: String,
    /// How it ended.
    pub ended: How,
    /// The source of the stop, if it was requested.
    pub stopped_by: Option<StoppedBy>,
    /// Why the machine stopped by itself, if it did.
    pub cause: Option<&'static str>,
    /// The axes that caused this stop.
    pub culprits: Vec<Culprit>,
    /// The cause in a sentence.
    pub meaning: Option<&'static str>,
    /// What the user must do about it.
    pub remedy: Option<&'static str>,
    /// Seconds that the plan takes.
    pub planned_s: f64,
    /// Seconds that the run took, including power-up and status requests.
    pub run_s: f64,
    /// The G-code program, if it is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub program: Option<ProgramDriven>,
    /// The work offsets that are not zero, if a jog has set some.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub offsets: Option<Vec<NamedOffset>>,
    /// Each axis.
    pub axes: Vec<AxisDriven>,
}

/// What is reported of a G-code program beside the axes.
#[derive(Debug, Clone, JsonSchema, Serialize)]
pub struct ProgramDriven {
    /// The last line that was read.
    pub lines: u64,
    /// The axes whose `travel` was a bound: those that are homed and have one.
    pub soft_limits: Vec<String>,
    /// How long the motion goes on at least if the host sends nothing more, ms.
    pub horizon_ms: u64,
    /// How often the program has waited for somebody to let it go on: at M0, M1, M6 and in holds.
    pub waits: u64,
    /// How often a hold has cut the queues of the board.
    pub cuts: u32,
    /// The overrides that were in force last.
    pub overrides: OverridesFound,
    /// The block in which the tool was when the program ended early; `--from-block` goes on there.
    pub block: Option<BlockFound>,
    /// The machine place where the program began, as `--began-at` takes it.
    pub began_at: String,
}

/// An axis that caused a stop.
#[derive(Debug, JsonSchema, Serialize)]
pub struct Culprit {
    /// Its name.
    pub axis: String,
    /// Direction in which it was last seen moving: 1 or -1; 0 if it was not seen moving.
    pub direction: i8,
}

/// One axis.
#[derive(Debug, JsonSchema, Serialize)]
pub struct AxisDriven {
    /// Its name.
    pub axis: String,
    /// Position register before, steps.
    pub before: i32,
    /// Position register after, steps.
    pub position: i32,
    /// Steps of the plan.
    pub steps_planned: i64,
    /// The unit of the axis.
    pub unit: String,
    /// Steps per unit, as the nearest float.
    pub steps_per_unit: f64,
}

/// Tells that the machine stopped by itself, why, and what to do.
pub fn tell_fault(
    f: &mut fmt::Formatter<'_>,
    (cause, culprits): (Option<&str>, &[Culprit]),
    then: &str,
    remedy: Option<&str>,
) -> fmt::Result {
    let names: Vec<&str> = culprits.iter().map(|culprit| &*culprit.axis).collect();
    let from =
        if names.is_empty() { String::new() } else { format!(", from {}", names.join(", ")) };
    writeln!(f, "STOPPED by the machine: {}{from}{then}", cause.unwrap_or("?"))?;
    remedy.map_or(Ok(()), |remedy| writeln!(f, "to do: {remedy}"))
}

impl fmt::Display for Driven {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: build {}", self.port, self.build)?;
        let head = ["before", "planned", "position", "distance", "at"]
            .map(|head| format!("  {head:>11}"))
            .concat();
        writeln!(f, "{:<6}{head}", "axis")?;
        for AxisDriven { axis, before, position, steps_planned, unit, steps_per_unit } in &self.axes
        {
            let unit = Unit { name: unit.clone(), steps: *steps_per_unit };
            let [planned, at] =
                [*steps_planned as f64, f64::from(*position)].map(|steps| unit.own(steps, 0));
            writeln!(
                f,
                "{axis:<6}  {before:>11}  {steps_planned:>+11}  {position:>11}  {planned:>11}  {at:>11}"
            )?;
        }
        self.program.iter().try_for_each(|program| write!(f, "{program}"))?;
        self.offsets.iter().flatten().try_for_each(|offset| writeln!(f, "{offset}"))?;
        match (self.ended, self.passed) {
            (How::Done, true) => f.write_str("DONE\n"),
            (How::Done, false) => {
                f.write_str("FAILED: the positions are not where the moves end\n")
            }
            (How::Stopped, _) => {
                let by = self.stopped_by.unwrap_or(StoppedBy::Interrupt);
                writeln!(f, "STOPPED by {by}; the positions are valid")
            }
            (How::Fault, _) => {
                let cause = self.cause.unwrap_or("?");
                write!(f, "STOPPED by the machine: {cause}")?;
                for (number, Culprit { axis, direction }) in self.culprits.iter().enumerate() {
                    let way = match direction {
                        0 => "",
                        1.. => " moving forward",
                        _ => " moving back",
                    };
                    write!(f, "{} {axis}{way}", if number == 0 { ", axis" } else { " and" })?;
                }
                f.write_str("; the positions are valid\n")?;
                let words = self.meaning.zip(self.remedy);
                words.map_or(Ok(()), |(meaning, remedy)| {
                    writeln!(f, "why:   {meaning}\nto do: {remedy}")
                })
            }
        }
    }
}

impl fmt::Display for ProgramDriven {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { lines, soft_limits, horizon_ms, waits, cuts, overrides, block, began_at } = self;
        let bounds = match &soft_limits[..] {
            [] => "no soft limits".to_owned(),
            names => format!("soft limits of {}", names.join(", ")),
        };
        let cut = if *cuts == 0 { String::new() } else { format!(", queues cut {cuts} times") };
        writeln!(f, "{lines} lines, {waits} waits{cut}, {bounds}, horizon {horizon_ms} ms")?;
        if !overrides.are_none() {
            writeln!(f, "overrides at the end: {overrides}")?;
        }
        let Some(found) = block else { return Ok(()) };
        let number = found.number;
        writeln!(
            f,
            "it ended in {found}: --from-block {number} --began-at {began_at} goes on there"
        )
    }
}

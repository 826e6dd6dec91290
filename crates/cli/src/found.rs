//! What a board does and where its axes are: what `status` and `stop` print, asked of the board itself or of the
//! command that drives it.

use crate::control::Holder;
use carrystep_core::engine::{CAUSES, Cause};
use carrystep_link::{Answer, Facts, Status};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What does not change while a board is connected.
#[derive(Debug, Clone)]
pub struct Known {
    /// The port.
    pub port: String,
    /// What the gateware said of itself.
    pub facts: Facts,
    /// A name for each axis of the build.
    pub axes: Vec<String>,
    /// Steps in a unit of each axis; empty where no machine is known.
    pub steps_per_unit: Vec<f64>,
}

/// What `--json` prints.
#[derive(Debug, Clone, JsonSchema, Serialize, Deserialize)]
pub struct Found {
    /// It has answered.
    pub passed: bool,
    /// The port.
    pub port: String,
    /// The gateware's build id.
    pub build: String,
    /// Its clock, Hz.
    pub clock_hz: u32,
    /// Its tick, ns.
    pub tick_ns: u32,
    /// Phases of a tick.
    pub phases: u32,
    /// Ticks of silence after which it stops; 0: never.
    pub watchdog_ticks: u32,
    /// The drivers have power.
    pub ready: bool,
    /// All axes are done.
    pub idle: bool,
    /// A start waits.
    pub armed: bool,
    /// A stop has been called; only a clear resumes.
    pub fault: bool,
    /// The stop is over.
    pub halted: bool,
    /// Why the machine stands, in a word.
    pub cause: Option<String>,
    /// The same in a sentence.
    pub meaning: Option<String>,
    /// What to do about it.
    pub remedy: Option<String>,
    /// The command that holds the port, where this was asked of it and not of the board.
    pub held_by: Option<Holder>,
    /// The command that was stopped, where `carrystep stop` has stopped one.
    #[serde(default)]
    pub stopped: Option<Holder>,
    /// Each axis.
    pub axes: Vec<AxisFound>,
}

/// One axis.
#[derive(Debug, Clone, JsonSchema, Serialize, Deserialize)]
pub struct AxisFound {
    /// Its name.
    pub axis: String,
    /// Position register, steps.
    pub position: i32,
    /// The same in the axis' own unit, where a machine is known.
    pub place: Option<f64>,
    /// The machine coordinate in the axis' own unit, where the axis is homed and nobody else has moved it since.
    #[serde(default)]
    pub machine: Option<f64>,
    /// Steps that freezes have discarded; the command that drives does not ask for them.
    pub discarded: Option<u32>,
    /// It waits for its limit.
    pub homing: bool,
    /// The stop came from it.
    pub culprit: bool,
}

/// The cause of a stop by its number in an answer.
pub fn cause(answer: &Answer) -> Option<Cause> {
    by_number(answer.cause).filter(|_| answer.fault)
}

/// The cause of this number.
pub fn by_number(cause: u8) -> Option<Cause> {
    CAUSES.get(usize::from(cause)).copied()
}

/// The names of the axes in a mask, a bit each.
pub fn names(axes: &[String], mask: u8) -> String {
    let is_of = |number: usize| mask.checked_shr(number as u32).is_some_and(|bits| bits & 1 == 1);
    let names: Vec<&str> = (0..).zip(axes).filter(|&(number, _)| is_of(number)).map(|(_, name)| &**name).collect();
    names.join(", ")
}

impl Found {
    /// What a board has answered; `discarded` of each axis, where they were read.
    pub fn new(status: &Status, known: &Known, discarded: Option<&[u32]>) -> Self {
        let Answer { ready, idle, armed, fault, halted, homing, culprits, .. } = status.answer;
        let Known { port, facts, axes, steps_per_unit } = known;
        let cause = cause(&status.answer);
        let axis = |(number, axis): (usize, &String)| {
            let position = status.positions.get(number).copied().unwrap_or_default();
            AxisFound {
                axis: axis.clone(),
                position,
                place: steps_per_unit.get(number).map(|steps| f64::from(position) / steps),
                machine: None,
                discarded: discarded.and_then(|all| all.get(number).copied()),
                homing: homing >> number & 1 == 1,
                culprit: fault && culprits >> number & 1 == 1,
            }
        };
        Self {
            passed: true,
            port: port.clone(),
            build: format!("{:016x}", facts.build),
            clock_hz: facts.clock_hz,
            tick_ns: facts.tick_ns,
            phases: facts.phases,
            watchdog_ticks: facts.watchdog_ticks,
            ready,
            idle,
            armed,
            fault,
            halted,
            cause: status.answer.cause_name().map(ToOwned::to_owned),
            meaning: cause.map(|cause| cause.meaning().to_owned()),
            remedy: cause.map(|cause| cause.remedy().to_owned()),
            held_by: None,
            stopped: None,
            axes: axes.iter().enumerate().map(axis).collect(),
        }
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { port, build, clock_hz, tick_ns, phases, .. } = self;
        writeln!(f, "{port}: build {build}, clock {clock_hz} Hz, tick {tick_ns} ns, {phases} phases")?;
        if let Some(holder) = &self.stopped {
            writeln!(f, "{holder} was stopped")?;
        }
        if let Some(holder) = &self.held_by {
            writeln!(f, "{holder} drives it")?;
        }
        let culprits: Vec<&str> = self.axes.iter().filter(|axis| axis.culprit).map(|axis| &*axis.axis).collect();
        let from = if culprits.is_empty() { String::new() } else { format!(", from {}", culprits.join(", ")) };
        let power = if self.ready { "drivers powered" } else { "drivers without power" };
        match (&self.cause, self.halted, self.idle) {
            (Some(cause), true, _) => writeln!(f, "STOPPED: {cause}{from}; {power}")?,
            (Some(cause), false, _) => writeln!(f, "stopping: {cause}{from}; {power}")?,
            (None, _, true) => writeln!(f, "at rest; {power}")?,
            (None, _, false) => writeln!(f, "moving; {power}")?,
        }
        if let (Some(meaning), Some(remedy)) = (&self.meaning, &self.remedy) {
            writeln!(f, "why:   {meaning}\nto do: {remedy}")?;
        }
        let in_units = self.axes.iter().any(|axis| axis.place.is_some());
        let heading = if in_units { format!("  {:>12}", "place") } else { String::new() };
        writeln!(f, "{:<6}{heading}  {:>11}  {:>9}", "axis", "steps", "discarded")?;
        for AxisFound { axis, position, place, machine, discarded, homing, culprit } in &self.axes {
            let machine =
                machine.map_or_else(String::new, |machine| format!("  homed: at {machine:.4} of the machine"));
            let place = place.map_or_else(String::new, |place| format!("  {place:>12.4}"));
            let discarded = discarded.map_or_else(|| "-".to_owned(), |count| count.to_string());
            let homing = if *homing { "  waits for its limit" } else { "" };
            let culprit = if *culprit { "  the stop came from it" } else { "" };
            writeln!(f, "{axis:<6}{place}  {position:>11}  {discarded:>9}{machine}{homing}{culprit}")?;
        }
        Ok(())
    }
}

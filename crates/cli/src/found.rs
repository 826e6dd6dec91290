//! The state of a board and the positions of its axes, as `status` and `stop` print them. It comes
//! from the board itself or from the command that drives the board.

use crate::holder::Holder;
use carrystep_core::engine::Cause;
use carrystep_link::{Answer, BuildFacts, Status};
use carrystep_runner::OverrideSetting;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The constants of a connected board.
#[derive(Debug, Clone)]
pub struct Known {
    /// The name of the port.
    pub port: String,
    /// The constants that the gateware reported.
    pub facts: BuildFacts,
    /// The names of the axes of the build, in order.
    pub axes: Vec<String>,
    /// Steps per unit of each axis; empty if no machine file is known.
    pub steps_per_unit: Vec<f64>,
}

/// What `--json` prints.
#[derive(Debug, Clone, JsonSchema, Serialize, Deserialize)]
pub struct FoundBoard {
    /// True if the board has answered.
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
    /// Number of ticks since the board was configured, modulo 2^32; unknown if the report comes from
    /// a driving command.
    #[serde(default)]
    pub ticks: Option<u32>,
    /// The drivers have power.
    pub ready: bool,
    /// All axes are done.
    pub idle: bool,
    /// An axis moves or a segment waits, of whichever host.
    #[serde(default)]
    pub moving: bool,
    /// A start is armed and waits for its axes.
    pub armed: bool,
    /// A stop has been called; only a clear resumes.
    pub fault: bool,
    /// The stop is complete: no axis moves.
    pub halted: bool,
    /// The cause of the stop, in one word.
    pub cause: Option<String>,
    /// The cause in one sentence.
    pub meaning: Option<String>,
    /// What the user must do about it.
    pub remedy: Option<String>,
    /// The command that holds the port, if this report comes from it and not from the board.
    pub held_by: Option<Holder>,
    /// What the program of that command waits for, at rest; `carrystep resume` lets it go on, unless
    /// it waits for an input.
    #[serde(default)]
    pub waits: Option<String>,
    /// Whether it waits for an input of the board.
    #[serde(default)]
    pub waits_for_input: bool,
    /// The block in which the program of that command is.
    #[serde(default)]
    pub block: Option<BlockFound>,
    /// The overrides of the program of that command.
    #[serde(default)]
    pub overrides: Option<OverridesFound>,
    /// The command that `carrystep stop` has stopped, if there was one.
    #[serde(default)]
    pub stopped: Option<Holder>,
    /// Each axis.
    pub axes: Vec<AxisFound>,
}

/// An executed block of a program, as `plan --list-blocks` numbers it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
pub struct BlockFound {
    /// Its number, from 1, for `--from-block`.
    pub number: u64,
    /// Its line.
    pub line: u64,
}

impl fmt::Display for BlockFound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "block {} (line {})", self.number, self.line)
    }
}

/// The overrides of a program, percent; 100 each is what the program says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
pub struct OverridesFound {
    /// Of the feed, 10 to 200.
    pub feed: u8,
    /// Of the speed of rapid moves, 10 to 100.
    pub rapid: u8,
    /// Of the speed of the spindle, 10 to 200.
    pub spindle: u8,
}

impl From<OverrideSetting> for OverridesFound {
    fn from(OverrideSetting { feed, rapid, spindle }: OverrideSetting) -> Self {
        Self { feed, rapid, spindle }
    }
}

impl OverridesFound {
    /// Whether the program runs as it says.
    pub fn are_none(self) -> bool {
        self == OverrideSetting::NONE.into()
    }
}

impl fmt::Display for OverridesFound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { feed, rapid, spindle } = *self;
        write!(f, "{}", OverrideSetting { feed, rapid, spindle })
    }
}

/// One axis.
#[derive(Debug, Clone, JsonSchema, Serialize, Deserialize)]
pub struct AxisFound {
    /// Its name.
    pub axis: String,
    /// Position register, steps.
    pub position: i32,
    /// The position in the axis' own unit, if a machine file is known.
    pub place: Option<f64>,
    /// The machine coordinate in the axis' own unit, if the axis is homed and no other host
    /// has moved it since.
    #[serde(default)]
    pub machine: Option<f64>,
    /// Steps that freezes have discarded; unknown if the report comes from a driving command.
    pub discarded: Option<u32>,
    /// True if the axis waits for the source of its seek.
    pub seeking: bool,
    /// True if the axis caused the stop.
    pub culprit: bool,
}

/// The cause of a stop, decoded from an answer; `None` if no stop was called.
pub fn cause(answer: &Answer) -> Option<Cause> {
    Cause::from_number(answer.cause).filter(|_| answer.fault)
}

/// The names of the axes in a mask of one bit per axis, separated by commas.
pub fn names(axes: &[String], mask: u8) -> String {
    let is_of = |number: usize| mask.checked_shr(number as u32).is_some_and(|bits| bits & 1 == 1);
    let names: Vec<&str> =
        (0..).zip(axes).filter(|&(number, _)| is_of(number)).map(|(_, name)| &**name).collect();
    names.join(", ")
}

impl FoundBoard {
    /// Builds the report from a board's status. `discarded` are the discarded steps of each axis,
    /// if they were read.
    pub fn new(status: &Status, known: &Known, discarded: Option<&[u32]>) -> Self {
        let Answer { ready, idle, armed, fault, halted, seeking, culprits, .. } = status.answer;
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
                seeking: seeking >> number & 1 == 1,
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
            ticks: None,
            ready,
            idle,
            moving: !idle && !halted,
            armed,
            fault,
            halted,
            cause: status.answer.cause_name().map(ToOwned::to_owned),
            meaning: cause.map(|cause| cause.meaning().to_owned()),
            remedy: cause.map(|cause| cause.remedy().to_owned()),
            held_by: None,
            waits: None,
            block: None,
            overrides: None,
            waits_for_input: false,
            stopped: None,
            axes: axes.iter().enumerate().map(axis).collect(),
        }
    }
}

impl fmt::Display for FoundBoard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { port, build, clock_hz, tick_ns, phases, .. } = self;
        writeln!(
            f,
            "{port}: build {build}, clock {clock_hz} Hz, tick {tick_ns} ns, {phases} phases"
        )?;
        if let Some(holder) = &self.stopped {
            writeln!(f, "{holder} was stopped")?;
        }
        if let Some(holder) = &self.held_by {
            writeln!(f, "{holder} drives it")?;
        }
        if let Some(waits) = &self.waits {
            let until = if self.waits_for_input {
                "its input lets it go on"
            } else {
                "`carrystep resume` lets it go on"
            };
            writeln!(f, "it waits: {waits}; {until}")?;
        }
        if let Some(block) = &self.block {
            writeln!(f, "it is in {block}")?;
        }
        if let Some(overrides) = self.overrides.filter(|overrides| !overrides.are_none()) {
            writeln!(f, "overrides: {overrides}")?;
        }
        let culprits: Vec<&str> =
            self.axes.iter().filter(|axis| axis.culprit).map(|axis| &*axis.axis).collect();
        let from = if culprits.is_empty() {
            String::new()
        } else {
            format!(", from {}", culprits.join(", "))
        };
        let power = match (self.ready, self.idle) {
            (true, _) => "drivers powered",
            // The gateware takes the power away only when no segment waits any more.
            (false, false) => "drivers powered while segments wait",
            (false, true) => "drivers without power",
        };
        match (&self.cause, self.halted, self.idle) {
            (Some(cause), true, _) => writeln!(f, "STOPPED: {cause}{from}; {power}")?,
            (Some(cause), false, _) => writeln!(f, "stopping: {cause}{from}; {power}")?,
            (None, _, true) => writeln!(f, "at rest; {power}")?,
            (None, _, false) => writeln!(f, "moving; {power}")?,
        }
        if let Some(ticks) = self.ticks {
            writeln!(f, "{ticks} ticks since its configuration, modulo 2^32")?;
        }
        if let (Some(meaning), Some(remedy)) = (&self.meaning, &self.remedy) {
            writeln!(f, "why:   {meaning}\nto do: {remedy}")?;
        }
        let in_units = self.axes.iter().any(|axis| axis.place.is_some());
        let heading = if in_units { format!("  {:>12}", "place") } else { String::new() };
        writeln!(f, "{:<6}{heading}  {:>11}  {:>9}", "axis", "steps", "discarded")?;
        for AxisFound { axis, position, place, machine, discarded, seeking, culprit } in &self.axes
        {
            let machine = machine.map_or_else(String::new, |machine| {
                format!("  homed: at {machine:.4} of the machine")
            });
            let place = place.map_or_else(String::new, |place| format!("  {place:>12.4}"));
            let discarded = discarded.map_or_else(|| "-".to_owned(), |count| count.to_string());
            let seeking = if *seeking { "  seeks" } else { "" };
            let culprit = if *culprit { "  it caused the stop" } else { "" };
            writeln!(
                f,
                "{axis:<6}{place}  {position:>11}  {discarded:>9}{machine}{seeking}{culprit}"
            )?;
        }
        Ok(())
    }
}

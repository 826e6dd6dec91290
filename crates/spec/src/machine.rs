//! The machine file: clock, tick, phases, and for each axis its units, limits and driver.
//!
//! Raw structures mirror the TOML; [`Machine`] is what is left after every value has been checked.

use crate::build::{AXES, Build, MAX_CLOCKS, PinTiming, Timebase, TimebaseError};
use crate::decimal;
use crate::driver::drivers;
use crate::engine::{Guard, MAX_AXES};
use crate::error::{InputError, Source};
use crate::fixed::StartPhase;
use crate::number::{not_negative, positive};
use bigdecimal::{BigDecimal, Zero};
use guard::RawGuard;
use serde::Deserialize;
use std::ops::Range;
use std::path::Path;
use thiserror::Error;
use toml::Spanned;

mod guard;
mod stop;

pub(crate) use stop::steps_per_s2;

/// A machine whose every value has been checked.
#[derive(Debug, Clone)]
pub struct Machine {
    /// Clock, tick and phases.
    pub timebase: Timebase,
    /// Where in a step moves start.
    pub phase: StartPhase,
    /// One to eight axes.
    pub axes: Vec<Axis>,
    /// What stops them, where an engine drives them.
    pub guard: Guard,
}

/// A machine that the parallel axes cannot drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{0} axes: the parallel gateware drives at most {AXES}; an engine may have up to {MAX_AXES}")]
pub struct TooManyAxes(pub usize);

/// One axis; speeds and accelerations are exact products of the file's numbers.
#[derive(Debug, Clone)]
pub struct Axis {
    /// Its name in move files and waveforms.
    pub name: String,
    /// Steps in a unit of length.
    pub steps_per_unit: BigDecimal,
    /// Speed the motor takes from rest, steps/s; 0 or more.
    pub start_speed: BigDecimal,
    /// Greatest speed, steps/s.
    pub speed_limit: BigDecimal,
    /// Greatest acceleration, steps/s^2.
    pub accel_limit: BigDecimal,
    /// Greatest jerk, steps/s^3, where the file gives one.
    pub jerk_limit: Option<BigDecimal>,
    /// How fast the engine's guard ramps it down, 2^-64 step per tick^2, from 1 to 2^62.
    pub stop: u64,
    /// What the driver asks of the pins, ns: width, gap, set-up, hold.
    pub pins_ns: [u64; 4],
    /// The same in clocks.
    pub pins: PinTiming,
}

impl Machine {
    /// Reads a machine file: a `[machine]` table.
    ///
    /// # Errors
    /// [`InputError`] with file, line and column.
    pub fn load(path: &Path) -> Result<Self, InputError> {
        Self::from_source(&Source::read(path)?)
    }

    /// Checks a machine file whose text is already there.
    ///
    /// # Errors
    /// [`InputError`] with file, line and column.
    pub fn from_source(source: &Source) -> Result<Self, InputError> {
        let file: RawMachineFile = source.parse()?;
        file.machine.check(source)
    }

    /// The build parameters of this machine's parallel gateware.
    ///
    /// # Errors
    /// [`TooManyAxes`]: the machine has more than six.
    pub fn build(&self) -> Result<Build, TooManyAxes> {
        if self.axes.len() > AXES {
            return Err(TooManyAxes(self.axes.len()));
        }
        let mut pins = [PinTiming::SHORTEST; AXES];
        for (slot, axis) in pins.iter_mut().zip(&self.axes) {
            *slot = axis.pins;
        }
        Ok(Build { timebase: self.timebase, phase: self.phase, pins })
    }

    /// The number of the axis of this name.
    pub fn axis_index(&self, name: &str) -> Option<usize> {
        self.axes.iter().position(|axis| axis.name == name)
    }

    /// The axis names in one line, for messages.
    pub fn axis_names(&self) -> String {
        let names: Vec<&str> = self.axes.iter().map(|axis| axis.name.as_str()).collect();
        names.join(", ")
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a machine file")]
struct RawMachineFile {
    machine: RawMachine,
}

/// `[machine]` as the file has it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a [machine] table")]
pub(crate) struct RawMachine {
    clock_hz: Option<Spanned<u64>>,
    tick_ns: Option<Spanned<u64>>,
    phases: Option<Spanned<u32>>,
    #[serde(default)]
    phase: StartPhase,
    #[serde(default)]
    guard: RawGuard,
    axis: Spanned<Vec<Spanned<RawAxis>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a [[machine.axis]] table")]
struct RawAxis {
    name: Spanned<String>,
    steps_per_unit: Spanned<f64>,
    start_speed: Option<Spanned<f64>>,
    speed_limit: Spanned<f64>,
    accel_limit: Spanned<f64>,
    jerk_limit: Option<Spanned<f64>>,
    stop_accel: Option<Spanned<f64>>,
    driver: Option<Spanned<String>>,
    step_ns: Option<Spanned<u64>>,
    gap_ns: Option<Spanned<u64>>,
    setup_ns: Option<Spanned<u64>>,
    hold_ns: Option<Spanned<u64>>,
}

impl RawMachine {
    /// Where the first axis stands that a parallel core has no place for.
    pub(crate) fn seventh(&self) -> Option<Range<usize>> {
        self.axis.as_ref().get(AXES).map(Spanned::span)
    }

    pub(crate) fn check(self, source: &Source) -> Result<Machine, InputError> {
        let timebase = self.timebase(source)?;
        let span = self.axis.span();
        let raw = self.axis.into_inner();
        if raw.is_empty() {
            return Err(InputError::at(source, span, "a machine without axes")
                .help("add a [[machine.axis]] table for each axis"));
        }
        if raw.len() > MAX_AXES {
            let message = format!("{} axes: an engine drives at most {MAX_AXES}", raw.len());
            return Err(
                InputError::at(source, raw[MAX_AXES].span(), message).help("leave out axes, or build two engines")
            );
        }
        let mut axes: Vec<Axis> = Vec::with_capacity(raw.len());
        for axis in raw {
            let name_span = axis.as_ref().name.span();
            let axis = axis.into_inner().check(source, &timebase)?;
            if axes.iter().any(|other| other.name == axis.name) {
                return Err(InputError::at(source, name_span, format!("two axes are called '{}'", axis.name))
                    .help("give each axis a name of its own"));
            }
            axes.push(axis);
        }
        let guard = self.guard.check(source, &timebase, axes.iter().map(|axis| axis.stop).collect())?;
        Ok(Machine { timebase, phase: self.phase, axes, guard })
    }

    fn timebase(&self, source: &Source) -> Result<Timebase, InputError> {
        let get = |value: &Option<Spanned<u64>>, default| value.as_ref().map_or(default, |v| *v.as_ref());
        let clock_hz = get(&self.clock_hz, 48_000_000);
        let tick_ns = get(&self.tick_ns, 1000);
        let phases = self.phases.as_ref().map_or(16, |v| *v.as_ref());
        Timebase::new(clock_hz, tick_ns, phases).map_err(|error| {
            let tick = self.tick_ns.as_ref().map(Spanned::span);
            let clock = self.clock_hz.as_ref().map(Spanned::span);
            let phases = self.phases.as_ref().map(Spanned::span);
            // The value that is wrong, or else one that has a part in it: the others are defaults.
            let span = match error {
                TimebaseError::Clock(_) => clock,
                TimebaseError::Phases(_) => phases,
                TimebaseError::NotWhole { .. } | TimebaseError::Range(_) => tick.or(clock),
                TimebaseError::NotDivisible { .. } => phases.or(tick).or(clock),
            };
            let mut told = InputError::new(error.to_string());
            told.place = span.map(|span| (source.clone(), span));
            told.help(
                "clock_hz x tick_ns must be a whole number of clocks, divisible by `phases`: \
                 48 MHz x 1000 ns = 48 clocks = 16 phases x 3",
            )
        })
    }
}

impl RawAxis {
    fn check(self, source: &Source, timebase: &Timebase) -> Result<Axis, InputError> {
        let name = self.name.as_ref().clone();
        let fit = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if !name.starts_with(|c: char| c.is_ascii_alphabetic()) || !name.chars().all(fit) || name.len() > 32 {
            return Err(InputError::at(source, self.name.span(), format!("{name:?} cannot name an axis")).help(
                "a name starts with a letter and has letters, digits and _ only, 32 at most: it becomes a signal name",
            ));
        }
        let steps_per_unit = positive(source, &self.steps_per_unit, "steps_per_unit")?;
        let in_steps = |value: BigDecimal| value * &steps_per_unit;
        let start_speed = match &self.start_speed {
            None => BigDecimal::zero(),
            Some(value) => in_steps(not_negative(source, value, "start_speed")?),
        };
        let speed_limit = in_steps(positive(source, &self.speed_limit, "speed_limit")?);
        let accel_limit = in_steps(positive(source, &self.accel_limit, "accel_limit")?);
        not_too_slow(source, self.speed_limit.span(), "speed_limit", &speed_limit, "steps/s")?;
        not_too_slow(source, self.accel_limit.span(), "accel_limit", &accel_limit, "steps/s^2")?;
        let jerk_limit = match &self.jerk_limit {
            None => None,
            Some(value) => Some(in_steps(positive(source, value, "jerk_limit")?)),
        };
        if start_speed > speed_limit
            && let Some(start) = &self.start_speed
        {
            return Err(InputError::at(source, start.span(), "start_speed is over speed_limit")
                .help("the start speed is part of the speed range: at most speed_limit"));
        }
        let (pins_ns, pins) = self.pins(source, timebase)?;
        let stop = match &self.stop_accel {
            None => stop::at_the_limit(&accel_limit, timebase),
            Some(value) => stop::units(source, value, &steps_per_unit, timebase)?,
        };
        let axis =
            Axis { name, steps_per_unit, start_speed, speed_limit, accel_limit, jerk_limit, stop, pins_ns, pins };
        axis.check_speed(source, self.speed_limit.span(), timebase)?;
        axis.check_acceleration(source, self.accel_limit.span(), timebase)?;
        Ok(axis)
    }

    /// Width, gap, set-up and hold, from the driver's preset and what overrides it.
    fn pins(&self, source: &Source, timebase: &Timebase) -> Result<([u64; 4], PinTiming), InputError> {
        let preset = match &self.driver {
            None => None,
            Some(name) => Some(drivers().get(name.as_ref().as_str()).ok_or_else(|| {
                let known: Vec<&str> = drivers().keys().map(String::as_str).collect();
                InputError::at(source, name.span(), format!("no driver is called '{}'", name.as_ref()))
                    .help(format!("known: {}; or give step_ns, gap_ns, setup_ns and hold_ns", known.join(", ")))
            })?),
        };
        let mut ns = [0; 4];
        let mut clocks = [0; 4];
        let rows = [
            ("step_ns", &self.step_ns, preset.map(|d| d.step_ns)),
            ("gap_ns", &self.gap_ns, preset.map(|d| d.gap_ns)),
            ("setup_ns", &self.setup_ns, preset.map(|d| d.setup_ns)),
            ("hold_ns", &self.hold_ns, preset.map(|d| d.hold_ns)),
        ];
        for (slot, (key, given, default)) in rows.into_iter().enumerate() {
            let Some(value) = given.as_ref().map(|v| *v.as_ref()).or(default) else {
                return Err(InputError::at(
                    source,
                    self.name.span(),
                    format!("axis '{}' has no driver and no {key}", self.name.as_ref()),
                )
                .help("name a driver, or give step_ns, gap_ns, setup_ns and hold_ns"));
            };
            ns[slot] = value;
            let span = given.as_ref().map_or_else(|| self.name.span(), Spanned::span);
            let exact = timebase.clocks_for_ns(value);
            clocks[slot] = u32::try_from(exact).ok().filter(|&c| c < MAX_CLOCKS).ok_or_else(|| {
                InputError::at(
                    source,
                    span,
                    format!("{key} = {value} ns is {exact} clocks: the timers count to {}", MAX_CLOCKS - 1),
                )
            })?;
        }
        Ok((ns, PinTiming { width: clocks[0], gap: clocks[1], setup: clocks[2], hold: clocks[3] }))
    }
}

/// Limits under a thousandth of a step ask for plans of months, and are too coarse in units of 2^-64 step per tick.
fn not_too_slow(
    source: &Source,
    span: Range<usize>,
    key: &str,
    limit: &BigDecimal,
    unit: &str,
) -> Result<(), InputError> {
    let least = BigDecimal::new(1.into(), 3);
    if *limit >= least {
        return Ok(());
    }
    let limit = decimal::to_f64(limit);
    Err(InputError::at(source, span, format!("{key} is {limit} {unit}: under {least} {unit}"))
        .help("check steps_per_unit and the unit of the limit; a moving axis makes a step in a quarter of an hour"))
}

impl Axis {
    /// Under half a step per tick, and a period that the driver's width and gap allow.
    fn check_speed(&self, source: &Source, span: Range<usize>, timebase: &Timebase) -> Result<(), InputError> {
        let limit = decimal::to_f64(&self.speed_limit);
        let per_unit = decimal::to_f64(&self.steps_per_unit);
        let half = 0.5e9 / timebase.tick_ns() as f64;
        let doubled = &self.speed_limit * BigDecimal::from(2 * timebase.tick_ns());
        if doubled >= 1_000_000_000 {
            return Err(InputError::at(
                source,
                span,
                format!("speed_limit is {limit} steps/s: half a step per tick or more"),
            )
            .help(format!(
                "with ticks of {} ns stay under {half} steps/s, {} units/s",
                timebase.tick_ns(),
                half / per_unit
            )));
        }
        let PinTiming { width, gap, .. } = self.pins;
        let clocks = u64::from(width) + u64::from(gap) + u64::from(timebase.clocks_per_phase());
        if &self.speed_limit * BigDecimal::from(clocks) > timebase.clock_hz() {
            let most = timebase.clock_hz() as f64 / clocks as f64;
            return Err(InputError::at(
                source,
                span,
                format!("speed_limit is {limit} steps/s: over what the driver's width and gap allow"),
            )
            .help(format!(
                "a pulse takes {width} + {gap} clocks and one phase of {}: at most {most:.0} steps/s, {:.6} units/s",
                timebase.clocks_per_phase(),
                most / per_unit
            )));
        }
        Ok(())
    }

    /// Under half a step per tick squared, so that A fits its register.
    fn check_acceleration(&self, source: &Source, span: Range<usize>, timebase: &Timebase) -> Result<(), InputError> {
        let tick = BigDecimal::from(timebase.tick_ns());
        if &self.accel_limit * &tick * &tick * BigDecimal::from(2) >= 10_u64.pow(18) {
            let limit = decimal::to_f64(&self.accel_limit);
            let half = 0.5e18 / (timebase.tick_ns() as f64).powi(2);
            return Err(InputError::at(
                source,
                span,
                format!("accel_limit is {limit} steps/s^2: half a step per tick^2 or more"),
            )
            .help(format!(
                "with ticks of {} ns stay under {half} steps/s^2, {} units/s^2",
                timebase.tick_ns(),
                half / decimal::to_f64(&self.steps_per_unit)
            )));
        }
        Ok(())
    }
}

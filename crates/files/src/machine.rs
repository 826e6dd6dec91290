//! The machine file: clock, tick, phases, and for each axis its units, limits and driver.
//!
//! Raw structures mirror the TOML; [`Machine`] is what is left after every value has been checked.

use crate::error::{InputError, Source};
use crate::unit::Unit;
use axis::RawAxis;
use bigdecimal::BigDecimal;
use carrystep_core::EngineBuild;
use carrystep_core::build::{AXES, Build, PinTiming, Timebase, TimebaseError};
use carrystep_core::engine::{Guard, MAX_AXES};
use carrystep_core::fixed::StartPhase;
use carrystep_core::link::{BaudError, Line, Uart};
use carrystep_core::tick::{ChosenTick, FIXED_CLOCK_HZ, default_tick, nearest_ticks};
use guard::RawGuard;
use home::{RawOrder, RawPlace};
use link::RawLink;
use serde::Deserialize;
use std::ops::Range;
use std::path::Path;
use thiserror::Error;
use toml::Spanned;

mod axis;
mod guard;
mod home;
mod link;
mod stop;
mod units;

pub use home::{End, Home, overrun};

/// A machine whose every value has been checked.
#[derive(Debug, Clone)]
pub struct Machine {
    /// Clock, tick and phases.
    pub timebase: Timebase,
    /// How the tick came about, where the file gives none and the clock is not the default.
    pub chosen_tick: Option<ChosenTick>,
    /// Where in a step moves start.
    pub phase: StartPhase,
    /// One to eight axes.
    pub axes: Vec<Axis>,
    /// What stops them, where an engine drives them.
    pub guard: Guard,
    /// The axes that home, by their numbers: groups, one after the other; the axes of a group together.
    pub home_order: Vec<Vec<usize>>,
    /// Baud rate of the host link; checked against the clock where the file names it.
    pub baud: u32,
    /// The host link is an SPI, and no UART.
    pub spi: bool,
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
    /// Steps in a unit of length; a quotient that is no finite decimal is rounded up in its 60th place.
    pub steps_per_unit: BigDecimal,
    /// The unit that people read.
    pub unit: Unit,
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
    /// Lowest and highest machine coordinate, steps, where the file gives them.
    pub travel: Option<[i64; 2]>,
    /// How it homes, where it does.
    pub home: Option<Home>,
}

impl Machine {
    /// The engine of this machine, with as many axes.
    pub fn engine(&self) -> EngineBuild {
        let pins = self.axes.iter().map(|axis| axis.pins).collect();
        EngineBuild { timebase: self.timebase, phase: self.phase, pins, guard: self.guard.clone() }
    }

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

    /// The line of the host link.
    ///
    /// # Errors
    /// [`BaudError`]: the file names no baud rate, and its clock does not make the default.
    pub fn line(&self) -> Result<Line, BaudError> {
        if self.spi { Ok(Line::Spi) } else { Uart::new(self.timebase.clock_hz(), self.baud).map(Line::Uart) }
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
    #[serde(default)]
    link: RawLink,
    home_order: Option<RawOrder>,
    axis: Spanned<Vec<Spanned<RawAxis>>>,
}

impl RawMachine {
    /// Where the first axis stands that a parallel core has no place for.
    pub(crate) fn seventh(&self) -> Option<Range<usize>> {
        self.axis.as_ref().get(AXES).map(Spanned::span)
    }

    pub(crate) fn check(self, source: &Source) -> Result<Machine, InputError> {
        let (timebase, chosen_tick) = self.timebase(source)?;
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
        let mut places: Vec<RawPlace> = Vec::with_capacity(raw.len());
        for axis in raw {
            let (name_span, table) = (axis.as_ref().name.span(), axis.span());
            let mut axis = axis.into_inner();
            places.push(axis.place());
            let axis = axis.check(source, table, &timebase);
            let axis = axis.map_err(|error| with_proposal(error, chosen_tick.as_ref()))?;
            if axes.iter().any(|other| other.name == axis.name) {
                return Err(InputError::at(source, name_span, format!("two axes are called '{}'", axis.name))
                    .help("give each axis a name of its own"));
            }
            axes.push(axis);
        }
        let guard = self.guard.check(source, &timebase, axes.iter().map(|axis| axis.stop).collect())?;
        let home_order = home::check(source, &timebase, &guard, &mut axes, places, self.home_order)?;
        let (baud, spi) = (self.link.baud(source, &timebase)?, self.link.spi(source)?);
        Ok(Machine { timebase, chosen_tick, phase: self.phase, axes, guard, home_order, baud, spi })
    }

    /// Clock, tick and phases; where the file gives no tick, also how it was chosen.
    fn timebase(&self, source: &Source) -> Result<(Timebase, Option<ChosenTick>), InputError> {
        let clock_hz = self.clock_hz.as_ref().map_or(FIXED_CLOCK_HZ, |v| *v.as_ref());
        let phases = self.phases.as_ref().map_or(16, |v| *v.as_ref());
        let axes = self.axis.as_ref().len().clamp(1, MAX_AXES);
        let given = self.tick_ns.as_ref().map(|v| (*v.as_ref(), None));
        // Of a clock without ticks any one is refused, and so is what is no clock.
        let (tick_ns, chosen) = given.or_else(|| default_tick(clock_hz, phases, axes)).unwrap_or((1, None));
        let timebase = Timebase::new(clock_hz, tick_ns, phases).map_err(|error| {
            let tick = self.tick_ns.as_ref().map(Spanned::span);
            let clock = self.clock_hz.as_ref().map(Spanned::span);
            let phase_span = self.phases.as_ref().map(Spanned::span);
            // The value that is wrong, or else one that has a part in it: the others are defaults.
            let span = match error {
                TimebaseError::Clock(_) => clock,
                TimebaseError::Phases(_) => phase_span,
                TimebaseError::NotWhole { .. } | TimebaseError::Range(_) => tick.clone().or(clock),
                TimebaseError::NotDivisible { .. } => phase_span.or(tick.clone()).or(clock),
            };
            let (message, help) = match error {
                TimebaseError::Clock(_) | TimebaseError::Phases(_) => (error.to_string(), None),
                _ if tick.is_none() => (
                    format!("a clock of {clock_hz} Hz has no tick"),
                    Some(nearest_ticks(clock_hz, tick_ns, phases, axes)),
                ),
                _ => (error.to_string(), Some(nearest_ticks(clock_hz, tick_ns, phases, axes))),
            };
            InputError { message, help, place: span.map(|span| (source.clone(), span)) }
        })?;
        Ok((timebase, chosen))
    }
}

/// An error about an axis, where fewer phases would make the tick that was chosen shorter, says so.
fn with_proposal(mut error: InputError, chosen: Option<&ChosenTick>) -> InputError {
    if let (Some(help), Some(proposal)) = (&mut error.help, chosen.and_then(ChosenTick::proposal)) {
        *help = format!("{help}; {proposal}");
    }
    error
}

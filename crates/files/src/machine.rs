//! The machine file: clock, tick and phases, and for each axis its units, limits and driver.
//!
//! A [`Machine`] holds the values after all checks; `raw` has the structures that mirror the TOML.

use crate::error::{InputError, SourceText};
use crate::unit::Unit;
use bigdecimal::BigDecimal;
use carrystep_core::EngineBuild;
use carrystep_core::build::{AXES, Build, PinTimes, PinTiming, Timebase};
use carrystep_core::engine::{Guard, MAX_AXES, Outputs};
use carrystep_core::fixed::StartPhase;
use carrystep_core::link::{BaudError, LineKind, Uart};
use carrystep_core::tick::ChosenTick;
use std::path::Path;
use thiserror::Error;

mod adders;
mod axis;
mod gantry;
mod guard;
mod home;
mod inputs;
mod kinematics;
mod limit;
mod link;
mod outputs;
mod queue;
mod raw;
mod stop;
mod units;

pub use home::{End, Home, overrun};
pub use kinematics::Kinematics;
pub use limit::AxisLimit;
pub use outputs::OutputUses;
pub(crate) use raw::RawMachine;
use raw::RawMachineFile;

/// A machine whose values have all been checked.
#[derive(Debug, Clone)]
pub struct Machine {
    /// Clock, tick and phases.
    pub timebase: Timebase,
    /// How the tick was chosen; `None` if the file gives it or the clock is the default.
    pub chosen_tick: Option<ChosenTick>,
    /// Phase of a step in which moves start.
    pub phase: StartPhase,
    /// How the motors follow from the letters.
    pub kinematics: Kinematics,
    /// The axes, one to eight.
    pub axes: Vec<Axis>,
    /// Settings of the engine's guard.
    pub guard: Guard,
    /// The outputs that change with the motion.
    pub outputs: Outputs,
    /// What G-code programs do with them.
    pub output_uses: OutputUses,
    /// Number of segments that the queue of an axis holds besides the one that runs.
    pub queue: usize,
    /// Whether a host can cut queues.
    pub cuts: bool,
    /// Number of adders of the engine.
    pub adders: usize,
    /// Homing order, as numbers of axes: the groups home one after the other, the axes of a group
    /// together.
    pub home_order: Vec<Vec<usize>>,
    /// Baud rate of the host link, bits per second. If the file gives it, the clock can make it.
    pub baud: u32,
    /// Whether the host link is an SPI; otherwise it is a UART.
    pub spi: bool,
}

/// Error: the six-axis core cannot drive this machine, because it has more than six axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "{0} axes: the parallel gateware drives at most {AXES}; an engine may have up to {MAX_AXES}"
)]
pub struct TooManyAxes(pub usize);

/// One motor. Its speeds and accelerations are exact products of the file's numbers. All motors of
/// a letter have the same limits, times of the driver and travel.
#[derive(Debug, Clone)]
pub struct Axis {
    /// Name in waveforms and messages.
    pub name: String,
    /// The letter that it moves, in move files and programs: its name if the file gives none.
    pub letter: String,
    /// Steps per unit of length. A quotient that is not a finite decimal is rounded up at its 60th
    /// decimal.
    pub steps_per_unit: BigDecimal,
    /// The unit for display.
    pub unit: Unit,
    /// Greatest speed at which the motor starts from rest, steps/s; 0 or more.
    pub start_speed: AxisLimit,
    /// Greatest speed, steps/s.
    pub speed_limit: AxisLimit,
    /// Greatest acceleration, steps/s^2.
    pub accel_limit: AxisLimit,
    /// Greatest jerk, steps/s^3, if the file gives one.
    pub jerk_limit: Option<AxisLimit>,
    /// Acceleration with which the engine's guard ramps the axis down, 2^-64 step per tick^2, from
    /// 1 to 2^62.
    pub stop: u64,
    /// Minimum times of the driver, ns.
    pub pins_ns: PinTimes,
    /// The same times in clocks, rounded up.
    pub pins: PinTiming,
    /// Lowest and highest machine coordinate, steps, if the file gives them.
    pub travel: Option<[i64; 2]>,
    /// Homing parameters, if the axis homes.
    pub home: Option<Home>,
}

impl Machine {
    /// Whether it has a probe.
    pub const fn has_probe(&self) -> bool {
        self.guard.inputs[0].exist & 1 == 1
    }

    /// The engine of this machine, with the machine's number of axes.
    pub fn engine(&self) -> EngineBuild {
        let pins = self.axes.iter().map(|axis| axis.pins).collect();
        let guard = self.guard.clone();
        EngineBuild {
            timebase: self.timebase,
            phase: self.phase,
            pins,
            guard,
            outputs: self.outputs,
            queue: self.queue,
            cuts: self.cuts,
            adders: self.adders,
        }
    }

    /// Reads a machine file, which has a `[machine]` table.
    ///
    /// # Errors
    /// [`InputError`] with file, line and column of the first mistake.
    pub fn load(path: &Path) -> Result<Self, InputError> {
        Self::from_source(&SourceText::read(path)?)
    }

    /// Checks the text of a machine file.
    ///
    /// # Errors
    /// [`InputError`] with file, line and column of the first mistake.
    pub fn from_source(source: &SourceText) -> Result<Self, InputError> {
        let file: RawMachineFile = source.parse()?;
        file.machine.check(source)
    }

    /// The parameters of this machine's build of the parallel core, which has as many axes as the
    /// machine.
    ///
    /// # Errors
    /// [`TooManyAxes`] if the machine has more than six axes.
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
    /// [`BaudError`] if the file gives no baud rate and its clock cannot make the default.
    pub fn line(&self) -> Result<LineKind, BaudError> {
        if self.spi {
            Ok(LineKind::Spi)
        } else {
            Uart::new(self.timebase.clock_hz(), self.baud).map(LineKind::Uart)
        }
    }

    /// The number of the axis of this name, from 0.
    pub fn axis_index(&self, name: &str) -> Option<usize> {
        self.axes.iter().position(|axis| axis.name == name)
    }

    /// The first motor of the letter of this name, from 0.
    pub fn letter_index(&self, letter: &str) -> Option<usize> {
        self.axes.iter().position(|axis| axis.letter == letter)
    }

    /// The first motor that moves the same letter as this motor.
    pub fn leader(&self, motor: usize) -> usize {
        let letter = &self.axes[motor].letter;
        self.letter_index(letter).unwrap_or(motor)
    }

    /// All motors that move the same letter as this motor, one bit each.
    pub fn with_its_letter(&self, motor: usize) -> u8 {
        let letter = &self.axes[motor].letter;
        let same = self.axes.iter().enumerate().filter(|(_, axis)| axis.letter == *letter);
        same.fold(0, |mask, (number, _)| mask | 1 << number)
    }

    /// The first motor of each letter, in the order of the file.
    pub fn leaders(&self) -> Vec<usize> {
        (0..self.axes.len()).filter(|&motor| self.leader(motor) == motor).collect()
    }

    /// For each motor, the place of its letter in [`Self::leaders`].
    pub fn letter_numbers(&self) -> Vec<usize> {
        let leaders = self.leaders();
        let number = |motor| leaders.iter().position(|&leader| leader == self.leader(motor));
        (0..self.axes.len()).filter_map(number).collect()
    }

    /// The names of all letters, separated by commas, for messages.
    pub fn letter_names(&self) -> String {
        let letter = |motor: usize| self.axes[motor].letter.as_str();
        self.leaders().into_iter().map(letter).collect::<Vec<_>>().join(", ")
    }

    /// The message for a name that is no letter of the machine: which names there are, or of which
    /// letter the motor of this name is one.
    pub fn no_letter(&self, name: &str) -> String {
        match self.axis_index(name).map(|motor| &self.axes[motor].letter) {
            Some(letter) => format!(
                "'{name}' is a motor of the letter {letter}: name {letter}, which moves all of its motors"
            ),
            None => format!("no axis is called '{name}': the axes are {}", self.letter_names()),
        }
    }

    /// The names of all axes, separated by commas, for messages.
    pub fn axis_names(&self) -> String {
        let names: Vec<&str> = self.axes.iter().map(|axis| axis.name.as_str()).collect();
        names.join(", ")
    }
}

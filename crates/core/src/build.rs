//! Build parameters of the gateware: clock, tick, phases and pin timings. Lengths of time are
//! counted in clock cycles.

use crate::fixed::StartPhase;
use thiserror::Error;

/// The greatest number of axes of the parallel core, and of the axes whose moves are planned.
pub const AXES: usize = 6;

/// Fewest clocks in a tick. Within a tick a host must be able to send a segment for every axis, and
/// a start.
pub const MIN_CLOCKS_PER_TICK: u32 = 16;

/// Most clocks in a tick or in one pin timing (timers are at most 17 bits wide).
pub const MAX_CLOCKS: u32 = 1 << 16;

/// Fastest clock, Hz. Captures count time in ps, and a clock period must be many of them.
pub const MAX_CLOCK_HZ: u64 = 1_000_000_000;

/// Clock, tick and phases of a build. Every value has been checked ([`Timebase::new`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Timebase {
    clock_hz: u64,
    tick_ns: u64,
    phases: u32,
    clocks_per_tick: u32,
}

/// Why no [`Timebase`] has these parameters.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TimebaseError {
    /// The clock is 0 Hz or faster than [`MAX_CLOCK_HZ`].
    #[error("a clock of {0} Hz: between 1 and {MAX_CLOCK_HZ} Hz are needed")]
    Clock(u64),
    /// The number of phases is not 1, 4 or 16.
    #[error("{0} phases: a tick has 1, 4 or 16 phases")]
    Phases(u32),
    /// Clock times tick is not a whole number.
    #[error(
        "a tick of {tick_ns} ns is not a whole number of clocks at {clock_hz} Hz ({remainder} / 10^9 clock left over)"
    )]
    NotWhole {
        /// Clock, Hz.
        clock_hz: u64,
        /// Tick, ns.
        tick_ns: u64,
        /// clock_hz * tick_ns modulo 10^9.
        remainder: u64,
    },
    /// The clocks of a tick do not split into equal phases.
    #[error("{clocks} clocks per tick do not divide into {phases} equal phases")]
    NotDivisible {
        /// Clocks per tick.
        clocks: u64,
        /// Phases per tick.
        phases: u32,
    },
    /// The number of clocks in a tick is out of range.
    #[error("{0} clocks per tick: between {MIN_CLOCKS_PER_TICK} and {MAX_CLOCKS} are needed")]
    Range(u64),
}

impl Timebase {
    /// Converts an acceleration of `units`, 2^-64 step per tick^2, to steps/s^2.
    pub fn steps_per_s2(&self, units: u64) -> f64 {
        const UNITS_PER_STEP: f64 = 18_446_744_073_709_551_616.0;
        let tick_ns = self.tick_ns as f64;
        units as f64 / UNITS_PER_STEP * 1e18 / (tick_ns * tick_ns)
    }

    /// Makes a timebase whose tick is a whole number of clocks and divides into equal phases.
    ///
    /// # Errors
    /// [`TimebaseError`] names the first parameter that is wrong.
    pub fn new(clock_hz: u64, tick_ns: u64, phases: u32) -> Result<Self, TimebaseError> {
        const NS: u128 = 1_000_000_000;
        if !(1..=MAX_CLOCK_HZ).contains(&clock_hz) {
            return Err(TimebaseError::Clock(clock_hz));
        }
        if ![1, 4, 16].contains(&phases) {
            return Err(TimebaseError::Phases(phases));
        }
        let product = u128::from(clock_hz) * u128::from(tick_ns);
        let clamp = |x: u128| u64::try_from(x).unwrap_or(u64::MAX);
        if !product.is_multiple_of(NS) {
            let remainder = clamp(product % NS);
            return Err(TimebaseError::NotWhole { clock_hz, tick_ns, remainder });
        }
        let clocks = clamp(product / NS);
        if clocks < u64::from(MIN_CLOCKS_PER_TICK) || clocks > u64::from(MAX_CLOCKS) {
            return Err(TimebaseError::Range(clocks));
        }
        if !clocks.is_multiple_of(u64::from(phases)) {
            return Err(TimebaseError::NotDivisible { clocks, phases });
        }
        let clocks_per_tick = u32::try_from(clocks).map_err(|_| TimebaseError::Range(clocks))?;
        Ok(Self { clock_hz, tick_ns, phases, clocks_per_tick })
    }

    /// Clock frequency, Hz.
    pub const fn clock_hz(&self) -> u64 {
        self.clock_hz
    }

    /// Tick, ns.
    pub const fn tick_ns(&self) -> u64 {
        self.tick_ns
    }

    /// Tick in seconds: `tick_ns` times 1e-9 in floats.
    pub fn tick_seconds(&self) -> f64 {
        self.tick_ns as f64 * 1e-9
    }

    /// Q, the number of phases per tick: 1, 4 or 16.
    pub const fn phases(&self) -> u32 {
        self.phases
    }

    /// log2 Q: 0, 2 or 4.
    pub const fn phase_bits(&self) -> u32 {
        self.phases.trailing_zeros()
    }

    /// C, the number of clocks per tick.
    pub const fn clocks_per_tick(&self) -> u32 {
        self.clocks_per_tick
    }

    /// C / Q, the number of clocks per phase.
    pub const fn clocks_per_phase(&self) -> u32 {
        self.clocks_per_tick / self.phases
    }

    /// L: the number of clocks from the load of a move's first segment to the pin edge of its tick
    /// 1, phase 0.
    pub const fn latency_clocks(&self) -> u64 {
        2 * self.clocks_per_tick as u64 + 1
    }

    /// Start of clock cycle `clock` in ps. It is rounded from the exact product, so that errors do
    /// not accumulate.
    pub const fn clock_to_ps(&self, clock: u64) -> u64 {
        const PS: u128 = 1_000_000_000_000;
        let hz = self.clock_hz as u128;
        ((clock as u128 * PS + hz / 2) / hz) as u64
    }

    /// Number of whole clocks that last at least `ns`; at least 1.
    pub fn clocks_for_ns(&self, ns: u64) -> u64 {
        let exact = u128::from(ns) * u128::from(self.clock_hz);
        u64::try_from(exact.div_ceil(1_000_000_000)).unwrap_or(u64::MAX).max(1)
    }
}

/// Minimum times that a driver requires at STEP and DIR, in clocks, each at least 1. [`PinTimes`]
/// has them in ns.
///
/// ```text
/// DIR  ____/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\_______
///          :dir_setup:<-dir_hold>:
/// STEP ______________/^^^^^^^\________/^^^^^^\__________
///           step_high:<----->:<----->:step_low
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PinTiming {
    /// STEP is high for at least this time, clocks.
    pub step_high: u32,
    /// STEP is low for at least this time, clocks.
    pub step_low: u32,
    /// Set-up: DIR is stable for this time before a rising edge of STEP, clocks.
    pub dir_setup: u32,
    /// Hold: DIR is stable for this time after a rising edge of STEP, clocks.
    pub dir_hold: u32,
}

impl PinTiming {
    /// The shortest timing that the gateware supports: one clock each.
    pub const SHORTEST: Self = Self { step_high: 1, step_low: 1, dir_setup: 1, dir_hold: 1 };
}

/// Minimum times that a driver requires at STEP and DIR, in ns, as its data sheet gives them.
/// [`PinTiming`] has the same times in clocks, and draws them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PinTimes {
    /// STEP high time, ns.
    pub step_high: u64,
    /// STEP low time, ns.
    pub step_low: u64,
    /// Set-up: DIR is stable before a rising edge of STEP, ns.
    pub dir_setup: u64,
    /// Hold: DIR is stable after a rising edge of STEP, ns.
    pub dir_hold: u64,
}

/// A number of axes that the parallel core cannot have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{0} axes: the parallel core has 1 to {AXES}")]
pub struct ParallelAxesError(pub usize);

/// Checks a number of axes of the parallel core.
///
/// # Errors
/// [`ParallelAxesError`] if it is not 1 to [`AXES`].
pub const fn check_parallel_axes(axes: usize) -> Result<(), ParallelAxesError> {
    if axes >= 1 && axes <= AXES { Ok(()) } else { Err(ParallelAxesError(axes)) }
}

/// All parameters of a build of the parallel core, except its number of axes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Build {
    /// Clock, tick and phases.
    pub timebase: Timebase,
    /// Phase of a step in which moves start.
    pub phase: StartPhase,
    /// Pin timing of each axis. A core of N axes uses the first N. Axes that the machine does not
    /// have use [`PinTiming::SHORTEST`].
    pub pins: [PinTiming; AXES],
}

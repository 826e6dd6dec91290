//! Writes the waveform: pins, registers and the float profile beside them, in any [`Format`].
//!
//! Integers are values of the gateware, and reals those of the profile, so that a viewer can draw
//! one over the other. All times are those of the pins: V is shown by the latency L later than in
//! the register, directly above the edges that it causes.
//!
//! The names of the signals may not change: signal maps and save files refer to them.

use crate::edge::{Pin, PinChange, PinSink};
use crate::error::TraceError;
use crate::follow::Follower;
use crate::ideal::tick_ps;
use crate::speed_register::SpeedRegister;
use crate::vcd_own::OwnCapture;
use carrystep_core::{Segment, StartPhase, Timebase};
use carrystep_profile::Timeline;
use std::fmt;
use std::io;

/// Number of samples of the slow signals over a run, in addition to those at edges and segment
/// boundaries.
const SAMPLES: u64 = 500;

/// The signals of one axis, in order: name and bits, with 0 bits for a real.
pub(crate) const SIGNALS: [(&str, u32); 7] = [
    ("step", 1),
    ("dir", 1),
    ("position", 32),
    ("v", 64),
    ("profile_position", 0),
    ("profile_speed", 0),
    ("error_ns", 0),
];

/// The scope that contains a scope for each axis.
pub(crate) const SCOPE: &str = "carrystep";

/// The program that wrote the file, with its version.
pub(crate) const VERSION: &str = concat!("carrystep ", env!("CARGO_PKG_VERSION"));

/// A file format of waveforms, with times in ps.
pub trait Format {
    /// The identifier of a signal.
    type Id: Copy;
    /// The name of the format in error messages.
    const NAME: &'static str;

    /// Declares the signals of each axis, in scopes with the names of the axes.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn declare(
        &mut self,
        own: &OwnCapture,
        axes: &[&str],
    ) -> io::Result<Vec<[Self::Id; SIGNALS.len()]>>;

    /// Writes the values at time 0.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn initial(&mut self, values: impl FnOnce(&mut Self) -> io::Result<()>) -> io::Result<()>;

    /// Sets the time of the changes that follow, ps. It must be later than the previous time.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn time(&mut self, ps: u64) -> io::Result<()>;

    /// Writes the level of a pin.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn bit(&mut self, id: Self::Id, level: bool) -> io::Result<()>;

    /// Writes a number of `bits` bits in two's complement.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn vector(&mut self, id: Self::Id, value: u64, bits: u32) -> io::Result<()>;

    /// Writes a real number.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn real(&mut self, id: Self::Id, value: f64) -> io::Result<()>;

    /// Completes the file.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    fn end(&mut self) -> io::Result<()>;
}

/// The values that the waveform shows beside the pins.
pub struct Waves<'a> {
    /// Clock, tick and phases of the gateware.
    pub timebase: Timebase,
    /// The position in a step at which the moves start.
    pub phase: StartPhase,
    /// The load of the first move plus the latency L, ps of the capture.
    pub origin_ps: i64,
    /// Length of all moves together, ticks.
    pub total_ticks: u64,
    /// The axes, in the order of their numbers.
    pub axes: Vec<AxisWaves<'a>>,
}

/// The values that the waveform of one axis shows beside its pins.
pub struct AxisWaves<'a> {
    /// The name of the axis, which is the scope of its signals.
    pub name: &'a str,
    /// The float profile.
    pub timeline: &'a Timeline,
    /// The segments in order, each with its first tick from the origin.
    pub segments: Box<dyn Iterator<Item = (u64, Segment)> + 'a>,
}

/// Writes a waveform from a stream of pin changes.
pub struct WaveWriter<'a, F: Format> {
    out: F,
    own: OwnCapture,
    total_ps: u64,
    axes: Vec<AxisWriter<'a>>,
    /// The signals of each axis, after they have been declared.
    ids: Vec<[F::Id; SIGNALS.len()]>,
    /// Index of the next sample of the regular grid.
    grid: u64,
    /// The last time in the file, ps; `None` until the header is written.
    time: Option<u64>,
}

struct AxisWriter<'a> {
    name: &'a str,
    timeline: &'a Timeline,
    follower: Follower<'a>,
    register: SpeedRegister<'a>,
    levels: [bool; 2],
    v: i64,
}

impl<F: Format> fmt::Debug for WaveWriter<'_, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("WaveWriter")
            .field("own", &self.own)
            .field("time", &self.time)
            .finish_non_exhaustive()
    }
}

impl<'a, F: Format> WaveWriter<'a, F> {
    /// A writer that has not written anything. It writes the header with the first change.
    pub(crate) fn of(out: F, waves: Waves<'a>) -> Self {
        let Waves { timebase, phase, origin_ps, total_ticks, axes } = waves;
        let axes = axes.into_iter().map(|axis| AxisWriter {
            name: axis.name,
            timeline: axis.timeline,
            follower: Follower::new(axis.timeline, phase, &timebase, origin_ps),
            register: SpeedRegister::new(axis.segments),
            levels: [false; 2],
            v: 0,
        });
        Self {
            out,
            own: OwnCapture { origin_ps, timebase },
            total_ps: total_ticks.saturating_mul(tick_ps(&timebase)),
            axes: axes.collect(),
            ids: Vec::new(),
            grid: 0,
            time: None,
        }
    }

    fn header(&mut self) -> io::Result<()> {
        let names: Vec<&str> = self.axes.iter().map(|axis| axis.name).collect();
        self.ids = self.out.declare(&self.own, &names)?;
        let (axes, ids) = (&self.axes, &self.ids);
        self.out.initial(|out| {
            for (axis, &[step, dir, position, v, ref reals @ ..]) in axes.iter().zip(ids) {
                out.bit(step, axis.levels[0])?;
                out.bit(dir, axis.levels[1])?;
                vector(out, position, 0, 32)?;
                vector(out, v, 0, 64)?;
                reals.iter().try_for_each(|&id| out.real(id, 0.0))?;
            }
            Ok(())
        })?;
        self.time = Some(0);
        Ok(())
    }

    /// Advances the file to `ps`, and writes all samples up to then.
    fn advance(&mut self, ps: u64) -> io::Result<()> {
        if self.time.is_none() {
            self.header()?;
        }
        while let Some(sample) = self.next_sample().filter(|&at| at <= ps) {
            self.stamp(sample)?;
            let on_grid = self.grid_time() == Some(sample);
            self.grid += u64::from(on_grid);
            for index in 0..self.axes.len() {
                let at_boundary = self.boundary(index) == Some(sample);
                if on_grid || at_boundary {
                    self.sample(index, sample)?;
                }
            }
        }
        self.stamp(ps)
    }

    fn stamp(&mut self, ps: u64) -> io::Result<()> {
        if self.time.is_none_or(|time| ps > time) {
            self.out.time(ps)?;
            self.time = Some(ps);
        }
        Ok(())
    }

    /// The time `ps` after the origin in ps of the capture, but not before the start of the
    /// capture.
    fn after_origin(&self, ps: u128) -> Option<u64> {
        let at = i128::try_from(ps).ok()? + i128::from(self.own.origin_ps);
        u64::try_from(at.max(0)).ok()
    }

    fn grid_time(&self) -> Option<u64> {
        let exact = u128::from(self.total_ps) * u128::from(self.grid) / u128::from(SAMPLES);
        self.after_origin(exact).filter(|_| self.grid <= SAMPLES)
    }

    /// The time at which the next segment of the axis starts or the running one ends.
    fn boundary(&self, index: usize) -> Option<u64> {
        let tick = self.axes.get(index)?.register.next_change()?;
        self.after_origin(u128::from(tick) * u128::from(tick_ps(&self.own.timebase)))
    }

    fn next_sample(&self) -> Option<u64> {
        let boundaries = (0..self.axes.len()).filter_map(|index| self.boundary(index));
        boundaries.chain(self.grid_time()).min()
    }

    /// Writes V and the profile at `ps`.
    fn sample(&mut self, index: usize, ps: u64) -> io::Result<()> {
        let tick_ps = tick_ps(&self.own.timebase);
        let since = i128::from(ps) - i128::from(self.own.origin_ps);
        let axis = &mut self.axes[index];
        let [_, _, _, v, profile_position, profile_speed, _] = self.ids[index];
        let now = axis.register.at(u64::try_from(since).unwrap_or(0) / tick_ps);
        if now != axis.v {
            axis.v = now;
            vector(&mut self.out, v, now, 64)?;
        }
        // Reals are repeated even if they do not change: a viewer that interpolates needs both ends
        // of a level.
        let tick = since as f64 / tick_ps as f64;
        real(&mut self.out, profile_position, axis.timeline.position_at(tick))?;
        real(&mut self.out, profile_speed, axis.timeline.speed_at(tick))
    }

    fn write(&mut self, change: PinChange) -> io::Result<()> {
        let index = usize::from(change.axis);
        if index >= self.axes.len() {
            return Ok(());
        }
        self.advance(change.ps)?;
        let axis = &mut self.axes[index];
        let [step, dir, position, _, _, _, error] = self.ids[index];
        self.out.bit(if change.pin == Pin::Step { step } else { dir }, change.level)?;
        if let Some(pulse) = axis.follower.change(change) {
            vector(&mut self.out, position, pulse.position, 32)?;
            if let Some(ns) = pulse.error_ns {
                real(&mut self.out, error, ns)?;
            }
            self.sample(index, change.ps)?;
        }
        Ok(())
    }

    fn close(&mut self, ps: u64) -> io::Result<()> {
        self.advance(ps)?;
        self.out.end()
    }
}

/// Writes a signed value in two's complement of `bits` bits.
fn vector<F: Format>(out: &mut F, id: F::Id, value: i64, bits: u32) -> io::Result<()> {
    out.vector(id, value.cast_unsigned() & (u64::MAX >> (u64::BITS - bits)), bits)
}

/// Writes a real with six decimals. This keeps files small; VCD readers accept at most 32
/// characters.
fn real<F: Format>(out: &mut F, id: F::Id, value: f64) -> io::Result<()> {
    const DIGITS: f64 = 1e6;
    let short = (value * DIGITS).round() / DIGITS;
    // Minus zero and values that are not finite are written as 0.
    out.real(id, if short.is_finite() && short != 0.0 { short } else { 0.0 })
}

impl<F: Format> PinSink for WaveWriter<'_, F> {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        if let Some(axis) = self.axes.get_mut(usize::from(level.axis)) {
            axis.levels[usize::from(level.pin == Pin::Dir)] = level.level;
            axis.follower.initial(level.pin, level.level);
        }
        Ok(())
    }

    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        self.write(change).map_err(|source| TraceError::Write { what: F::NAME, source })
    }

    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        self.close(ps).map_err(|source| TraceError::Write { what: F::NAME, source })
    }
}

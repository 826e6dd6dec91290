//! Writes the waveform: pins, registers and the float profile beside them, in any [`Format`].
//!
//! Integers are values of the gateware, and reals those of the profile, so that a viewer can draw
//! one over the other. All times are those of the pins: V is shown by the latency L later than in
//! the register, directly above the edges that it causes.

use crate::edge::{Pin, PinChange, PinSink};
use crate::error::TraceError;
use crate::follow::Follower;
use crate::ideal::{rounded, tick_ps};
use crate::speed_register::SpeedRegister;
use crate::vcd_own::OwnCapture;
use crate::view::{Place, View};
use crate::wave_format::{Format, MILLION, SIGNALS};
use carrystep_core::{Segment, StartPhase, Timebase};
use carrystep_profile::{Timeline, Walk};
use std::io;

/// Number of samples of the slow signals over a run, in addition to those at edges and segment
/// boundaries.
const SAMPLES: u64 = 500;

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
    /// What is written.
    pub view: View,
}

/// The values that the waveform of one axis shows beside its pins.
pub struct AxisWaves<'a> {
    /// The name of the axis, which is the scope of its signals.
    pub name: &'a str,
    /// The float profile.
    pub timeline: Timeline,
    /// The segments in order, each with its first tick from the origin.
    pub segments: Box<dyn Iterator<Item = (u64, Segment)> + 'a>,
}

/// Writes a waveform from a stream of pin changes.
pub(crate) struct WaveWriter<'a, F: Format> {
    out: F,
    own: OwnCapture,
    total_ps: u64,
    view: View,
    axes: Vec<AxisWriter<'a>>,
    /// The signals of each axis that is shown, after they have been declared.
    ids: Vec<[F::Id; SIGNALS.len()]>,
    /// Index of the next sample of the regular grid.
    grid: u64,
    /// No sample is before this time, ps.
    next: u64,
    /// The last time in the file, ps; `None` until the header is written.
    time: Option<u64>,
}

struct AxisWriter<'a> {
    /// Number of the axis.
    number: usize,
    name: &'a str,
    profile: Walk,
    follower: Follower,
    register: SpeedRegister<'a>,
    levels: [bool; 2],
    v: i64,
}

impl<'a, F: Format> WaveWriter<'a, F> {
    /// A writer that has not written anything. It writes the header with the first change.
    pub(crate) fn new(out: F, waves: Waves<'a>) -> Self {
        let Waves { timebase, phase, origin_ps, total_ticks, axes, view } = waves;
        let shown = axes.into_iter().enumerate().filter(|(number, _)| view.shows(*number));
        let axes = shown.map(|(number, axis)| AxisWriter {
            number,
            name: axis.name,
            profile: axis.timeline.walk(),
            follower: Follower::new(&axis.timeline, phase, &timebase, origin_ps),
            register: SpeedRegister::new(axis.segments),
            levels: [false; 2],
            v: 0,
        });
        Self {
            out,
            own: OwnCapture { origin_ps, timebase, is_part: view != View::default() },
            total_ps: total_ticks.saturating_mul(tick_ps(&timebase)),
            axes: axes.collect(),
            view,
            ids: Vec::new(),
            grid: 0,
            next: 0,
            time: None,
        }
    }

    fn header(&mut self) -> io::Result<()> {
        let from = self.view.first_ps();
        if let Some(from) = from {
            let tick = self.since_origin(from) / tick_ps(&self.own.timebase);
            self.axes.iter_mut().for_each(|axis| axis.v = axis.register.at(tick));
        }
        let names: Vec<&str> = self.axes.iter().map(|axis| axis.name).collect();
        self.ids = self.out.declare(&self.own, &names)?;
        let tick_ps = tick_ps(&self.own.timebase) as f64;
        let tick = from.map_or(0.0, |from| self.since_origin(from) as f64 / tick_ps);
        let (axes, ids, begin) = (&mut self.axes, &self.ids, from.unwrap_or(0));
        self.out.initial(begin, |out| {
            for (axis, &[step, dir, position, v, travelled, speed, error]) in
                axes.iter_mut().zip(ids)
            {
                out.bit(step, axis.levels[0])?;
                out.bit(dir, axis.levels[1])?;
                vector(out, position, axis.follower.position(), 32)?;
                vector(out, v, axis.v, 64)?;
                let (at, moves) = from.map_or((0.0, 0.0), |_| axis.profile.at(tick));
                real(out, travelled, at)?;
                real(out, speed, moves)?;
                out.real(error, 0.0)?;
            }
            Ok(())
        })?;
        self.time = Some(begin);
        Ok(())
    }

    /// The time from the origin to `ps` of the capture, ps; 0 before the origin.
    fn since_origin(&self, ps: u64) -> u64 {
        u64::try_from(i128::from(ps) - i128::from(self.own.origin_ps)).unwrap_or(0)
    }

    /// Advances the file to `ps`, and writes all samples up to then.
    fn advance(&mut self, ps: u64) -> io::Result<()> {
        if self.time.is_none() {
            self.header()?;
        }
        while self.next <= ps {
            let next = self.next_sample();
            self.next = next.unwrap_or(u64::MAX);
            let Some(sample) = next.filter(|&at| at <= ps) else { break };
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
    fn after_origin(&self, ps: i128) -> Option<u64> {
        u64::try_from((ps + i128::from(self.own.origin_ps)).max(0)).ok()
    }

    /// The time of the next sample of the regular grid, which divides what is in view.
    fn grid_time(&self) -> Option<u64> {
        let since = |ps: u64| i128::from(ps) - i128::from(self.own.origin_ps);
        let total = i128::from(self.total_ps);
        let begin = self.view.first_ps().map_or(0, since);
        let end = self.view.last_ps().map_or(total, |to| since(to).min(total));
        let length = u128::try_from(end - begin).ok()?;
        let exact = i128::try_from(length * u128::from(self.grid) / u128::from(SAMPLES)).ok()?;
        self.after_origin(begin + exact).filter(|_| self.grid <= SAMPLES)
    }

    /// The time at which the next segment of the axis starts or the running one ends.
    fn boundary(&self, index: usize) -> Option<u64> {
        let tick = self.axes.get(index)?.register.next_change()?;
        self.after_origin(i128::from(tick) * i128::from(tick_ps(&self.own.timebase)))
    }

    fn next_sample(&self) -> Option<u64> {
        let boundaries = (0..self.axes.len()).filter_map(|index| self.boundary(index));
        boundaries.chain(self.grid_time()).min()
    }

    /// Writes V and the profile at `ps`.
    fn sample(&mut self, index: usize, ps: u64) -> io::Result<()> {
        let tick_ps = tick_ps(&self.own.timebase);
        let since = i128::from(ps) - i128::from(self.own.origin_ps);
        let since_origin = self.since_origin(ps);
        let axis = &mut self.axes[index];
        let [_, _, _, v, profile_position, profile_speed, _] = self.ids[index];
        let now = axis.register.at(since_origin / tick_ps);
        if now != axis.v {
            axis.v = now;
            vector(&mut self.out, v, now, 64)?;
        }
        // Reals are repeated even if they do not change: a viewer that interpolates needs both ends
        // of a level.
        let tick = since as f64 / tick_ps as f64;
        let (at, moves) = axis.profile.at(tick);
        real(&mut self.out, profile_position, at)?;
        real(&mut self.out, profile_speed, moves)
    }

    /// The place of an axis among those that are shown.
    fn index(&self, axis: u8) -> Option<usize> {
        let number = usize::from(axis);
        match self.axes.get(number) {
            Some(axis) if axis.number == number => Some(number),
            _ => self.axes.iter().position(|axis| axis.number == number),
        }
    }

    fn write(&mut self, change: PinChange) -> io::Result<()> {
        let Some(index) = self.index(change.axis) else { return Ok(()) };
        match self.view.place(change.ps) {
            Place::Before => {
                let axis = &mut self.axes[index];
                axis.levels[usize::from(change.pin == Pin::Dir)] = change.level;
                axis.follower.change(change);
                self.go_to(change.ps);
                return Ok(());
            }
            Place::Within => {}
            Place::After => return self.leave(),
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

    /// Goes on to `ps`, before the window, so that the moves behind are not kept.
    fn go_to(&mut self, ps: u64) {
        let tick = self.since_origin(ps) / tick_ps(&self.own.timebase);
        for axis in &mut self.axes {
            axis.register.go_to(tick);
            axis.profile.go_to(tick as f64);
        }
    }

    /// Writes what is left of the window. The moves behind it are not read.
    fn leave(&mut self) -> io::Result<()> {
        if let Some(last) = self.view.last_ps() {
            self.advance(last)?;
            self.axes.clear();
        }
        Ok(())
    }

    /// Completes the file. A run that ended before the window leaves its last levels there.
    fn close(&mut self, ps: u64) -> io::Result<()> {
        let last = ps.min(self.view.last_ps().unwrap_or(u64::MAX));
        self.advance(last.max(self.view.first_ps().unwrap_or(0)))?;
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
    let millionths = rounded(value * MILLION);
    // Minus zero and values that are not finite are written as 0.
    out.real(id, if millionths.is_finite() && millionths != 0.0 { millionths } else { 0.0 })
}

impl<F: Format> PinSink for WaveWriter<'_, F> {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        if let Some(index) = self.index(level.axis) {
            let axis = &mut self.axes[index];
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

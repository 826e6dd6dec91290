//! Passes one axis through a window of clocks: its accumulator stretch by stretch, its step shaper
//! request by request.

use super::crossings::{BATCH, Stretch};
use super::edges::Record;
use super::pins::{Overrun, Pins};
use crate::parts::cubic::Cubic;
use crate::parts::moving::Moving;
use crate::parts::phase::{bisect, crosses};
use crate::parts::stage::{Stage, Step};
use carrystep_core::{PinTiming, Timebase};

/// A run of clocks that is passed at once; every strobe in it only adds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    /// First cycle of the tick in which the window begins.
    pub tick: u64,
    /// First cycle of the window.
    pub from: u64,
    /// First cycle after the window.
    pub to: u64,
}

/// The cycle in which a fault is latched; the window must end before it.
pub(super) struct FaultIn(pub u64);

impl From<Overrun> for FaultIn {
    fn from(Overrun(cycle): Overrun) -> Self {
        Self(cycle)
    }
}

/// An axis that is being passed through a window.
struct Passage<'a> {
    pins: Pins<'a>,
    window: Window,
    clocks_per_tick: u32,
    clocks_per_phase: u32,
    phase_bits: u32,
}

/// Passes an axis through a window and appends its edges to `edges`. The error is the cycle of a
/// fault.
pub(super) fn pass(
    moving: &mut Moving,
    axis: u8,
    window: Window,
    timebase: &Timebase,
    pins: PinTiming,
    edges: &mut Vec<Record>,
) -> Result<(), FaultIn> {
    let mut passage = Passage {
        pins: Pins::new(axis, pins, moving.shaper, moving.emitted.sign, window.from, edges),
        window,
        clocks_per_tick: timebase.clocks_per_tick(),
        clocks_per_phase: timebase.clocks_per_phase(),
        phase_bits: timebase.phase_bits(),
    };
    let strobes = ((window.to - window.tick) / u64::from(passage.clocks_per_tick)) as u32;
    passage.request(moving.emitted, 0)?;
    if strobes > 0 {
        passage.emit(moving.computed, 1)?;
    }
    // The results of the last two ticks stay in the pipeline.
    let ahead = strobes.saturating_sub(2);
    passage.add(moving, ahead)?;
    for strobe in ahead..strobes {
        passage.tick(moving, strobe)?;
    }
    if strobes > 1 {
        passage.emit(moving.emitted, strobes)?;
    }
    moving.shaper = passage.pins.finish(window.to)?;
    Ok(())
}

impl Passage<'_> {
    /// First cycle of tick `n` of the window.
    fn cycle(&self, n: u32) -> u64 {
        self.window.tick + u64::from(n) * u64::from(self.clocks_per_tick)
    }

    /// Begins to emit a stage with tick `n`.
    fn emit(&mut self, stage: Stage, n: u32) -> Result<(), Overrun> {
        self.pins.sign(self.cycle(n), stage.sign)?;
        self.request(stage, n)
    }

    /// Requests the step of a stage that is emitted during tick `n`, if the request falls into the
    /// window.
    fn request(&mut self, stage: Stage, n: u32) -> Result<(), Overrun> {
        let Some(step) = stage.step else { return Ok(()) };
        let at = self.cycle(n) + u64::from(step.phase) * u64::from(self.clocks_per_phase);
        if (self.window.from..self.window.to).contains(&at) {
            self.pins.requests(&[at], step.backward)
        } else {
            Ok(())
        }
    }

    /// Executes the strobe at the end of tick `n`.
    fn tick(&mut self, moving: &mut Moving, n: u32) -> Result<(), FaultIn> {
        let Cubic { v, a, j } = moving.cubic;
        let Some(faster) = v.checked_add(a).filter(|&faster| faster != i64::MIN) else {
            return Err(FaultIn(self.cycle(n + 1) - 1));
        };
        let step = crosses(moving.p, v)
            .then(|| Step { backward: v < 0, phase: bisect(moving.p, v, self.phase_bits) });
        moving.emitted = moving.computed;
        moving.computed = Stage { step, sign: v.signum() as i8 };
        moving.p = moving.p.wrapping_add(v.cast_unsigned());
        moving.cubic = Cubic { v: faster, a: a.wrapping_add(j), j };
        Ok(())
    }

    /// Executes the first `ticks` strobes. All of their steps reach the pins within the window.
    fn add(&mut self, moving: &mut Moving, ticks: u32) -> Result<(), FaultIn> {
        if !moving.cubic.stays_in_range(ticks) {
            for n in 0..ticks {
                self.tick(moving, n)?;
                self.emit(moving.computed, n + 2)?;
            }
            return Ok(());
        }
        let mut done = 0;
        while done < ticks {
            let cubic = moving.cubic;
            let length = cubic.same_sign(ticks - done);
            self.pins.sign(self.cycle(done + 2), cubic.v.signum() as i8)?;
            self.requests(Stretch::new(moving.p, cubic, length), done, cubic.v < 0)?;
            moving.p = moving.p.wrapping_add(cubic.distance_wrapping(length));
            moving.cubic = cubic.after(length);
            done += length;
        }
        Ok(())
    }

    /// Requests all steps of a stretch that begins at tick `done`.
    fn requests(&mut self, stretch: Stretch, done: u32, backward: bool) -> Result<(), Overrun> {
        let mut overrun = Ok(());
        let first = self.cycle(done + 2);
        let [per_tick, per_phase] = [self.clocks_per_tick, self.clocks_per_phase].map(u64::from);
        let mut clocks = [0; BATCH];
        stretch.each(self.phase_bits, |ticks, phases| {
            for ((clock, &tick), &phase) in clocks.iter_mut().zip(ticks).zip(phases) {
                *clock = first + u64::from(tick) * per_tick + u64::from(phase) * per_phase;
            }
            if overrun.is_ok() {
                overrun = self.pins.requests(&clocks[..ticks.len()], backward);
            }
        });
        overrun
    }
}

//! Follows one axis pulse by pulse beside its profile, for the waveform, the CSV and the plot.

use crate::edge::{Pin, PinChange};
use crate::ideal::{Due, tick_ps};
use carrystep_core::{StartPhase, Timebase};
use carrystep_profile::{Crossing, Timeline};
use std::fmt;

/// One pulse on the pins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pulse {
    /// Number of the pulse on this axis, counted from 1.
    pub number: u64,
    /// Time of the rising edge of STEP, ps of the capture.
    pub ps: u64,
    /// The level of DIR at that time; true is backward.
    pub backward: bool,
    /// Steps forward minus steps backward, with this pulse.
    pub position: i64,
    /// Lateness against the profile, ns; negative is early. `None` beyond the profile's last pulse.
    pub error_ns: Option<f64>,
    /// Time since the previous pulse, ps; `None` for the first pulse and after a reversal.
    pub period_ps: Option<u64>,
}

impl Pulse {
    /// Speed over the period that this pulse ends, steps/s; negative is backward.
    pub fn speed(&self) -> Option<f64> {
        let period = self.period_ps.filter(|&ps| ps > 0)?;
        let speed = 1e12 / period as f64;
        Some(if self.backward { -speed } else { speed })
    }
}

/// Pairs the k-th rising edge of an axis with the k-th crossing of its profile.
pub struct Follower {
    crossings: Box<dyn Iterator<Item = Crossing>>,
    origin_ps: i64,
    tick_ps: u64,
    step: bool,
    dir: bool,
    last: Option<Pulse>,
}

impl fmt::Debug for Follower {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Follower").field("last", &self.last).finish_non_exhaustive()
    }
}

impl Follower {
    /// Follows one axis. `origin_ps` is the load of the first move plus the latency L, ps of the
    /// capture.
    pub fn new(
        timeline: &Timeline,
        phase: StartPhase,
        timebase: &Timebase,
        origin_ps: i64,
    ) -> Self {
        let crossings = Box::new(timeline.crossings(phase));
        Self {
            crossings,
            origin_ps,
            tick_ps: tick_ps(timebase),
            step: false,
            dir: false,
            last: None,
        }
    }

    /// Sets the level of a pin at the start of the capture.
    pub fn initial(&mut self, pin: Pin, level: bool) {
        match pin {
            Pin::Step => self.step = level,
            Pin::Dir => self.dir = level,
        }
    }

    /// Steps forward minus steps backward so far.
    pub fn position(&self) -> i64 {
        self.last.map_or(0, |pulse| pulse.position)
    }

    /// Takes a change of this axis. Returns the pulse if STEP rises.
    pub fn change(&mut self, change: PinChange) -> Option<Pulse> {
        let rises = change.pin == Pin::Step && change.level && !self.step;
        self.initial(change.pin, change.level);
        rises.then(|| {
            let crossing = self.crossings.next();
            let lateness = |c| Due::of(&c, self.tick_ps).lateness_ps(change.ps, self.origin_ps);
            let (number, position) = self.last.map_or((0, 0), |p| (p.number, p.position));
            let same_way = self.last.filter(|p| p.backward == self.dir);
            let pulse = Pulse {
                number: number + 1,
                ps: change.ps,
                backward: self.dir,
                position: position + if self.dir { -1 } else { 1 },
                error_ns: crossing.map(|c| lateness(c) / 1e3),
                period_ps: same_way.map(|p| change.ps.saturating_sub(p.ps)),
            };
            self.last = Some(pulse);
            pulse
        })
    }
}

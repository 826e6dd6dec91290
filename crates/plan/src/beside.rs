//! Judges a segment of a scaled fit beside the curve of its move, at samples that are kept in the
//! curve's own units.
//!
//! The samples stand for the edges of the segment, as those of `corridor.rs` do: each edge must be
//! neither early nor late by more than the tolerance. They are the curve itself and say nothing of
//! the fit; a scaled fit that is wrong fails here.

use crate::corridor::{Corridor, UNSEEN};
use crate::cubic::peak;
use crate::own::{Joint, KeptSegment, Sample, Samples};
use carrystep_profile::Real;

/// A ramp of a move: the size of its own units, and where it is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Size {
    /// Duration of the ramp, ticks.
    pub ticks: f64,
    /// Distance of the ramp, steps.
    pub steps: f64,
    /// Ticks from the start of the piece to the slow end of the ramp.
    pub rest: f64,
    /// Whether it is a ramp up. A ramp down is a ramp up in reverse.
    pub rises: bool,
}

/// A segment of a move in floats.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Laid {
    /// First tick, counted from the start of the piece.
    begin: f64,
    ticks: f64,
    /// Steps from the slow end of the ramp to where the segment begins.
    from_rest: f64,
    /// Coefficients of the ticks since the beginning, their square and their cube, steps.
    cubic: [f64; 3],
}

impl Size {
    fn sign(&self) -> f64 {
        if self.rises { 1.0 } else { -1.0 }
    }

    /// The own time at `tick` ticks of the piece.
    pub fn own(&self, tick: f64) -> f64 {
        self.sign() * (tick - self.rest) / self.ticks
    }

    /// Ticks from the start of the piece to an own time.
    pub fn tick(&self, own: f64) -> f64 {
        self.rest + self.sign() * own * self.ticks
    }
}

impl Laid {
    /// A segment whose V times its ticks, A and J are `found` steps, steps per tick^2 and per
    /// tick^3.
    pub fn new(first: u64, ticks: u64, from_rest: f64, found: [f64; 3]) -> Self {
        let [v, a, j] = [found[0] / ticks as f64, found[1], found[2]];
        let cubic = [v - a / 2.0 + j / 3.0, (a - j) / 2.0, j / 6.0];
        Self { begin: first as f64, ticks: ticks as f64, from_rest, cubic }
    }

    /// Steps after `t` ticks.
    fn travelled(&self, t: f64) -> f64 {
        let [c1, c2, c3] = self.cubic;
        t * (c1 + t * (c2 + t * c3))
    }

    /// The same on the chord of the tick that contains `t`.
    fn on_chord(&self, t: f64) -> f64 {
        let part = t - t.floor();
        let [from, to] = [t.floor(), t.floor() + 1.0].map(|t| self.travelled(t));
        from + part * (to - from)
    }
}

impl<F: Real> Corridor<'_, F> {
    /// The greatest fraction of the tolerance by which an edge of the segment may be early or late.
    pub fn level(&self, size: &Size, own: &KeptSegment, laid: &Laid) -> f64 {
        let (sign, late) = (size.sign(), self.tolerance);
        let weight = size.ticks / (size.steps * late);
        let (origin, pace) = (size.rest - laid.begin, sign * size.ticks);
        let acceleration = sign * size.steps / (size.ticks * size.ticks);
        let sides = |sample: &Sample| {
            let t = origin + pace * sample.time;
            let ahead = sign * (size.steps * sample.place - laid.from_rest);
            let weight = weight * sample.slowness;
            let (end, start) = (t + late, t - late);
            if self.bend * weight / 8.0 > UNSEEN {
                // How far the chord of the curve's tick lies above the curve.
                let sag = |t: f64| {
                    let part = t - t.floor();
                    acceleration * sample.bend * part * (1.0 - part) / 2.0
                };
                return [
                    (ahead + sag(end) - laid.on_chord(end)) * weight + 1.0,
                    (laid.on_chord(start) - ahead - sag(start)) * weight + 1.0,
                ];
            }
            [
                (ahead - laid.travelled(end)) * weight + 1.0,
                (laid.travelled(start) - ahead) * weight + 1.0,
            ]
        };
        match &own.samples {
            Samples::Standing(samples) => peaks(&samples.iter().map(sides)),
            Samples::Edges(pulses) => {
                let inside =
                    |sample: &Sample| (0.0..=laid.ticks).contains(&(origin + pace * sample.time));
                let due = pulses.iter().map(|(steps, span)| span.at(steps / size.steps));
                let levels = due.filter(inside).flat_map(|sample| sides(&sample));
                levels.fold(0.0, f64::max)
            }
        }
    }

    /// As [`Self::level`], for the pulses next to the segment: the one due before it must not come
    /// too late within it, and the one due after it must not come too early.
    pub fn beside(&self, size: &Size, [from, to]: [&Joint; 2], laid: &Laid) -> f64 {
        let (sign, late) = (size.sign(), self.tolerance);
        let offset = self.phase.pulse_half_steps(1, false) as f64 / 2.0;
        // The place of the next pulse from a joint toward `side`, and the ticks to it.
        let next = |joint: &Joint, tick: f64, side: f64| {
            let [place, speed] = joint.at(size.own(tick)).map(|x| x * size.steps);
            let speed = speed / size.ticks;
            let pulses = (place - offset) * side;
            let pulse = (pulses.floor() + 1.0) * side + offset;
            (pulse, (pulse - place).abs() / speed, speed * late)
        };
        let mut level = 0.0_f64;
        let (pulse, before, width) = next(from, laid.begin, -sign);
        if before <= late && pulse >= offset {
            let ahead = sign * (pulse - laid.from_rest);
            level = (ahead - laid.travelled(late - before)) / width + 1.0;
        }
        let (pulse, after, width) = next(to, laid.begin + laid.ticks, sign);
        if after <= late && pulse >= offset {
            let ahead = sign * (pulse - laid.from_rest);
            level = level.max((laid.travelled(laid.ticks + after - late) - ahead) / width + 1.0);
        }
        level
    }
}

impl Joint {
    /// Place and speed at an own time near the joint. Beyond its end, a ramp goes on at its top
    /// speed.
    fn at(&self, time: f64) -> [f64; 2] {
        let off = time - self.time;
        let bend = if self.time >= 1.0 && off > 0.0 { 0.0 } else { self.bend };
        [self.place + off * (self.speed + off * bend / 2.0), self.speed + off * bend]
    }
}

/// The greater [`peak`] of two rows of values.
fn peaks(sides: &(impl Iterator<Item = [f64; 2]> + Clone)) -> f64 {
    let side = |k: usize| peak(sides.clone().map(move |side| side[k]));
    side(0).max(side(1))
}

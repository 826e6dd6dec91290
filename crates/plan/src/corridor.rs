//! Where a curve may run so that its edges keep within a tolerance of the profile's.
//!
//! With x(t) the profile and T the tolerance, an edge is not late if the curve has passed x(t) at t + T, and
//! not early if it has not yet at t - T. Only edges count: where a stretch has few, each is a sample; where it
//! has many, samples stand for them, closer together near the ends, as the zeros of Chebyshev's polynomials do.

use crate::demand::{Clock, float};
use crate::exchange::Row;
use crate::share::Piece;
use carrystep_core::StartPhase;
use carrystep_core::fixed::ONE_STEP;
use carrystep_profile::{Profile, Real};

/// Fewest edges of a stretch that samples may stand for, and the number of these samples.
const SAMPLES: u32 = 16;

/// How close to the profile, in steps, a curve is kept between edges that are far apart: it keeps to the next ones.
const BETWEEN: f64 = 0.2;

/// The part of the tolerance that may be lost to the chord of a tick unseen.
const UNSEEN: f64 = 0.05;

/// How close to the end of the move, in steps, a curve is kept before the integers land it.
const AT_REST: f64 = 1e-3;

/// The part of the tolerance that a stretch may leave at its end: the next one starts with that error.
pub(crate) const JOINT: f64 = 0.8;

/// The tolerance around one piece of a profile.
#[derive(Debug)]
pub(crate) struct Corridor<'a, F> {
    pub profile: &'a dyn Profile<F>,
    pub clock: Clock<F>,
    pub phase: StartPhase,
    pub backward: bool,
    /// Pulses of the whole move.
    pub pulses: u64,
    pub piece: Piece,
    /// Whether the piece is slower at its start than at its end.
    pub rises: bool,
    /// Ticks.
    pub tolerance: f64,
    /// The acceleration limit, steps per tick^2.
    pub bend: f64,
}

/// Ticks within a piece, and where the axis is when they begin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stretch {
    /// First tick, from the start of the piece.
    pub first: u64,
    pub ticks: u64,
    /// Distance from the start of the move, 2^-64 step.
    pub done: i128,
}

/// What the rows of a stretch are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Samples {
    /// Four rows that alternate.
    pub start: [usize; 4],
    /// How many rows come first that stand for others between them, two a sample.
    pub standing: usize,
}

/// Units as steps.
pub(crate) fn steps(units: i128) -> f64 {
    units as f64 * 2_f64.powi(-64)
}

/// The shape of the three registers' distances after `t` of `n` ticks, for V n, A n^2 and J n^3.
pub(crate) fn basis(t: f64, n: f64) -> [f64; 3] {
    let s = t / n;
    let pairs = s * (t - 1.0) / (2.0 * n);
    [s, pairs, pairs * (t - 2.0) / (3.0 * n)]
}

/// The same where edges are: on the chord from tick to tick.
fn chord(t: f64, n: f64) -> [f64; 3] {
    let part = t - t.floor();
    let [from, to] = [t.floor(), t.floor() + 1.0].map(|t| basis(t, n));
    std::array::from_fn(|k| from[k] + part * (to[k] - from[k]))
}

fn wide<F: Real>(x: F) -> f64 {
    x.to_f64().unwrap_or(f64::NAN)
}

impl<F: Real> Corridor<'_, F> {
    /// Seconds from the start of the move to `t` ticks into the piece.
    fn seconds(&self, t: f64) -> F {
        let exact = float::<F>(self.piece.first) + F::from(t).unwrap_or_else(F::nan);
        (exact * self.clock.tick).min(self.clock.seconds)
    }

    /// Whether the first pulse is due with the first motion: then V must not start at 0.
    pub fn steps_at_once(&self) -> bool {
        self.phase == StartPhase::Zero && self.backward
    }

    /// Speed `t` ticks into the piece, steps per tick.
    pub fn speed(&self, t: f64) -> f64 {
        wide(self.profile.speed(self.seconds(t)) * self.clock.tick)
    }

    /// Steps from `done` to where the profile is `t` ticks into the piece: by way of the slower end of the piece,
    /// so that near rest no two long distances are subtracted.
    pub fn ahead(&self, done: i128, t: f64) -> f64 {
        let Piece { first, ticks, start, units, .. } = self.piece;
        let now = self.seconds(t);
        let travelled = |from: F, to: F| wide(self.profile.mean_speed(from, to) * (to - from));
        if self.rises {
            travelled(self.clock.at(first), now) - steps(done - start)
        } else {
            steps(start + units - done) - travelled(now, self.clock.at(first + ticks))
        }
    }

    /// Rows for all edges of a stretch.
    pub fn rows(&self, stretch: Stretch, rows: &mut Vec<Row>) -> Samples {
        let Stretch { first, ticks, done } = stretch;
        let (begin, n) = (first as f64, ticks as f64);
        let here = |t: f64| steps(done) + self.ahead(done, begin + t);
        let before = self.pulses_until(here(0.0));
        let until = self.pulses_until(here(n));
        let edges = until.saturating_sub(before);
        if edges > u64::from(SAMPLES) {
            // Where edges are far apart, none is before the first and behind the last.
            let sparse = |t: f64| self.speed(begin + t) * n < 64.0;
            let low = if sparse(0.0) { self.edge(stretch, before + 1).0 } else { 0.0 };
            let high = if sparse(n) { self.edge(stretch, until).0 } else { n };
            let last = f64::from(SAMPLES);
            let quarters = [1, 2, 3, 4].map(|k| 2 * (k * SAMPLES as usize / 4));
            for k in 0..=SAMPLES {
                let part = (1.0 - (std::f64::consts::PI * f64::from(k) / last).cos()) / 2.0;
                let t = low + (high - low) * part;
                self.both_sides(rows, stretch, t, self.ahead(done, begin + t), 0.0);
            }
            self.joint(rows, stretch, self.pulses);
            self.neighbours(rows, stretch, before, until);
            return Samples { start: alternating(quarters), standing: 2 * (SAMPLES as usize + 1) };
        }
        for quarter in [0.25, 0.5, 0.75] {
            let t = n * quarter;
            self.both_sides(rows, stretch, t, self.ahead(done, begin + t), BETWEEN);
        }
        self.joint(rows, stretch, until);
        self.neighbours(rows, stretch, before, until);
        for pulse in before + 1..=until {
            let (t, ahead) = self.edge(stretch, pulse);
            self.both_sides(rows, stretch, t, ahead, 0.0);
        }
        Samples { start: alternating([0, 2, 4, 6]), standing: 0 }
    }

    /// Where the next stretch starts, the error is smaller; before the first edge, as small as it is there.
    fn joint(&self, rows: &mut Vec<Row>, stretch: Stretch, until: u64) {
        let Stretch { first, ticks, done } = stretch;
        let n = ticks as f64;
        let end = first as f64 + n;
        let next = if until < self.pulses { self.edge(stretch, until + 1).0 } else { n };
        let speed = self.speed(end).max(self.speed(first as f64 + next));
        let width = if speed > 0.0 { speed * self.tolerance * JOINT } else { AT_REST };
        let ahead = self.ahead(done, end);
        for sign in [-1.0, 1.0] {
            rows.push(Row { at: basis(n, n).map(|b| sign * b / width), error: 1.0, most: sign * ahead / width });
        }
    }

    /// The pulse due before the stretch may come in it, but not too late; the one due after it not too early.
    fn neighbours(&self, rows: &mut Vec<Row>, stretch: Stretch, before: u64, until: u64) {
        let n = stretch.ticks as f64;
        let mut keep = |sign: f64, pulse: u64| {
            let (t, ahead) = self.edge(stretch, pulse);
            let width = self.speed(stretch.first as f64 + t) * self.tolerance;
            let at = t - sign * self.tolerance;
            if width > 0.0 && (0.0..=n).contains(&at) {
                let most = sign * ahead / width - 1.0;
                rows.push(Row { at: basis(at, n).map(|b| sign * b / width), error: 1.0, most });
            }
        };
        if before > 0 {
            keep(-1.0, before);
        }
        if until < self.pulses {
            keep(1.0, until + 1);
        }
    }

    /// Pulses that are due up to a position.
    fn pulses_until(&self, position: f64) -> u64 {
        let offset = self.phase.pulse_half_steps(1, self.backward) as f64 / 2.0;
        ((position - offset + 1.0).floor().max(0.0) as u64).min(self.pulses)
    }

    /// When a pulse is due, in ticks of the stretch, and how many steps it is ahead.
    fn edge(&self, Stretch { first, done, .. }: Stretch, pulse: u64) -> (f64, f64) {
        let half_steps = self.phase.pulse_half_steps(pulse, self.backward);
        let due = self.profile.crossing(F::from(half_steps as f64 / 2.0).unwrap_or_else(F::nan));
        let t = wide((due - self.clock.at(self.piece.first + first)) / self.clock.tick);
        (t, steps(i128::from(half_steps) * (ONE_STEP / 2) - done))
    }

    /// How far the chord of the profile's tick is above the profile, steps.
    fn sag(&self, stretch: Stretch, t: f64) -> f64 {
        let part = t - t.floor();
        let acceleration = self.profile.acceleration(self.seconds(stretch.first as f64 + t)) * self.clock.tick;
        wide(acceleration * self.clock.tick) * part * (1.0 - part) / 2.0
    }

    /// Not late, not early: the curve passes `ahead` within the tolerance of `t`, or within `least` steps of it.
    fn both_sides(&self, rows: &mut Vec<Row>, stretch: Stretch, t: f64, ahead: f64, least: f64) {
        let n = stretch.ticks as f64;
        let width = self.speed(stretch.first as f64 + t) * self.tolerance;
        let (width, late) = if width > least { (width, self.tolerance) } else { (least, 0.0) };
        // At rest no time is too long: such an edge is where the move ends, or where it starts.
        let weight = if width > 0.0 { width.recip() } else { 0.0 };
        let slack = if late > 0.0 { 1.0 } else { 0.0 };
        // An edge is on the chord of its tick. That of the profile itself is in the bound of its edges already, so
        // the curve's may be off the curve as far, but not further.
        let chords = late > 0.0 && self.bend / 8.0 > UNSEEN * width;
        let side = |t: f64| if chords { (chord(t, n), self.sag(stretch, t)) } else { (basis(t, n), 0.0) };
        let [(after, above), (before, below)] = [t + late, t - late].map(side);
        rows.push(Row { at: after.map(|b| -b * weight), error: 1.0, most: -(ahead + above) * weight - slack });
        rows.push(Row { at: before.map(|b| b * weight), error: 1.0, most: (ahead + below) * weight - slack });
    }
}

/// The greatest of evenly spaced values and of what a parabola through three of them says lies between.
pub(crate) fn peak(values: impl Iterator<Item = f64>) -> f64 {
    let (mut greatest, mut held) = (0.0_f64, [f64::NAN; 2]);
    for next in values {
        let [before, here] = held;
        let bend = before - 2.0 * here + next;
        if here >= before && here > next {
            greatest = greatest.max(here - (next - before).powi(2) / (8.0 * bend));
        }
        greatest = greatest.max(next);
        held = [here, next];
    }
    greatest
}

/// Below, above, below, above: the first rows of four samples.
fn alternating(samples: [usize; 4]) -> [usize; 4] {
    std::array::from_fn(|k| samples[k] + k % 2)
}

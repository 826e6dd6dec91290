//! The corridor of a fit: where a curve may run so that its edges stay within a tolerance of the
//! profile's edges.
//!
//! Let x(t) be the profile and T the tolerance. An edge is not late if the curve has reached x(t)
//! at t + T, and not early if it has not yet reached x(t) at t - T. Only edges count. A stretch
//! with few edges has one sample for each of them. In a stretch with many edges, samples stand for
//! them; they are closer together near the ends, like the zeros of Chebyshev's polynomials. The
//! constants below may be tuned; `judge` in `fit.rs` decides on the integers.

use crate::cubic::{basis, chord, steps, wide};
use crate::demand::{Clock, float};
use crate::exchange::Row;
use crate::share::Piece;
use carrystep_core::StartPhase;
use carrystep_profile::{Profile, Real};

/// The number of sample intervals of a stretch, and the number of edges up to which every edge is a
/// sample of its own.
pub(crate) const SAMPLES: u32 = 16;

/// How close to the profile, in steps, a curve is kept between edges that are far apart, so that it
/// does not miss the edges that follow.
const BETWEEN: f64 = 0.2;

/// The fraction of the tolerance below which the deviation of a tick's chord is ignored.
pub(crate) const UNSEEN: f64 = 0.05;

/// The part of the tolerance that a fit for ramps of many sizes uses at an edge of its own sample.
const SPARED: f64 = 0.97;

/// How close to the end of the move, in steps, a curve has to come before the integers land
/// exactly.
const AT_REST: f64 = 1e-3;

/// The fraction of the tolerance that a stretch may leave at its end, because the next stretch
/// starts with that error.
pub(crate) const JOINT: f64 = 0.8;

/// The tolerance around one piece of a profile.
#[derive(Debug)]
pub(crate) struct Corridor<'a, F> {
    pub profile: &'a dyn Profile<F>,
    pub clock: Clock<F>,
    pub phase: StartPhase,
    pub backward: bool,
    /// Number of pulses of the whole move.
    pub pulses: u64,
    pub piece: Piece,
    /// Whether the piece is slower at its start than at its end.
    pub rises: bool,
    /// Tolerance of an edge, ticks.
    pub tolerance: f64,
    /// The acceleration limit, steps per tick^2.
    pub bend: f64,
    /// The fraction of the tolerance that a stretch may leave at its end, usually [`JOINT`].
    pub joint: f64,
    /// The factor by which the ramp may be longer than this one, in steps: each of its edges then
    /// lies between its place and the place divided by this factor. 1 for the ramp of a move.
    pub longer: f64,
}

/// A run of ticks within a piece, and the position of the axis when the run begins.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stretch {
    /// First tick, counted from the start of the piece.
    pub first: u64,
    pub ticks: u64,
    /// Distance from the start of the move, 2^-64 step.
    pub done: i128,
}

/// Describes the rows that [`Corridor::rows`] has written.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Samples {
    /// Indices of four rows that alternate in sign, to start the exchange from.
    pub start: [usize; 4],
    /// Number of leading rows that stand for many edges, two rows for each sample; 0 if every edge
    /// has rows of its own.
    pub standing: usize,
}

impl<F: Real> Corridor<'_, F> {
    /// Seconds from the start of the move to `t` ticks into the piece, limited to the end of the
    /// move.
    fn seconds(&self, t: f64) -> F {
        let exact = float::<F>(self.piece.first) + F::from(t).unwrap_or_else(F::nan);
        (exact * self.clock.tick).min(self.clock.seconds)
    }

    /// Whether the first pulse is due at the start of the motion; V must then not start at 0.
    pub fn steps_at_once(&self) -> bool {
        self.phase == StartPhase::Zero && self.backward
    }

    /// Speed of the profile `t` ticks into the piece, steps per tick.
    pub fn speed(&self, t: f64) -> f64 {
        wide(self.profile.speed(self.seconds(t)) * self.clock.tick)
    }

    /// Steps from `done` to the position of the profile `t` ticks into the piece. The distance is
    /// taken from the slower end of the piece, so that near rest no two long distances are
    /// subtracted.
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

    /// Appends the rows for all edges of a stretch to `rows`, and describes them.
    pub fn rows(&self, stretch: Stretch, rows: &mut Vec<Row>) -> Samples {
        let Stretch { first, ticks, done } = stretch;
        let (begin, n) = (first as f64, ticks as f64);
        let here = |t: f64| steps(done) + self.ahead(done, begin + t);
        let before = self.pulses_until(here(0.0));
        let until = self.pulses_until(here(n));
        if let Some([low, high]) = self.span(stretch, before, until) {
            let quarters = [1, 2, 3, 4].map(|k| 2 * (k * SAMPLES as usize / 4));
            for k in 0..=SAMPLES as usize {
                let t = low + (high - low) * spread(k);
                self.both_sides(rows, stretch, (t, self.ahead(done, begin + t)), 0.0, true);
            }
            self.joint(rows, stretch, self.pulses);
            self.neighbours(rows, stretch, before, until);
            return Samples { start: alternating(quarters), standing: 2 * (SAMPLES as usize + 1) };
        }
        for quarter in [0.25, 0.5, 0.75] {
            let t = n * quarter;
            self.both_sides(rows, stretch, (t, self.ahead(done, begin + t)), BETWEEN, false);
        }
        self.joint(rows, stretch, until);
        self.neighbours(rows, stretch, before, until);
        for (t, ahead) in self.edges(stretch, before, until) {
            self.both_sides(rows, stretch, (t, ahead), 0.0, false);
        }
        Samples { start: alternating([0, 2, 4, 6]), standing: 0 }
    }

    /// Bounds the error at the end of a stretch, because the next stretch starts with it. The bound
    /// is the distance that the axis travels in the fraction `joint` of the tolerance, at the
    /// speed there or at the next edge, whichever is greater. At rest it is [`AT_REST`] steps.
    fn joint(&self, rows: &mut Vec<Row>, stretch: Stretch, until: u64) {
        let Stretch { first, ticks, done } = stretch;
        let n = ticks as f64;
        let end = first as f64 + n;
        let next = if until < self.pulses { self.earlier(stretch, until + 1).0.max(n) } else { n };
        let speed = self.speed(end).max(self.speed(first as f64 + next));
        let width = if speed > 0.0 { speed * self.tolerance * self.joint } else { AT_REST };
        let ahead = self.ahead(done, end);
        for sign in [-1.0, 1.0] {
            rows.push(Row {
                at: basis(n, n).map(|b| sign * b / width),
                error: 1.0,
                most: sign * ahead / width,
            });
        }
    }

    /// Keeps the neighbouring edges: the pulse due before the stretch must not come too late within
    /// it, and the pulse due after it must not come too early.
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

    /// How far the chord of the profile's tick lies above the profile at time `t`, steps.
    fn sag(&self, stretch: Stretch, t: f64) -> f64 {
        let part = t - t.floor();
        let acceleration =
            self.profile.acceleration(self.seconds(stretch.first as f64 + t)) * self.clock.tick;
        wide(acceleration * self.clock.tick) * part * (1.0 - part) / 2.0
    }

    /// Appends the two rows of one sample: the curve passes `ahead` within the tolerance of time
    /// `t`, or, if the profile is slow, within `least` steps at `t`. Whether the sample is
    /// `standing` for many edges.
    fn both_sides(
        &self,
        rows: &mut Vec<Row>,
        stretch: Stretch,
        (t, ahead): (f64, f64),
        least: f64,
        standing: bool,
    ) {
        let n = stretch.ticks as f64;
        let speed = self.speed(stretch.first as f64 + t);
        // Between edges that are far apart, two segments may meet at different speeds. A ramp whose
        // joint is rounded to a tick then has other errors than this one.
        let part = if self.longer > 1.0 && least == 0.0 && !standing { SPARED } else { 1.0 };
        let tolerance = self.tolerance * part;
        let width = speed * tolerance;
        let (width, late) = if width > least { (width, tolerance) } else { (least, 0.0) };
        // An edge at rest is the first or the last of the move. Its time has no bound, so its rows
        // get the weight 0.
        let weight = if width > 0.0 { width.recip() } else { 0.0 };
        let slack = if late > 0.0 { 1.0 } else { 0.0 };
        // An edge lies on the chord of its tick. The edges of the profile are computed without
        // chords, so the chord of the curve may deviate from the curve as far as the profile's
        // chord does from the profile.
        let chords = late > 0.0 && self.bend / 8.0 > UNSEEN * width;
        let side =
            |t: f64| if chords { (chord(t, n), self.sag(stretch, t)) } else { (basis(t, n), 0.0) };
        let [(after, above), (before, below)] = [t + late, t - late].map(side);
        rows.push(Row {
            at: after.map(|b| -b * weight),
            error: 1.0,
            most: -(ahead + above) * weight - slack,
        });
        rows.push(Row {
            at: before.map(|b| b * weight),
            error: 1.0,
            most: (ahead + below) * weight - slack,
        });
    }
}

/// The indices of the rows below, above, below and above four samples, each given by its first row.
fn alternating(samples: [usize; 4]) -> [usize; 4] {
    std::array::from_fn(|k| samples[k] + k % 2)
}

/// Where sample `k` of [`SAMPLES`] lies between the first and the last, from 0 to 1.
pub(crate) fn spread(k: usize) -> f64 {
    (1.0 - (std::f64::consts::PI * k as f64 / f64::from(SAMPLES)).cos()) / 2.0
}

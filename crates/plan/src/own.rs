//! The fit of a ramp in the ramp's own units, from 0 to 1 in time and in distance, and the curve
//! that it is judged beside.
//!
//! `kept.rs` says when such a fit is made, and `scaled.rs` what becomes of it.

use crate::corridor::Stretch;
use crate::cubic::steps;
use crate::fit::Fitter;
use crate::fitted::Fitted;
use crate::sampled::Sampled;
use carrystep_profile::Curve;

/// The fit of a ramp up in its own units.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Kept {
    pub segments: Vec<KeptSegment>,
    /// The curve where a segment begins, and at the end of the last one.
    pub joints: Vec<Joint>,
}

/// A segment of a kept fit: a cubic, and the curve that it follows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct KeptSegment {
    /// The distance at which the cubic begins.
    pub place: f64,
    /// The coefficients of the time since the beginning of the segment, its square and its cube.
    pub cubic: [f64; 3],
    pub samples: Samples,
}

/// Where the curve of a segment is judged, in order of time.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Samples {
    /// Samples that stand for many edges; a peak between them counts.
    Standing(Vec<Sample>),
    /// Where each pulse that may be due in the segment lies, with its steps from rest.
    Edges(Vec<(f64, Span)>),
}

/// A sample of the curve: the time from the start of the ramp, the distance, the reciprocal of the
/// speed, and the acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sample {
    pub time: f64,
    pub place: f64,
    pub slowness: f64,
    pub bend: f64,
}

/// The curve between two places, as the time in powers of the part of the way between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    from: f64,
    length: f64,
    time: [f64; 6],
    bend: [f64; 2],
}

impl Span {
    /// Hermite's interpolation of the fifth order: of the times, and of their first and second
    /// derivatives. The places of one pulse differ by a 32nd; the interpolated time is then
    /// exact to 10^-12 of itself.
    fn between(ends: [Joint; 2]) -> Self {
        let [from, to] = ends;
        let length = to.place - from.place;
        let [slope, other] = ends.map(|end| length / end.speed);
        let [bent, other_bent] =
            ends.map(|end| -length * length * end.bend / (end.speed * end.speed * end.speed));
        let rise = to.time - from.time;
        let time = [
            from.time,
            slope,
            bent / 2.0,
            10.0 * rise - 6.0 * slope - 4.0 * other - 1.5 * bent + 0.5 * other_bent,
            -15.0 * rise + 8.0 * slope + 7.0 * other + 1.5 * bent - other_bent,
            6.0 * rise - 3.0 * (slope + other) - 0.5 * (bent - other_bent),
        ];
        Self { from: from.place, length, time, bend: [from.bend, to.bend - from.bend] }
    }

    /// The same curve, later by an own time.
    #[cfg(test)]
    pub fn delay(&mut self, time: f64) {
        self.time[0] += time;
    }

    /// The curve where it has come to `place`.
    pub fn at(&self, place: f64) -> Sample {
        let s = (place - self.from) / self.length;
        let [c0, c1, c2, c3, c4, c5] = self.time;
        let time = c0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
        let rate = c1 + s * (2.0 * c2 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)));
        let bend = self.bend[0] + s * self.bend[1];
        Sample { time, place, slowness: rate / self.length, bend }
    }
}

/// The curve at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Joint {
    pub time: f64,
    pub place: f64,
    pub speed: f64,
    pub bend: f64,
}

impl Kept {
    /// Takes the fit of a ramp to the own units of the ramp.
    pub fn of(fitted: &[Fitted], fitter: &Fitter<'_, f64>, ramp: &dyn Curve<f64>) -> Option<Self> {
        let corridor = &fitter.corridor;
        let (whole, distance) = (ramp.duration(), ramp.distance());
        let (per_time, per_square) = (whole / distance, whole * whole / distance);
        let joint = |t: f64| Joint {
            time: t / whole,
            place: ramp.position(t) / distance,
            speed: ramp.speed(t) * per_time,
            bend: ramp.acceleration(t) * per_square,
        };
        let (mut first, mut done) = (0_u64, 0_i128);
        let mut joints = vec![joint(0.0)];
        let mut segments = Vec::with_capacity(fitted.len());
        for one in fitted {
            let found = one.found(fitter.limits, false, false)?;
            let [v, a, j] = [found[0] / one.ticks as f64, found[1], found[2]];
            let samples = match corridor.sampled(Stretch { first, ticks: one.ticks, done }) {
                Sampled::Standing(times) => Samples::Standing(
                    times
                        .map(|t| {
                            let Joint { time, place, speed, bend } = joint(t);
                            Sample { time, place, slowness: speed.recip(), bend }
                        })
                        .into(),
                ),
                Sampled::Edges(from, to) => {
                    let span = |pulse: u64| {
                        let steps = corridor.phase.pulse_half_steps(pulse, false) as f64 / 2.0;
                        let ends = [steps / corridor.longer, steps];
                        (steps, Span::between(ends.map(|x| joint(ramp.crossing(x)))))
                    };
                    Samples::Edges((from..=to).map(span).collect())
                }
            };
            segments.push(KeptSegment {
                place: steps(done) / distance,
                cubic: [
                    (v - a / 2.0 + j / 3.0) * per_time,
                    (a - j) / 2.0 * per_square,
                    j / 6.0 * per_square * whole,
                ],
                samples,
            });
            first += one.ticks;
            done += one.distance;
            joints.push(joint(first as f64));
        }
        // The last V is whole, so up to a unit per tick may be left.
        let left = corridor.piece.units - done;
        (left.unsigned_abs() < u128::from(first)).then_some(Self { segments, joints })
    }
}

//! A whole move made of two ramps: a ramp up, a cruise and a ramp down.

use crate::curve::{Curve, is_time};
use crate::own::OwnRamp;
use crate::profile::{Profile, Real, real};

/// A move that ramps up, cruises at the speed that the ramp has reached, and ramps down along a
/// ramp that is mirrored in time.
///
/// ```text
/// top          __^^^^^^^^^^^^^__
///             /                 \
///           _/                   \_
///          :<-up->:<-cruise->:<down>:
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RampedMove<F, R> {
    up: R,
    down: R,
    top: F,
    duration: F,
    distance: F,
    breakpoints: Vec<F>,
}

impl<F: Real, R: Curve<F>> RampedMove<F, R> {
    /// Builds a move from two ramps that both end at `top` steps/s and fit into `distance` and
    /// `duration`. `down` is given as if it went up.
    pub(crate) fn new(distance: F, duration: F, top: F, up: R, down: R) -> Self {
        let rising = up.breakpoints().iter().copied().chain([up.duration()]);
        let falling = down.breakpoints().iter().rev().map(|&b| duration - b);
        let all = rising.chain([duration - down.duration()]).chain(falling);
        let most = up.breakpoints().len() + down.breakpoints().len() + 2;
        let mut breakpoints = Vec::with_capacity(most);
        for point in all {
            if point > breakpoints.last().copied().unwrap_or(F::zero()) && point < duration {
                breakpoints.push(point);
            }
        }
        Self { up, down, top, duration, distance, breakpoints }
    }

    /// The first ramp.
    pub fn up(&self) -> &R {
        &self.up
    }

    /// The last ramp, as if it went up.
    pub fn down(&self) -> &R {
        &self.down
    }

    /// Time at top speed, seconds.
    pub fn cruise_time(&self) -> F {
        (self.duration - self.up.duration() - self.down.duration()).max(F::zero())
    }

    fn phase(&self, t: F) -> Phase {
        if t < self.up.duration() {
            Phase::Up
        } else if t < self.duration - self.down.duration() {
            Phase::Cruise
        } else if self.down.duration() > F::zero() {
            Phase::Down
        } else {
            Phase::Cruise
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Phase {
    Up,
    Cruise,
    Down,
}

impl<F: Real, R: Curve<F>> Profile<F> for RampedMove<F, R> {
    fn shape(&self) -> &'static str {
        if self.up.duration().is_zero() && self.down.duration().is_zero() {
            "constant"
        } else {
            self.up.shape()
        }
    }

    fn duration(&self) -> F {
        self.duration
    }

    fn distance(&self) -> F {
        self.distance
    }

    fn position(&self, t: F) -> F {
        let left = self.duration - t;
        if t <= F::zero() {
            return F::zero();
        } else if left <= F::zero() {
            return self.distance;
        }
        match self.phase(t) {
            Phase::Up => self.up.position(t),
            Phase::Down => self.distance - self.down.position(left),
            Phase::Cruise => {
                let after = (t - self.up.duration()).max(F::zero());
                let before = (left - self.down.duration()).max(F::zero());
                // The distance is counted from the nearer end, so that it keeps its relative
                // precision near rest.
                if after <= before {
                    self.up.distance() + self.top * after
                } else {
                    self.distance - (self.down.distance() + self.top * before)
                }
            }
        }
    }

    fn speed(&self, t: F) -> F {
        match self.phase(t) {
            Phase::Up => self.up.speed(t),
            Phase::Cruise => self.top,
            Phase::Down => self.down.speed(self.duration - t),
        }
    }

    fn acceleration(&self, t: F) -> F {
        if t < F::zero() || t >= self.duration {
            return F::zero();
        }
        match self.phase(t) {
            Phase::Up => self.up.acceleration(t),
            Phase::Cruise => F::zero(),
            Phase::Down => -self.down.acceleration(self.duration - t),
        }
    }

    fn jerk(&self, t: F) -> F {
        if t < F::zero() || t >= self.duration {
            return F::zero();
        }
        match self.phase(t) {
            Phase::Up => self.up.jerk(t),
            Phase::Cruise => F::zero(),
            // Both signs cancel: time runs backward, and the speed falls.
            Phase::Down => self.down.jerk(self.duration - t),
        }
    }

    fn crossing(&self, x: F) -> F {
        let left = self.distance - x;
        if left <= F::zero() {
            return self.duration;
        } else if x <= F::zero() {
            return F::zero();
        }
        let (after, before) = (x - self.up.distance(), left - self.down.distance());
        if after <= F::zero() {
            self.up.crossing(x)
        } else if before <= F::zero() {
            self.duration - self.down.crossing(left)
        } else if after <= before {
            self.up.duration() + after / self.top
        } else {
            self.duration - (self.down.duration() + before / self.top)
        }
    }

    fn own_ramps(&self) -> Option<[OwnRamp; 2]> {
        Some([self.up.own_ramp()?, self.down.own_ramp()?])
    }

    fn breakpoints(&self) -> &[F] {
        &self.breakpoints
    }

    fn mean_speed(&self, from: F, to: F) -> F {
        let (zero, whole) = (F::zero(), to - from);
        if whole <= zero {
            return self.speed(from);
        }
        let (up, down) = (self.up.duration(), self.down.duration());
        let cruise_end = (self.duration - down).max(up);
        // Most spans are of one part of the move.
        if to <= up {
            return self.up.mean_speed(from, to);
        } else if from >= cruise_end {
            return self.down.mean_speed((self.duration - to).max(zero), self.duration - from);
        } else if from >= up && to <= cruise_end {
            return self.top;
        }
        let mut sum = zero;
        if from < up {
            let end = to.min(up);
            sum = sum + self.up.mean_speed(from, end) * ((end - from) / whole);
        }
        let (begin, end) = (from.max(up), to.min(cruise_end));
        if begin < end {
            sum = sum + self.top * ((end - begin) / whole);
        }
        if to > cruise_end {
            let begin = from.max(cruise_end);
            let (far, near) = (self.duration - begin, self.duration - to);
            sum = sum + self.down.mean_speed(near.max(zero), far) * ((to - begin) / whole);
        }
        sum
    }
}

impl<F: Real, R: Curve<F>> Curve<F> for RampedMove<F, R> {
    fn top_speed(&self) -> F {
        self.top
    }

    fn peak_acceleration(&self) -> F {
        self.up.peak_acceleration().max(self.down.peak_acceleration())
    }

    fn peak_jerk(&self) -> F {
        self.up.peak_jerk().max(self.down.peak_jerk())
    }

    fn acceleration_jump(&self) -> F {
        let ends = self.up.acceleration_jump().max(self.down.acceleration_jump());
        if is_time(self.cruise_time(), self.duration) {
            return ends;
        }
        // Where one ramp follows the other without a cruise, the two jumps at the top are one.
        let at_top = |ramp: &R| ramp.acceleration(ramp.duration());
        ends.max(at_top(&self.up) + at_top(&self.down))
    }
}

/// The time of a move of `distance` steps with these ramps and a cruise at `top` steps/s between
/// them, seconds.
pub(crate) fn time_with_cruise<F: Real, R: Curve<F>>(distance: F, top: F, up: &R, down: &R) -> F {
    let cruise = distance - up.distance() - down.distance();
    up.duration() + down.duration() + cruise.max(real(0.0)) / top
}

//! The interface of every profile.
//!
//! A new profile implements [`Profile`], and [`crate::Curve`] for its figures.

use crate::own::OwnRamp;
use num_traits::Float;
use std::fmt::Debug;
use std::sync::Arc;

/// A float type that profiles can be computed in: f64 in the product, f32 where it is accurate
/// enough.
pub trait Real: Float + Debug + Send + Sync + 'static {
    /// The profile for readers that need f64.
    fn widened(profile: SharedProfile<Self>) -> SharedProfile;
}

/// Converts a constant of a formula to the nearest float.
pub(crate) fn real<F: Real>(value: f64) -> F {
    F::from(value).unwrap_or_else(F::nan)
}

/// Position and speed of one axis at each moment of one move.
///
/// Times are in seconds from the start of the move. Distances are in steps from the start position,
/// in the direction of travel. A time outside 0..=duration is clamped: the axis is at rest there.
pub trait Profile<F: Real>: Debug + Send + Sync {
    /// The name of the shape in the literature.
    fn shape(&self) -> &'static str;

    /// Duration of the move, seconds.
    fn duration(&self) -> F;

    /// Whole distance, steps, 0 or more.
    fn distance(&self) -> F;

    /// Distance travelled after `t` seconds, steps.
    fn position(&self, t: F) -> F;

    /// Speed at `t` seconds, steps/s, 0 or more. At the ends it is the speed just inside the move.
    fn speed(&self, t: F) -> F;

    /// Acceleration at `t` seconds, steps/s^2. At a breakpoint it is that of the piece that begins
    /// there.
    fn acceleration(&self, t: F) -> F;

    /// Jerk at `t` seconds, steps/s^3, inside a piece. The impulses of jerk at breakpoints are left
    /// out.
    fn jerk(&self, t: F) -> F;

    /// [`Self::speed`], [`Self::acceleration`] and [`Self::jerk`] at one time, in one call.
    fn rates(&self, t: F) -> Rates<F> {
        Rates { speed: self.speed(t), acceleration: self.acceleration(t), jerk: self.jerk(t) }
    }

    /// Time at which the axis passes position `x` (0..=distance, steps), seconds.
    ///
    /// The result is well conditioned near rest at both ends of the move.
    fn crossing(&self, x: F) -> F;

    /// The time at which the axis passes position `x`, seconds, and its speed and acceleration
    /// then: [`Self::crossing`], [`Self::speed`] and [`Self::acceleration`] in one call, which is
    /// all that a reader of every pulse needs.
    fn passing(&self, x: F) -> [F; 3] {
        let t = self.crossing(x);
        [t, self.speed(t), self.acceleration(t)]
    }

    /// The ramp up and the ramp down (as if it went up) of a whole move, if they are known by their
    /// shape; they begin and end where the move does.
    fn own_ramps(&self) -> Option<[OwnRamp; 2]> {
        None
    }

    /// Times inside the move at which the formula changes, seconds, ascending.
    fn breakpoints(&self) -> &[F];

    /// Mean speed between two times in seconds, steps/s, without taking the difference of two
    /// positions.
    ///
    /// The provided method applies the two-point Gauss rule from breakpoint to breakpoint. It is
    /// exact up to constant jerk. Its points lie inside the pieces, so that the rounding of a
    /// breakpoint has no effect.
    fn mean_speed(&self, from: F, to: F) -> F {
        let whole = to - from;
        if whole <= F::zero() {
            return self.speed(from);
        }
        let two = real::<F>(2.0);
        let gauss = |left: F, right: F| {
            let (middle, half) = (left + (right - left) / two, (right - left) / two);
            let offset = half / real::<F>(3.0).sqrt();
            (self.speed(middle - offset) + self.speed(middle + offset)) / two
        };
        let mut left = from;
        let mut sum = F::zero();
        for &right in self.breakpoints().iter().filter(|&&b| b > from && b < to) {
            sum = sum + gauss(left, right) * ((right - left) / whole);
            left = right;
        }
        if left == from {
            // A single piece is the whole, and its part is 1.
            return gauss(from, to);
        }
        sum = sum + gauss(left, to) * ((to - left) / whole);
        sum
    }
}

/// How fast an axis moves at one time, and how fast that changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rates<F> {
    /// Speed, steps/s.
    pub speed: F,
    /// Acceleration, steps/s^2.
    pub acceleration: F,
    /// Jerk, steps/s^3.
    pub jerk: F,
}

impl<F: Real> Rates<F> {
    /// Whether the speed is constant.
    pub fn are_level(&self) -> bool {
        self.acceleration.is_zero() && self.jerk.is_zero()
    }
}

/// A profile that several plans and waveforms share.
pub type SharedProfile<F = f64> = Arc<dyn Profile<F>>;

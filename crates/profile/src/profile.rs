//! What every profile answers.

use num_traits::Float;
use std::fmt::Debug;
use std::sync::Arc;

/// A float that profiles can be computed in: f64 in the product, f32 where less must do.
pub trait Real: Float + Debug + Send + Sync + 'static {}

impl<F: Float + Debug + Send + Sync + 'static> Real for F {}

/// The float nearest to a constant of a formula.
pub(crate) fn real<F: Real>(value: f64) -> F {
    F::from(value).unwrap_or_else(F::nan)
}

/// How far one axis has come, and how fast it is, at each moment of one move.
///
/// Times are seconds from the start of the move, distances steps from where it started, in the
/// direction of travel. Outside 0..=duration the axis stands: times are clamped.
pub trait Profile<F: Real>: Debug + Send + Sync {
    /// What the literature calls it.
    fn shape(&self) -> &'static str;

    /// Length, seconds.
    fn duration(&self) -> F;

    /// Whole distance, steps, 0 or more.
    fn distance(&self) -> F;

    /// Distance travelled after `t` seconds, steps.
    fn position(&self, t: F) -> F;

    /// Speed, steps/s, 0 or more; at the ends the speed just inside.
    fn speed(&self, t: F) -> F;

    /// Acceleration, steps/s^2; at a breakpoint that of the piece that begins there.
    fn acceleration(&self, t: F) -> F;

    /// Jerk inside a piece, steps/s^3; the impulses at breakpoints are left out.
    fn jerk(&self, t: F) -> F;

    /// Time at which position `x` (0..=distance, steps) is passed, seconds.
    ///
    /// Stable everywhere: near rest at the end as near rest at the start.
    fn crossing(&self, x: F) -> F;

    /// Times inside the move at which one formula gives way to another, ascending, seconds.
    fn breakpoints(&self) -> &[F];

    /// Mean speed between two times, steps/s, without taking the difference of two positions.
    ///
    /// Provided by Gauss' rule of two points from breakpoint to breakpoint: exact up to constant jerk, and
    /// its points lie inside the pieces, so that a rounded breakpoint costs nothing.
    fn mean_speed(&self, from: F, to: F) -> F {
        let whole = to - from;
        if whole <= F::zero() {
            return self.speed(from);
        }
        let two = real::<F>(2.0);
        let inner = self.breakpoints().iter().copied().filter(|&b| b > from && b < to);
        let mut left = from;
        let mut sum = F::zero();
        for right in inner.chain(std::iter::once(to)) {
            let (middle, half) = (left + (right - left) / two, (right - left) / two);
            let offset = half / real::<F>(3.0).sqrt();
            let mean = (self.speed(middle - offset) + self.speed(middle + offset)) / two;
            sum = sum + mean * ((right - left) / whole);
            left = right;
        }
        sum
    }
}

/// A profile that plans and waveforms share.
pub type SharedProfile<F = f64> = Arc<dyn Profile<F>>;

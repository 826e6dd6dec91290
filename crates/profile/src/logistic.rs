//! The logistic S-curve: w(t) = w / (1 + e^(k (T_i - t))), with k = 4 a / w.
//!
//! The source is M. Sorn (2019), Eqs. 1 to 5. docs/profiles.md lists its errors, which are
//! corrected here.
//!
//! The golden numbers in `tests/golden/` fix the formulas; only their numerical form may change.

use crate::alone;
use crate::bad_ramp::{BadRamp, in_range, positive, wide};
use crate::curve::Curve;
use crate::numeric::{ln_exp_m1, softplus};
use crate::own::{OwnRamp, Shape};
use crate::profile::{Profile, Real, real};
use crate::ramped::RampedMove;
use crate::refusal::{LimitRefusal, Limits};
use crate::timed;

/// The fraction of the asymptote that is missing at the end of a ramp, and present at its start:
/// the source ends its ramp at 99.5 %.
pub const SHORTFALL: f64 = 1.0 / 200.0;

/// One acceleration ramp along a logistic curve. The curve is cut off on both sides, because it
/// never reaches rest or its asymptote.
///
/// The ramp starts with a jump to w / (1 + e^(k T_i)) and ends at (1 - shortfall) w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogisticRamp<F> {
    asymptote: F,
    steepness: F,
    centre: F,
    /// Speed at the start as a fraction of the asymptote: 1 / (1 + A), with A = e^(k T_i).
    start: F,
    /// ln(1 + A), which is finite even where A overflows.
    ln_start: F,
    end: F,
    duration: F,
    distance: F,
}

impl<F: Real> LogisticRamp<F> {
    /// The ramp of the source, with its parameters.
    ///
    /// - `asymptote`: w, steps/s.
    /// - `acceleration`: a, the peak acceleration, steps/s^2.
    /// - `centre`: T_i, the time at which half the asymptote and the peak acceleration are reached,
    ///   seconds.
    /// - `shortfall`: the fraction of w that is missing at the end of the ramp, over 0 and under 1
    ///   (usually [`SHORTFALL`]).
    ///
    /// # Errors
    /// A [`BadRamp`] if a parameter is out of its range, or if the centre is so early that the ramp
    /// would end before it starts.
    pub fn new(asymptote: F, acceleration: F, centre: F, shortfall: F) -> Result<Self, BadRamp> {
        let asymptote = positive("the top speed", asymptote)?;
        let acceleration = positive("the acceleration", acceleration)?;
        let centre = in_range("the centre", centre, "finite", centre.is_finite())?;
        let inside = shortfall > F::zero() && shortfall < F::one();
        let shortfall =
            in_range("the shortfall at the end", shortfall, "over 0 and under 1", inside)?;
        let steepness = real::<F>(4.0) * acceleration / asymptote;
        let ramp = Self::cut(asymptote, steepness, softplus(steepness * centre), shortfall);
        let rest = tail(shortfall) / steepness;
        let duration = centre + rest;
        if duration > F::zero() {
            Ok(Self { centre, duration, ..ramp })
        } else {
            Err(BadRamp::NoRampTime { centre: wide(centre), least: wide(-rest) })
        }
    }

    /// The symmetric ramp, which starts as far from rest as it ends from the asymptote: T_i =
    /// ln(199) / k.
    ///
    /// # Errors
    /// A [`BadRamp`] if a parameter is out of its range.
    pub fn symmetric(asymptote: F, acceleration: F) -> Result<Self, BadRamp> {
        let steepness = real::<F>(4.0) * positive("the acceleration", acceleration)? / asymptote;
        Self::new(asymptote, acceleration, tail(real::<F>(SHORTFALL)) / steepness, real(SHORTFALL))
    }

    /// Builds a ramp from `ln_start` = ln(1 + A).
    fn cut(asymptote: F, steepness: F, ln_start: F, shortfall: F) -> Self {
        let start = (-ln_start).exp();
        let centre = ln_exp_m1(ln_start) / steepness;
        let duration = centre + tail(shortfall) / steepness;
        // The distance is s(T) = (w / k) ln((1 - start) / shortfall).
        let distance = asymptote / steepness * ((-start).ln_1p() - shortfall.ln());
        let end = asymptote * (F::one() - shortfall);
        Self { asymptote, steepness, centre, start, ln_start, end, duration, distance }
    }

    /// The steepest ramp within `limits` that ends at `top` steps/s. If the limits have a start
    /// speed, the jump at the start does not exceed it.
    fn within(limits: &Limits<F>, top: F) -> Self {
        let shortfall = real::<F>(SHORTFALL);
        let asymptote = top / (F::one() - shortfall);
        if asymptote <= F::zero() {
            let (zero, one) = (F::zero(), F::one());
            return Self { duration: zero, distance: zero, ..Self::cut(zero, one, one, shortfall) };
        }
        Self::between(asymptote, steepest(limits, asymptote), start_fraction(limits, asymptote))
    }

    /// A ramp from the fraction `start` of the asymptote to [`SHORTFALL`] below it.
    pub(crate) fn between(asymptote: F, steepness: F, start: F) -> Self {
        Self::cut(asymptote, steepness, -start.ln(), real(SHORTFALL))
    }

    /// The ramp that starts at e^(-ln_start) of its asymptote, ends [`SHORTFALL`] below it, and
    /// travels `distance` steps in `duration` seconds.
    pub(crate) fn shaped(ln_start: F, duration: F, distance: F) -> Self {
        let one = F::one();
        let unit = Self::cut(one, one, ln_start, real(SHORTFALL));
        let steepness = unit.duration / duration;
        let asymptote = distance * steepness / unit.distance;
        Self::cut(asymptote, steepness, ln_start, real(SHORTFALL))
    }

    /// The asymptote w, which is approached but never reached, steps/s.
    pub fn asymptote(&self) -> F {
        self.asymptote
    }

    /// The steepness k = 4 a / w, 1/s.
    pub fn steepness(&self) -> F {
        self.steepness
    }

    /// The centre T_i, at which half the asymptote is passed, seconds.
    pub fn centre(&self) -> F {
        self.centre
    }

    /// Speed at `t` as a fraction of the asymptote, in 0..1.
    fn fraction(&self, t: F) -> F {
        (F::one() + (self.steepness * (self.centre - self.clamped(t))).exp()).recip()
    }

    fn clamped(&self, t: F) -> F {
        t.max(F::zero()).min(self.duration)
    }

    /// The fractions of the asymptote at the start and at the end.
    fn reach(&self) -> (F, F) {
        (self.start, self.end / self.asymptote)
    }
}

/// The maximum of |d^2 f/dz^2| for f = 1 / (1 + e^-z). It is 1 / (6 sqrt 3), where f is (1 -+
/// 1/sqrt 3) / 2.
const PEAK_JERK: f64 = 0.096_225_044_864_937_63;

/// The greatest steepness k within the acceleration and jerk limits, 1/s.
pub(crate) fn steepest<F: Real>(limits: &Limits<F>, asymptote: F) -> F {
    let by_acceleration = real::<F>(4.0) * limits.acceleration / asymptote;
    let by_jerk = (limits.jerk / (asymptote * real(PEAK_JERK))).sqrt();
    by_acceleration.min(by_jerk)
}

/// The jump at the start as a fraction of the asymptote: as much as is missing at the end, or the
/// start speed if one is given and smaller.
pub(crate) fn start_fraction<F: Real>(limits: &Limits<F>, asymptote: F) -> F {
    let (jump, shortfall) = (limits.start_speed / asymptote, real(SHORTFALL));
    if jump > F::zero() { jump.min(shortfall) } else { shortfall }
}

/// k times the time from the centre to the point at which `shortfall` of the asymptote is missing.
fn tail<F: Real>(shortfall: F) -> F {
    (-shortfall).ln_1p() - shortfall.ln()
}

/// The derivative df/dz = f (1 - f).
fn slope<F: Real>(f: F) -> F {
    f * (F::one() - f)
}

/// The second derivative d^2 f/dz^2 = f (1 - f) (1 - 2 f).
fn bend<F: Real>(f: F) -> F {
    slope(f) * (F::one() - f - f)
}

/// ln(1 + f (e^y - 1)), for a given ln f: the distance, in units of w/k, that is travelled in the
/// time y/k from the speed f w. The result is correct even where f or e^y do not fit into a float.
fn gain<F: Real>(ln_f: F, y: F) -> F {
    let f = ln_f.exp();
    let grown = f * y.exp_m1();
    if f.is_normal() && grown.is_finite() { grown.ln_1p() } else { softplus(ln_f + ln_exp_m1(y)) }
}

impl<F: Real> Profile<F> for LogisticRamp<F> {
    fn shape(&self) -> &'static str {
        "logistic"
    }

    fn duration(&self) -> F {
        self.duration
    }

    fn distance(&self) -> F {
        self.distance
    }

    fn position(&self, t: F) -> F {
        let y = self.steepness * self.clamped(t);
        let grown = gain(-self.ln_start, y);
        (self.asymptote / self.steepness * grown).min(self.distance)
    }

    fn speed(&self, t: F) -> F {
        (self.asymptote * self.fraction(t)).min(self.end)
    }

    fn acceleration(&self, t: F) -> F {
        self.steepness * self.asymptote * slope(self.fraction(t))
    }

    fn jerk(&self, t: F) -> F {
        self.steepness * self.steepness * self.asymptote * bend(self.fraction(t))
    }

    /// The time is t = ln(1 + (A + 1) (e^(k x / w) - 1)) / k.
    fn crossing(&self, x: F) -> F {
        if x <= F::zero() {
            return F::zero();
        } else if x >= self.distance {
            return self.duration;
        }
        let y = self.steepness * x / self.asymptote;
        let grown = self.ln_start.exp() * y.exp_m1();
        let t =
            if grown.is_finite() { grown.ln_1p() } else { softplus(self.ln_start + ln_exp_m1(y)) };
        (t / self.steepness).min(self.duration)
    }

    fn breakpoints(&self) -> &[F] {
        &[]
    }

    fn mean_speed(&self, from: F, to: F) -> F {
        let y = self.steepness * (to - from);
        let at_start = from <= F::zero();
        let ln_from = if at_start {
            -self.ln_start
        } else {
            -softplus(self.steepness * (self.centre - from))
        };
        if y > F::zero() { self.asymptote * (gain(ln_from, y) / y) } else { self.speed(from) }
    }
}

impl<F: Real> Curve<F> for LogisticRamp<F> {
    /// Of the ramps that end [`SHORTFALL`] below their asymptote.
    fn own_ramp(&self) -> Option<OwnRamp> {
        let usual = self.end == self.asymptote * (F::one() - real::<F>(SHORTFALL));
        let shape = Shape::Logistic { start: self.ln_start.to_f64()?.to_bits() };
        OwnRamp::of(shape, self.duration, self.distance).filter(|_| usual)
    }

    fn top_speed(&self) -> F {
        self.end
    }

    fn peak_acceleration(&self) -> F {
        if self.duration.is_zero() {
            return F::zero();
        }
        let (start, end) = self.reach();
        let middle = real::<F>(0.5).max(start).min(end);
        self.steepness * self.asymptote * slope(middle)
    }

    fn peak_jerk(&self) -> F {
        if self.duration.is_zero() {
            return F::zero();
        }
        let (start, end) = self.reach();
        let inside = real::<F>(3.0_f64.sqrt().recip());
        let early = (F::one() - inside) / real(2.0);
        let bends = [early, F::one() - early].map(|f| bend(f.max(start).min(end)).abs());
        self.steepness * self.steepness * self.asymptote * bends[0].max(bends[1])
    }

    fn acceleration_jump(&self) -> F {
        if self.duration.is_zero() {
            return F::zero();
        }
        let (start, end) = self.reach();
        self.steepness * self.asymptote * slope(start).max(slope(end))
    }
}

/// The logistic move of `distance` steps (over 0) in `time` seconds.
///
/// The move rises along the curve to 99.5 % of its asymptote, cruises at that speed and falls along
/// the mirrored curve. The speed jump at both ends is 0.5 % of the asymptote, or the start speed if
/// that is smaller. A logistic curve is never at rest; a start speed of 0 therefore does not limit
/// the jump, which is 0.5 % then too. [`Curve::figures`] gives its value.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that fails and the least time.
pub fn logistic<F: Real>(
    distance: F,
    time: F,
    limits: &Limits<F>,
) -> Result<RampedMove<F, LogisticRamp<F>>, LimitRefusal> {
    let fastest = timed::fastest(distance, limits, &ramps, F::nan());
    timed::in_time(distance, time, limits, &ramps, &fastest, F::nan())
}

/// Least time of [`logistic`], seconds.
pub fn logistic_least_time<F: Real>(distance: F, limits: &Limits<F>) -> F {
    timed::fastest(distance, limits, &ramps, F::nan()).time
}

/// The two ramps of [`logistic`].
pub(crate) fn ramps<F: Real>(limits: &Limits<F>, top: F) -> (LogisticRamp<F>, LogisticRamp<F>) {
    let ramp = LogisticRamp::within(limits, top);
    (ramp, ramp)
}

/// The logistic ramp with the asymptote `top`. As in its source, it ends at 99.5 % of the
/// asymptote.
///
/// It starts at 0.5 %, or at the start speed if that is over 0 and smaller.
///
/// # Errors
/// A [`LimitRefusal`] names the limit that `time` breaks and the least time.
pub fn logistic_ramp<F: Real>(
    top: F,
    time: Option<F>,
    limits: &Limits<F>,
) -> Result<LogisticRamp<F>, LimitRefusal> {
    let start = start_fraction(limits, top);
    let ramp = |steepness| LogisticRamp::between(top, steepness, start);
    // With a steepness of 1/s, the duration of the ramp is the product k T.
    let lasting = |time| ramp(ramp(F::one()).duration() / time);
    alone::in_time(time, limits, |limits| ramp(steepest(limits, top)), lasting)
}

/// [`logistic_ramp`] with the start of its source: the ramp starts T_i seconds before it has half
/// its speed.
///
/// # Errors
/// A [`BadRamp`] if the centre is so early that the ramp would end before it starts.
pub fn logistic_ramp_about<F: Real>(
    top: F,
    centre: F,
    limits: &Limits<F>,
) -> Result<LogisticRamp<F>, BadRamp> {
    let acceleration = steepest(limits, top) * (top / real(4.0));
    LogisticRamp::new(top, acceleration, centre, real(SHORTFALL))
}

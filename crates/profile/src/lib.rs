//! Float reference profiles of the literature.
//!
//! A [`Profile`] gives the distance that one axis has travelled in one move as a function of time,
//! from rest or from a start speed. Distances are in steps and never negative; the direction of
//! travel is kept by the caller. All code is generic over [`Real`] floats and knows nothing of the
//! planner's integers. A [`Timeline`] puts the profiles of one axis in sequence and gives the time
//! at which each pulse is due.
//!
//! The modules are private. The public items are listed below; docs/profiles.md gives the formulas
//! and their sources.

mod alone;
mod bad_ramp;
mod constant;
mod curve;
mod growing;
pub mod kinds;
mod line;
mod logistic;
mod numeric;
mod own;
mod profile;
mod ramp;
mod ramped;
mod ranade;
pub mod reference;
mod refusal;
mod scurve;
mod scurve_moves;
mod shaped;
mod sine;
mod solve;
mod timed;
mod timeline;
mod trapezoid;
mod widened;

pub use bad_ramp::BadRamp;
pub use constant::Constant;
pub use curve::{Curve, CurveFigures};
pub use growing::{ListEnd, Reader, Source};
pub use line::Course;
pub use logistic::{LogisticRamp, SHORTFALL};
pub use own::{OwnRamp, Shape};
pub use profile::{Profile, Rates, Real, SharedProfile};
pub use ramp::Ramp;
pub use ramped::RampedMove;
pub use refusal::{Limit, LimitRefusal, Limits};
pub use scurve::ScurveRamp;
pub use sine::SineRamp;
pub use timeline::{Crossing, Leg, Timeline, Travel, Walk};

/// Functions that return the profile for a distance, a time and limits, or a refusal, and functions
/// that return the least time. The functions whose names end in `_ramp` return a single ramp up to
/// a given top speed.
pub mod rule {
    pub use crate::alone::{ranade_ramp, scurve_ramp, trapezoid_ramp};
    pub use crate::constant::{constant, constant_least_time};
    pub use crate::logistic::{logistic, logistic_least_time, logistic_ramp, logistic_ramp_about};
    pub use crate::ranade::{ranade, ranade_least_time};
    pub use crate::scurve_moves::{scurve, scurve_least_time, scurve_to, scurve_to_least_time};
    pub use crate::sine::{sine, sine_least_time, sine_ramp};
    pub use crate::trapezoid::{trapezoid, trapezoid_least_time};
}

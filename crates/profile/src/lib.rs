//! Float reference profiles of the literature.
//!
//! A [`Profile`] is a distance travelled from rest or from a start speed, as a function of time, for one
//! axis and one move. Distances are in steps and never negative: which way an axis goes is kept outside.
//! All is generic over [`Real`] floats; nothing here knows of ticks' integers. [`Timeline`] strings the
//! profiles of one axis together and says when each pulse is due.

mod alone;
mod bad_ramp;
mod constant;
mod curve;
mod line;
mod logistic;
mod numeric;
mod profile;
mod ramp;
mod ramped;
mod ranade;
pub mod reference;
mod refusal;
mod scurve;
mod sine;
mod solve;
mod timed;
mod timeline;
mod trapezoid;
mod widened;

pub use bad_ramp::BadRamp;
pub use constant::Constant;
pub use curve::{Curve, Figures};
pub use line::Line;
pub use logistic::{LogisticRamp, SHORTFALL};
pub use profile::{Profile, Real, SharedProfile};
pub use ramp::Ramp;
pub use ramped::RampedMove;
pub use refusal::{Limit, Limits, Refusal};
pub use scurve::ScurveRamp;
pub use sine::SineRamp;
pub use timeline::{Crossing, Leg, Timeline};
pub use widened::Widened;

/// From distance, time and limits to a profile, or to a refusal; and the least time for each. For a ramp by
/// itself, from its top speed.
pub mod rule {
    pub use crate::alone::{logistic_ramp, logistic_ramp_about, ranade_ramp, scurve_ramp, sine_ramp, trapezoid_ramp};
    pub use crate::constant::{constant, constant_least_time};
    pub use crate::logistic::{logistic, logistic_least_time};
    pub use crate::ranade::{ranade, ranade_curve, ranade_least_time};
    pub use crate::scurve::{scurve, scurve_least_time, scurve_to, scurve_to_least_time};
    pub use crate::sine::{sine, sine_least_time};
    pub use crate::trapezoid::{trapezoid, trapezoid_least_time};
}

//! Float reference profiles of the literature.
//!
//! A [`Profile`] is a distance travelled from rest or from a start speed, as a function of time, for one
//! axis and one move. Distances are in steps and never negative: which way an axis goes is kept outside.
//! All is generic over [`Real`] floats; nothing here knows of ticks' integers. [`Timeline`] strings the
//! profiles of one axis together and says when each pulse is due.

mod constant;
mod profile;
mod ramp;
mod ranade;
mod refusal;
mod timeline;
mod trapezoid;
mod widened;

pub use constant::Constant;
pub use profile::{Profile, Real, SharedProfile};
pub use ramp::Ramp;
pub use refusal::{Limit, Limits, Refusal};
pub use timeline::{Crossing, Leg, Timeline};
pub use widened::Widened;

/// From distance, time and limits to a profile, or to a refusal; and the least time for each.
pub mod rule {
    pub use crate::constant::{constant, constant_least_time};
    pub use crate::ranade::{ranade, ranade_least_time};
    pub use crate::trapezoid::{trapezoid, trapezoid_least_time};
}

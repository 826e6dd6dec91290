//! The kinds of profiles by name. The names are those of move files and of the command line.
//!
//! A new kind is added here, at the end, in the crate `profile` (its curve, `kinds.rs`, `lib.rs`),
//! and on the page docs/profiles.md.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use strum::{Display, EnumString, IntoStaticStr, VariantArray};

/// A profile of the literature: how the speed of a move changes over time.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    Display,
    EnumString,
    IntoStaticStr,
    VariantArray,
    JsonSchema,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum ProfileKind {
    /// Ranade (2009): a triangle if possible, otherwise a trapezoid at the speed limit.
    Ranade,
    /// Constant acceleration, from rest to rest at the acceleration limit.
    Trapezoid,
    /// Seven segments within limits of speed, acceleration and jerk.
    Scurve,
    /// Along a logistic curve (M. Sorn, 2019), with small accelerations at both ends; never quite
    /// at rest.
    Logistic,
    /// Acceleration proportional to 1 - cos, so that the jerk is continuous too.
    Sine,
    /// One constant speed, at most the start speed.
    Constant,
}

impl ProfileKind {
    /// Every kind.
    pub const ALL: &'static [Self] = Self::VARIANTS;

    /// The name of the kind in files and on the command line.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Whether cubic segments can only approximate this profile. They follow the other profiles
    /// exactly.
    pub const fn is_fitted(self) -> bool {
        matches!(self, Self::Logistic | Self::Sine)
    }
}

//! The kinds of profiles by name.
//!
//! The names are those of files and of the command line.

use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::str::FromStr;

/// A profile of the literature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Constant acceleration from rest.
    Trapezoid,
    /// Constant acceleration from the start speed, by Ranade's rule.
    Ranade,
    /// Seven segments with limits on acceleration and jerk.
    Scurve,
    /// An acceleration that follows 1 - cos over time.
    Sine,
    /// The logistic S-curve of M. Sorn (2019).
    Logistic,
    /// Constant speed from start to end.
    Constant,
}

impl Kind {
    /// All kinds, in the order in which they are listed.
    pub const ALL: [Self; 6] =
        [Self::Trapezoid, Self::Ranade, Self::Scurve, Self::Sine, Self::Logistic, Self::Constant];

    /// The name of the kind in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Trapezoid => "trapezoid",
            Self::Ranade => "ranade",
            Self::Scurve => "scurve",
            Self::Sine => "sine",
            Self::Logistic => "logistic",
            Self::Constant => "constant",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Kind {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|kind| kind.name() == name);
        found.ok_or_else(|| format!("{name:?} is no profile: {}", Self::ALL.map(Self::name).join(", ")))
    }
}

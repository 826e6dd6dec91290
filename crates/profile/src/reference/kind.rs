//! The profiles by name.

use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::str::FromStr;

/// A profile of the literature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// One acceleration, from rest.
    Trapezoid,
    /// One acceleration, from the start speed: Ranade's rule.
    Ranade,
    /// Seven segments: limits on acceleration and jerk.
    Scurve,
    /// Acceleration as 1 - cos.
    Sine,
    /// The logistic S-curve of Sorn.
    Logistic,
    /// One speed from end to end.
    Constant,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Trapezoid, Self::Ranade, Self::Scurve, Self::Sine, Self::Logistic, Self::Constant];

    /// Its name in files and on the command line.
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

//! The overrides of a user, in percent.

use std::fmt;

/// How much of what the program says: 100 each is what it says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OverrideSetting {
    /// Of the feed, 10 to 200 %.
    pub feed: u8,
    /// Of the speed of rapid moves, 10 to 100 %.
    pub rapid: u8,
    /// Of the speed of the spindle, 10 to 200 %.
    pub spindle: u8,
}

impl OverrideSetting {
    /// What the program says.
    pub const NONE: Self = Self { feed: 100, rapid: 100, spindle: 100 };

    /// The factors for the motion.
    pub(crate) fn motion(self) -> carrystep_job::Overrides {
        let [feed, rapid] = [self.feed, self.rapid].map(|percent| f64::from(percent) / 100.0);
        carrystep_job::Overrides { feed, rapid }
    }
}

impl Default for OverrideSetting {
    fn default() -> Self {
        Self::NONE
    }
}

impl fmt::Display for OverrideSetting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { feed, rapid, spindle } = self;
        write!(f, "feed {feed} %, rapid {rapid} %, spindle {spindle} %")
    }
}

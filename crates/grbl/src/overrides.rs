//! The overrides of feed, rapid moves and spindle, in percent.

/// What an override character changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OverrideStep {
    /// The feed is as programmed.
    FeedReset,
    /// The feed changes by so many percent of the programmed one.
    Feed(i8),
    /// Rapid moves have their full speed.
    RapidFull,
    /// Half of it.
    RapidHalf,
    /// A quarter of it.
    RapidQuarter,
    /// The spindle turns as programmed.
    SpindleReset,
    /// Its speed changes by so many percent of the programmed one.
    Spindle(i8),
}

/// Overrides, percent of what the program says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Overrides {
    /// Of the feed, 10 to 200.
    pub feed: u8,
    /// Of rapid moves: 100, 50 or 25.
    pub rapid: u8,
    /// Of the spindle, 10 to 200.
    pub spindle: u8,
}

impl Overrides {
    /// What the program says.
    pub const NONE: Self = Self { feed: 100, rapid: 100, spindle: 100 };

    /// The overrides behind this step. They stay within their ranges.
    #[must_use]
    pub fn after(self, step: OverrideStep) -> Self {
        let by = |percent: u8, step: i8| percent.saturating_add_signed(step).clamp(10, 200);
        match step {
            OverrideStep::FeedReset => Self { feed: 100, ..self },
            OverrideStep::Feed(step) => Self { feed: by(self.feed, step), ..self },
            OverrideStep::RapidFull => Self { rapid: 100, ..self },
            OverrideStep::RapidHalf => Self { rapid: 50, ..self },
            OverrideStep::RapidQuarter => Self { rapid: 25, ..self },
            OverrideStep::SpindleReset => Self { spindle: 100, ..self },
            OverrideStep::Spindle(step) => Self { spindle: by(self.spindle, step), ..self },
        }
    }
}

impl Default for Overrides {
    fn default() -> Self {
        Self::NONE
    }
}

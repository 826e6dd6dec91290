//! How much of a planned motion is left, from how long a board has been seen to move.
//!
//! ```text
//! board   rest | moves        | rest    | moves          | rest
//! see            :  :  :  :  :  :         :  :  :  :  :  :
//! moved          0  1  2  3  4  5         5  6  7  8  9 10       rests do not count
//! left          10  9  8  7  6  5         5  4  3  2  1  0
//! ```

use crate::OverrideSetting;
use std::time::Duration;

/// Motion after which the rate of before says how fast the rest goes, s.
const SETTLED: f64 = 5.0;

/// The least rate with which the time that is left is computed.
const LEAST_RATE: f64 = 0.05;

/// How fast the motion goes along its plan.
#[derive(Debug, Clone, Copy)]
pub struct MotionPace {
    /// The overrides.
    pub overrides: OverrideSetting,
    /// Planned seconds that pass in a second.
    pub rate: f64,
    /// By how much holds have made the motion longer since it was planned, s.
    pub added: f64,
}

/// Planned motion of which a part is over. Times are those of any clock that runs as fast as the
/// board's.
#[derive(Debug, Clone)]
pub struct TimeLeft {
    planned: Duration,
    /// What holds have added to it, s.
    added: f64,
    moved: Duration,
    /// What was over when the rest was planned.
    before: Duration,
    /// When the motion of the present stretch was last looked at.
    seen: Option<Duration>,
    /// The overrides of late, and the planned seconds and seconds since they are in force.
    pace: (OverrideSetting, f64, f64),
    /// Planned seconds that pass in a second.
    rate: f64,
}

impl TimeLeft {
    /// A motion that was planned to last this long, s, and that has not begun.
    pub fn new(seconds: f64) -> Self {
        Self {
            planned: duration(seconds),
            added: 0.0,
            moved: Duration::ZERO,
            before: Duration::ZERO,
            seen: None,
            pace: (OverrideSetting::NONE, 0.0, 0.0),
            rate: 1.0,
        }
    }

    /// Notes that the board moves or rests at this time, and at which pace. Returns false if the
    /// motion of the present stretch has not begun.
    pub fn see(&mut self, now: Duration, moves: bool, pace: MotionPace) -> bool {
        let MotionPace { overrides, rate, added } = pace;
        self.added = added;
        if !moves && self.seen.is_none() {
            return false;
        }
        let since = now.saturating_sub(self.seen.replace(now).unwrap_or(now));
        let planned = since.mul_f64(rate.clamp(0.0, 10.0));
        self.moved = self.moved.saturating_add(planned).min(self.planned());
        if self.pace.0 != overrides {
            self.pace = (overrides, 0.0, 0.0);
        }
        self.pace.1 += planned.as_secs_f64();
        self.pace.2 += since.as_secs_f64();
        self.rate = rate;
        true
    }

    /// The board rests: its time stands still until it moves again. `gone` is the motion since it
    /// was planned, s, if that is known: the host has seen its beginning and its end a little late.
    pub fn rests(&mut self, gone: Option<f64>) {
        self.seen = None;
        if let Some(gone) = gone {
            self.moved = self.before.saturating_add(duration(gone)).min(self.planned());
        }
    }

    /// From now on, the motion that is left lasts this long, s.
    pub fn plans(&mut self, seconds: f64) {
        self.planned = self.moved.saturating_add(duration(seconds));
        (self.added, self.before) = (0.0, self.moved);
    }

    /// The time of all motion.
    pub fn planned(&self) -> Duration {
        duration(self.planned.as_secs_f64() + self.added)
    }

    /// Planned motion that is over.
    pub const fn moved(&self) -> Duration {
        self.moved
    }

    /// The time that the rest takes. With overrides it goes as since they are in force, once this
    /// has been seen for a while, and before that as now.
    pub fn left(&self) -> Duration {
        let rate = match self.pace {
            (OverrideSetting::NONE, ..) => 1.0,
            (_, planned, real) if real > SETTLED && planned > 0.0 => planned / real,
            _ => self.rate.max(LEAST_RATE),
        };
        duration(self.planned().saturating_sub(self.moved).as_secs_f64() / rate)
    }
}

fn duration(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)
}

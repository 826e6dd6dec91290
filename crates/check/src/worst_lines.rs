//! Keeps, of all lines that an axis has travelled, those that may be the worst, however many there
//! are.
//!
//! A line is judged at the end, when it is known by how much edges may be late: by its deviation d
//! minus the distance v t that the axis travels in the time t. Over t, each line is a straight line
//! d - v t, and only those that form the upper envelope of all can be the greatest at some t >= 0.
//!
//! ```text
//! d - v t  |\\
//!          | \ \      a great deviation at a high speed, and
//!          |  \  \_
//!          |   \_   \__      a small one at a low speed, are kept;
//!          |-____\___   \___
//!          |      \  ------- \____  a line below both is not
//!          +------------------------- t
//! ```

use crate::exact;
use serde::{Deserialize, Serialize};

/// The greatest deviation of an axis on one line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct OnLine {
    /// The deviation, steps.
    #[serde(with = "exact")]
    pub steps: f64,
    /// The greatest speed of the axis on the line, steps/s.
    #[serde(with = "exact")]
    pub speed: f64,
    /// Number of the pulse, on any axis, after which it occurred.
    pub pulse: u64,
}

/// The lines of one axis that may be the worst, by speed and by deviation from the least one up.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct WorstLines(Vec<OnLine>);

impl WorstLines {
    /// Adds the line that was travelled last.
    pub(crate) fn add(&mut self, line: OnLine) {
        let Self(kept) = self;
        // A later line replaces an equal one.
        kept.retain(|old| old.steps > line.steps || old.speed < line.speed);
        if kept.iter().any(|old| old.steps >= line.steps && old.speed <= line.speed) {
            return;
        }
        let place = kept.partition_point(|old| old.speed < line.speed);
        kept.insert(place, line);
        let hidden = |three: &[OnLine]| {
            let meets = |a: &OnLine, b: &OnLine| (b.steps - a.steps) / (b.speed - a.speed);
            meets(&three[0], &three[1]) < meets(&three[1], &three[2])
        };
        while let Some(before) = kept.windows(3).position(hidden) {
            kept.remove(before + 1);
        }
    }

    /// The lines that may be the worst.
    pub(crate) fn iter(&self) -> impl Iterator<Item = OnLine> {
        self.0.iter().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn worst(lines: impl Iterator<Item = OnLine>, t: f64) -> Option<f64> {
        lines.map(|line| line.steps - (0.5 + line.speed * t)).max_by(f64::total_cmp)
    }

    proptest! {
        #[test]
        fn the_worst_line_is_kept_for_every_time(
            lines in prop::collection::vec((0..40_u32, 0..40_u32), 0..60),
            times in prop::collection::vec(0.0..8.0_f64, 20),
        ) {
            let lines = lines.into_iter().zip(1..).map(|((steps, speed), pulse)| OnLine {
                steps: f64::from(steps) / 8.0,
                speed: f64::from(speed),
                pulse,
            });
            let mut kept = WorstLines::default();
            lines.clone().for_each(|line| kept.add(line));
            for t in times {
                let (all, found) = (worst(lines.clone(), t), worst(kept.iter(), t));
                prop_assert!(all == found, "{all:?} {found:?}");
            }
        }
    }

    #[test]
    fn equal_lines_take_the_place_of_one() {
        let mut kept = WorstLines::default();
        for pulse in 0..1000 {
            kept.add(OnLine { steps: 0.25, speed: 10.0, pulse });
        }
        let all: Vec<OnLine> = kept.iter().collect();
        assert_eq!(all, [OnLine { steps: 0.25, speed: 10.0, pulse: 999 }]);
    }
}

//! How many adders an engine has, and how its axes share them.
//!
//! ```text
//! adders = 1   adder 0     | 0 | 1 | 2 | 3 | 4 | 5 |       time slots of six axes
//! adders = 2   adder 0     | 0 | 2 | 4 |                   axis i: time slot i / 2, adder i % 2
//!              adder 1     | 1 | 3 | 5 |
//! adders = 6   adder i     | i |                           all axes at once
//! ```

use super::{TIME_SLOT_CLOCKS, time_slots};
use crate::one_of;
use alloc::format;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;

/// The numbers of adders that an engine of so many axes can have: one, two if the axes are an even
/// number, and one for each axis.
pub fn adder_counts(axes: usize) -> impl Iterator<Item = usize> {
    (1..=axes).filter(move |&adders| {
        adders == 1 || adders == axes || (adders == 2 && axes.is_multiple_of(2))
    })
}

/// A number of adders for a number of axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Adders {
    /// Number of adders.
    pub adders: usize,
    /// Number of axes.
    pub axes: usize,
}

impl Adders {
    /// The number of axes in words.
    pub(super) fn axes_said(&self) -> String {
        if self.axes == 1 { "1 axis".into() } else { format!("{} axes", self.axes) }
    }

    /// The numbers of adders that there are, in words.
    pub(super) fn possible(&self) -> String {
        let counts: Vec<String> =
            adder_counts(self.axes).map(|adders| adders.to_string()).collect();
        one_of(&counts)
    }

    /// What the time slots need, up to the number of clocks.
    pub(super) fn need(&self) -> String {
        let Self { adders, axes } = *self;
        if adders <= 1 {
            return format!(
                "{axes} axes need {TIME_SLOT_CLOCKS} clocks each and two to close the tick"
            );
        }
        let slots = match time_slots(axes, adders) {
            1 => format!("a time slot of {TIME_SLOT_CLOCKS} clocks"),
            slots => format!("{slots} time slots of {TIME_SLOT_CLOCKS} clocks"),
        };
        format!("{axes} axes on {adders} adders need {slots} and three clocks to close the tick")
    }

    /// What else would make them fit.
    pub(super) const fn way_out(&self) -> &'static str {
        if self.adders > 1 && self.adders < self.axes { "more adders" } else { "fewer axes" }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_engine_has_one_two_or_as_many_adders_as_axes() {
        let counts = |axes| adder_counts(axes).collect::<Vec<_>>();
        assert_eq!(
            [1, 2, 3, 5, 6, 8].map(counts),
            [
                [1].to_vec(),
                [1, 2].to_vec(),
                [1, 3].to_vec(),
                [1, 5].to_vec(),
                [1, 2, 6].to_vec(),
                [1, 2, 8].to_vec(),
            ]
        );
        assert_eq!(Adders { adders: 4, axes: 6 }.possible(), "1, 2 or 6");
        assert_eq!(Adders { adders: 2, axes: 1 }.possible(), "1");
    }
}

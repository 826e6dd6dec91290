//! The rhythm of a job: the time between knots, and how many samples are averaged.
//!
//! The filter over m samples keeps the jerk J if m dt >= 2 A / J (`filter.rs`). A link carries at
//! most 250 segments a second for each axis, so dt is at least 4 ms. Of the two ways to fill the
//! time 2 A / J with knots, fewer longer ones or more shorter ones, the one is taken whose curve
//! moves less towards the acceleration.

use crate::limits::{Limit, SHORTEST};

/// Longest filter, knots: it bounds the work for a very low jerk limit. Knots then get longer.
const MOST_AVERAGED: f64 = 4096.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rhythm {
    /// Ticks from knot to knot.
    pub ticks: u32,
    /// The same in seconds.
    pub seconds: f64,
    /// Samples that are averaged.
    pub average: usize,
}

impl Rhythm {
    /// The rhythm for motors with these limits and a tick of so many seconds.
    pub fn new(limits: &[Limit], tick_seconds: f64) -> Self {
        let width = limits.iter().map(|l| 2.0 * l.acceleration / l.jerk).fold(0.0, f64::max);
        let whole = (width / SHORTEST * (1.0 - 1e-9)).max(0.0);
        let [fewer, more] = [whole.floor(), whole.ceil()].map(|n| n.clamp(1.0, MOST_AVERAGED));
        let choice = |average: f64| {
            let ticks = ((width / average).max(SHORTEST) / tick_seconds * (1.0 - 1e-12)).ceil();
            let ticks = ticks.clamp(1.0, f64::from(u32::MAX)) as u32;
            Self { ticks, seconds: f64::from(ticks) * tick_seconds, average: average as usize }
        };
        let [a, b] = [choice(fewer), choice(more)];
        if a.spread() <= b.spread() { a } else { b }
    }

    /// The second moment of what the emitted curve is a mean of, s^2: the samples' average and the
    /// spline. With an acceleration a, the curve is a/2 times this value off the smoothed one.
    pub fn spread(&self) -> f64 {
        let averaged = (self.average * self.average) as f64 - 1.0;
        self.seconds * self.seconds * (averaged / 12.0 + 1.0 / 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rhythm(acceleration: f64, jerk: f64) -> Rhythm {
        Rhythm::new(&[Limit { speed: 100.0, acceleration, jerk }], 1e-6)
    }

    #[test]
    fn without_a_jerk_limit_knots_are_four_ms_apart_and_two_samples_are_averaged() {
        let found = rhythm(1000.0, 1000.0 / 0.004);
        assert_eq!((found.ticks, found.average), (4000, 2));
    }

    #[test]
    fn filter_is_as_long_as_the_jerk_limit_needs() {
        for jerk in [1e3, 1e4, 5e4, 1e5, 2.1e5, 2.5e5, 4e5, 1e6, 1e9] {
            let found = rhythm(1000.0, jerk);
            let width = found.seconds * found.average as f64;
            assert!(width * jerk >= 2000.0 * (1.0 - 1e-6), "{jerk}: {found:?}");
            assert!(found.ticks >= 4000 && found.average >= 1, "{jerk}: {found:?}");
        }
    }
}

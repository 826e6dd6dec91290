//! The time law of a hold: how fast the motion goes along the planned one.
//!
//! ```text
//! rate   1 ____                         ____
//!              \                       /
//!               \                     /
//!        0       `-._______________.-'
//!              |   |               |   |
//!              0   T               0   T
//!              stop      rest      resumption
//! ```
//!
//! The rate is 1 - S(t/T) or S(t/T) with S(u) = 6 u^5 - 15 u^4 + 10 u^3, the quintic of Flash and
//! Hogan (1985, eq. 8), whose first and second derivatives are 0 at both ends. The planned time that
//! passes meanwhile is T/2.

/// Whether the motion comes to rest, or leaves it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    /// From the planned speed to rest.
    Stop,
    /// From rest to the planned speed.
    Resume,
}

/// The law of one transition.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Law {
    way: Way,
    ticks: f64,
}

impl Law {
    /// The greatest derivative of S: the rate changes at most so fast per length of the law.
    pub const STEEPEST: f64 = 1.875;

    /// A transition during which so many planned ticks pass, in twice as many ticks.
    pub fn over(way: Way, planned: u64) -> Self {
        Self { way, ticks: (2 * planned) as f64 }
    }

    /// Whether the transition ends at rest.
    pub fn rests(self) -> bool {
        self.way == Way::Stop
    }

    /// The planned time after `tick` ticks, in ticks.
    pub fn planned(self, tick: f64) -> f64 {
        let u = tick / self.ticks;
        let resumed = u.powi(4) * (u * u - 3.0 * u + 2.5);
        match self.way {
            Way::Stop => tick - self.ticks * resumed,
            Way::Resume => self.ticks * resumed,
        }
    }

    /// The rate after `tick` ticks: planned ticks per tick, from 0 to 1.
    pub fn rate(self, tick: f64) -> f64 {
        let u = tick / self.ticks;
        let resumed = u.powi(3) * (6.0 * u * u - 15.0 * u + 10.0);
        match self.way {
            Way::Stop => 1.0 - resumed,
            Way::Resume => resumed,
        }
    }

    /// The first tick at which at least `planned` ticks of the plan have passed.
    pub fn tick_of(self, planned: u64) -> u64 {
        let (mut low, mut high) = (0, self.ticks as u64);
        while low < high {
            let middle = low + (high - low) / 2;
            if self.planned(middle as f64) < planned as f64 {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        low
    }

    /// The whole length, ticks.
    pub fn ticks(self) -> u64 {
        self.ticks as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rate_is_the_derivative_of_the_planned_time() {
        for way in [Way::Stop, Way::Resume] {
            let law = Law::over(way, 5000);
            for tick in 1..10_000 {
                let tick = f64::from(tick);
                let slope = (law.planned(tick + 0.5) - law.planned(tick - 0.5)) / 1.0;
                assert!((slope - law.rate(tick)).abs() < 1e-6, "{way:?} {tick}");
            }
        }
    }

    #[test]
    fn half_of_the_time_is_planned_time() {
        for way in [Way::Stop, Way::Resume] {
            let law = Law::over(way, 5000);
            assert_eq!((law.ticks(), law.planned(0.0), law.planned(1e4)), (10_000, 0.0, 5000.0));
            let ends = [law.rate(0.0), law.rate(1e4)];
            assert_eq!(ends, if way == Way::Stop { [1.0, 0.0] } else { [0.0, 1.0] });
            let tick = law.tick_of(1234);
            assert!(law.planned(tick as f64) >= 1234.0 && law.planned(tick as f64 - 1.0) < 1234.0);
        }
    }
}

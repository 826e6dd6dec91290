//! The gateware's time as its host sees it: the count of ticks without its wraps, and the
//! difference between the gateware's clock and the host's.

/// Half of the range of the register TICKS.
const HALF: i64 = 1 << 31;

/// Uncertainty of a count that was read, in ticks: the tick that runs, and the one before it while
/// its words are being written.
const UNCERTAIN: f64 = 2.0;

/// Number of observations that are kept to compare later ones with.
const MARKS: usize = 16;

/// Extends TICKS, which wraps, to 64 bits.
///
/// A value that is seen belongs to a tick less than 2^31 ticks (1.2 hours at 2 us) from the latest
/// one seen before, so a host must see one at least that often. Values may be seen in any order: the
/// tick of a snapshot is read after later ticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TickCount {
    latest: Option<i64>,
}

impl TickCount {
    /// The number of the tick with this value of TICKS. The first value that is seen counts as
    /// itself. It counts from configuration if it is seen before the first wrap; otherwise only
    /// differences of these numbers have a meaning.
    pub fn see(&mut self, ticks: u32) -> i64 {
        let tick = match self.latest {
            None => i64::from(ticks),
            Some(latest) => {
                let ahead = i64::from(ticks.wrapping_sub(latest as u32));
                latest + if ahead < HALF { ahead } else { ahead - 2 * HALF }
            }
        };
        self.latest = self.latest.max(Some(tick));
        tick
    }
}

/// The difference between two clocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockDifference {
    /// By how much the gateware's clock is faster than the host's, in parts per million.
    pub ppm: f64,
    /// Greatest error of `ppm`.
    pub bound: f64,
}

/// An observation: the count was read between these two times of the host, in us.
#[derive(Debug, Clone, Copy)]
struct Mark {
    tick: i64,
    before: u64,
    after: u64,
}

impl Mark {
    const fn width(&self) -> u64 {
        self.after.saturating_sub(self.before)
    }
}

/// Compares the gateware's clock with the host's.
///
/// Each observation is an interval of the host's time in which a count of ticks was read. Of two
/// observations the ticks between them are known within 2 ticks on either side, and the host's time
/// between them within the lengths of both intervals. The true ratio of the clocks is therefore
/// within an interval of its own; the result is the intersection of these intervals, and its bound
/// is strict for clocks whose rates do not change. The bound falls with the time between the
/// observations: for exchanges of 1 ms, after ten minutes it is less than 4 ppm.
///
/// If the intersection is empty, a rate has changed, and the comparison continues from the last
/// observation.
#[derive(Debug, Clone, Copy, Default)]
pub struct ClockComparison {
    /// The first observation, and each later one whose interval was less than half of the one
    /// before it here: the shorter the intervals, the narrower the bound.
    marks: [Option<Mark>; MARKS],
    /// The least and the greatest possible ratio of the gateware's time to the host's.
    ratio: Option<(f64, f64)>,
}

impl ClockComparison {
    /// Adds an observation of a gateware with ticks of `tick_ns` ns: the tick with this number was
    /// read at a time of the host between `before` and `after`, in us.
    pub fn observe(&mut self, tick_ns: u32, tick: i64, before: u64, after: u64) {
        let mark = Mark { tick, before, after };
        let pairs = self.marks.iter().flatten().filter_map(|earlier| {
            let ns = |ticks: f64| ticks * f64::from(tick_ns);
            let ticks = tick.checked_sub(earlier.tick)? as f64;
            let longest = after.checked_sub(earlier.before)? as f64;
            let shortest = before.checked_sub(earlier.after).filter(|&us| us > 0)? as f64;
            let least = ns(ticks - UNCERTAIN) / (1000.0 * longest);
            Some((least, ns(ticks + UNCERTAIN) / (1000.0 * shortest)))
        });
        let both = |(a, b): (f64, f64), (c, d): (f64, f64)| (a.max(c), b.min(d));
        if let Some(newest) = pairs.reduce(both) {
            let ratio = self.ratio.map_or(newest, |known| both(known, newest));
            self.ratio = if ratio.0 <= ratio.1 { Some(ratio) } else { None };
            if self.ratio.is_none() {
                self.marks = [None; MARKS];
            }
        }
        let narrower = self.marks.iter().flatten().all(|kept| mark.width() < kept.width() / 2);
        if narrower && let Some(place) = self.marks.iter_mut().find(|place| place.is_none()) {
            *place = Some(mark);
        }
    }

    /// The difference between both clocks; `None` before two observations.
    pub fn difference(&self) -> Option<ClockDifference> {
        let (least, greatest) = self.ratio?;
        let ppm = |ratio: f64| (ratio - 1.0) * 1e6;
        let bound = (ppm(greatest) - ppm(least)) / 2.0;
        Some(ClockDifference { ppm: ppm(least) + bound, bound })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Values less than half a wrap from the latest one, forward or backward, over many wraps.
        #[test]
        fn ticks_are_counted_over_wraps(
            first in any::<u32>(),
            steps in prop::collection::vec((0..HALF, 0..HALF), 1..100),
        ) {
            let mut count = TickCount::default();
            prop_assert_eq!(count.see(first), i64::from(first));
            let mut latest = i64::from(first);
            for (forward, backward) in steps {
                latest += forward;
                prop_assert_eq!(count.see(latest as u32), latest);
                let older = latest - backward;
                prop_assert_eq!(count.see(older as u32), older);
            }
        }

        /// A clock that is off by some ppm, read in exchanges of any length at any of their
        /// instants: the true difference is within the bound.
        #[test]
        fn difference_is_within_its_bound(
            off in -500.0..500.0_f64,
            tick_ns in 500_u32..5000,
            reads in prop::collection::vec((1_u64..1_000_000, 1_u64..40_000, 0.0..1.0_f64), 2..60),
        ) {
            let mut clocks = ClockComparison::default();
            let mut count = TickCount::default();
            let mut now = 0_u64;
            for (pause, width, part) in reads {
                let before = now + pause;
                now = before + width;
                let read = before as f64 + part * width as f64;
                let ticks = read * 1000.0 * (1.0 + off * 1e-6) / f64::from(tick_ns);
                let tick = count.see(ticks as u64 as u32);
                clocks.observe(tick_ns, tick, before, now);
                if let Some(ClockDifference { ppm, bound }) = clocks.difference() {
                    prop_assert!((ppm - off).abs() <= bound + 1e-3, "{ppm} +- {bound}, is {off}");
                }
            }
            prop_assert!(clocks.difference().is_some());
        }
    }

    #[test]
    fn bound_falls_with_time() {
        let mut clocks = ClockComparison::default();
        assert_eq!(clocks.difference(), None);
        for second in 0..=600_u64 {
            clocks.observe(
                2000,
                second as i64 * 500_000,
                second * 1_000_000,
                second * 1_000_000 + 1000,
            );
        }
        let ClockDifference { ppm, bound } = clocks.difference().unwrap();
        assert!(ppm.abs() <= bound && bound < 4.0, "{ppm} +- {bound}");
    }

    #[test]
    fn change_of_rate_begins_a_new_comparison() {
        let mut clocks = ClockComparison::default();
        let mut tick = 0;
        for second in 0..100_u64 {
            tick += if second < 50 { 500_000 } else { 510_000 };
            clocks.observe(2000, tick, second * 1_000_000, second * 1_000_000 + 100);
        }
        let ClockDifference { ppm, bound } = clocks.difference().unwrap();
        assert!((ppm - 20_000.0).abs() <= bound && bound < 20.0, "{ppm} +- {bound}");
    }
}

//! Computes V of one axis' accumulator at any tick, exactly, from its segments.
//!
//! This repeats the arithmetic of the gateware in closed form; both may change only together.

use carrystep_core::Segment;
use std::fmt;

type Segments<'a> = Box<dyn Iterator<Item = (u64, Segment)> + 'a>;

/// Goes forward through segments that are given with their first ticks.
pub(crate) struct SpeedRegister<'a> {
    segments: Segments<'a>,
    /// The next segment, with its first tick.
    next: Option<(u64, Segment)>,
    /// The running segment, with its first tick.
    running: Option<(u64, Segment)>,
}

impl fmt::Debug for SpeedRegister<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SpeedRegister").field("running", &self.running).finish_non_exhaustive()
    }
}

impl<'a> SpeedRegister<'a> {
    pub(crate) fn new(mut segments: Segments<'a>) -> Self {
        let next = segments.next();
        Self { segments, next, running: None }
    }

    /// The tick at which the next segment starts or the running one ends, whichever is earlier.
    pub(crate) fn next_change(&self) -> Option<u64> {
        let over = self.running.map(|(start, segment)| start.saturating_add(segment.ticks.into()));
        let starts = self.next.map(|(start, _)| start);
        starts.into_iter().chain(over).min()
    }

    /// Goes on to the segment of tick `tick`. Ticks must not decrease from call to call.
    pub(crate) fn go_to(&mut self, tick: u64) {
        while let Some(next) = self.next.filter(|&(start, _)| start <= tick) {
            self.running = Some(next);
            self.next = self.segments.next();
        }
    }

    /// V in 2^-64 step per tick during tick `tick`, counted from 0. Ticks must not decrease from
    /// call to call.
    pub(crate) fn at(&mut self, tick: u64) -> i64 {
        self.go_to(tick);
        let Some((start, segment)) = self.running else { return 0 };
        let n = i128::from(tick.saturating_sub(start));
        if n >= i128::from(segment.ticks) {
            self.running = None;
            return 0;
        }
        let (v, a, j) = (i128::from(segment.v), i128::from(segment.a), i128::from(segment.j));
        // A and J wrap, as the registers do.
        (v + n * a).wrapping_add((n * (n - 1) / 2).wrapping_mul(j)) as i64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn v_equals_the_sum_of_additions_tick_by_tick() {
        let segments = [
            (2, Segment { ticks: 5, v: -9_000_000_000, a: 77_777, j: -13, last: false }),
            (7, Segment { ticks: 3, v: 40, a: -1, j: 2, last: true }),
            (20, Segment { ticks: 1, v: 5, a: 0, j: 0, last: true }),
        ];
        let mut expected = vec![0; 30];
        for (start, segment) in segments {
            let (mut v, mut a) = (segment.v, segment.a);
            for tick in start..start + u64::from(segment.ticks) {
                expected[tick as usize] = v;
                v += a;
                a += segment.j;
            }
        }
        let mut register = SpeedRegister::new(Box::new(segments.into_iter()));
        let found: Vec<i64> = (0..30).map(|tick| register.at(tick)).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn next_change_is_the_start_and_then_the_end_of_a_segment() {
        let segments = [(0, Segment { ticks: 4, v: 1, a: 0, j: 0, last: true })];
        let mut register = SpeedRegister::new(Box::new(segments.into_iter()));
        assert_eq!(register.next_change(), Some(0));
        register.at(0);
        assert_eq!(register.next_change(), Some(4));
        register.at(4);
        assert_eq!(register.next_change(), None);
    }
}

//! A move of one axis from rest to rest that always fits into its queue: speed up, cruise, slow down, in integers only.
//!
//! ```text
//! V      ____________
//!       /            \        2n + m ticks: n of acceleration, m of cruise, n of deceleration;
//!     /                \      (2n + m) start + n (n - 1 + m) a = steps x 2^64, exactly
//!    |    n  |  m  |  n  |
//! ```

use crate::command::Segment;
use crate::registers::QUEUE_SEGMENTS;
use thiserror::Error;

/// How an axis may move: a speed in 2^-64 step per tick, an acceleration in 2^-64 step per tick^2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gait {
    /// The speed to which the motor jumps from rest.
    pub start: u64,
    /// The greatest speed, 1 to 2^63 - 1.
    pub speed: u64,
    /// The greatest acceleration, 1 or more.
    pub accel: u64,
}

/// A move that takes more ticks than segments count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("a move of {steps} steps at this speed takes over 2^32 ticks: a greater speed or acceleration would do")]
pub struct TooLong {
    /// Its steps.
    pub steps: i32,
}

/// Segments of one axis, 7 at the most; the last one ends the move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Travel {
    segments: [Option<Segment>; QUEUE_SEGMENTS as usize],
    count: usize,
}

impl Travel {
    /// A move of so many steps, forward where they are positive, with so many ticks of rest before and behind it.
    ///
    /// The axis lands exactly: its fraction of a step is what it was before.
    ///
    /// # Errors
    /// [`TooLong`].
    pub fn new(steps: i32, gait: Gait, before: u32, after: u32) -> Result<Self, TooLong> {
        let mut travel = Self::default();
        let rest = Segment { ticks: 0, v: 0, a: 0, j: 0, last: false };
        travel.push(Segment { ticks: before, ..rest });
        if steps != 0 {
            travel.go(steps, gait).ok_or(TooLong { steps })?;
        }
        travel.push(Segment { ticks: after, ..rest });
        if let Some(segment) = travel.count.checked_sub(1).and_then(|last| travel.segments.get_mut(last)) {
            segment.iter_mut().for_each(|segment| segment.last = true);
        }
        Ok(travel)
    }

    /// The segments in order.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        self.segments.iter().copied().flatten()
    }

    /// The segment of this place.
    pub fn get(&self, at: usize) -> Option<Segment> {
        self.segments.get(at).copied().flatten()
    }

    fn push(&mut self, segment: Segment) {
        if segment.ticks > 0
            && let Some(place) = self.segments.get_mut(self.count)
        {
            *place = Some(segment);
            self.count += 1;
        }
    }

    fn go(&mut self, steps: i32, gait: Gait) -> Option<()> {
        let Shape { start, a, n, m } = Shape::of(steps.unsigned_abs(), gait)?;
        let signed = |value: u128| -> Option<i64> {
            let value = i64::try_from(value).ok()?;
            Some(if steps < 0 { -value } else { value })
        };
        let ticks = |count: u128| u32::try_from(count).ok();
        let peak = start + n * a;
        // What the divisions have left is spread over the cruise.
        let rest = (u128::from(steps.unsigned_abs()) << 64) - (2 * n + m) * start - n * (n + m - 1) * a;
        let (speed, faster) = (peak + rest / m, rest % m);
        self.push(Segment { ticks: ticks(n)?, v: signed(start)?, a: signed(a)?, j: 0, last: false });
        self.push(Segment { ticks: ticks(faster)?, v: signed(speed + 1)?, a: 0, j: 0, last: false });
        self.push(Segment { ticks: ticks(m - faster)?, v: signed(speed)?, a: 0, j: 0, last: false });
        // From the speed of the last tick of the acceleration, which is a less than the peak.
        let v = start + n.saturating_sub(1) * a;
        self.push(Segment { ticks: ticks(n)?, v: signed(v)?, a: -signed(a)?, j: 0, last: false });
        Some(())
    }
}

/// Ticks of acceleration and of cruise, speed of the first tick and acceleration, all zero or more; `m` is 1 or more.
struct Shape {
    start: u128,
    a: u128,
    n: u128,
    m: u128,
}

impl Shape {
    /// The shortest move of so many steps that keeps to the gait.
    fn of(steps: u32, Gait { start, speed, accel }: Gait) -> Option<Self> {
        let distance = u128::from(steps) << 64;
        let (speed, accel) = (u128::from(speed).min(i64::MAX as u128), u128::from(accel.max(1)));
        let start = u128::from(start).min(speed);
        if speed == 0 {
            return None;
        }
        let most = u128::from(u32::MAX);
        let full = (speed - start).div_ceil(accel);
        // With n ticks of acceleration, and one of cruise, an axis goes so far at the most.
        let reach = |n: u128| (2 * n + 1) * start + n * n * accel;
        let (mut n, mut above) = (0, full.min(most));
        if full <= most && reach_at_speed(start, speed, full) < distance {
            n = full;
        } else {
            while n < above {
                let middle = (n + above) / 2;
                if reach(middle) >= distance { above = middle } else { n = middle + 1 }
            }
            if reach(n) < distance {
                return None;
            }
        }
        // As many ticks of cruise as keep the speed under the greatest: (n + 1) start + (n - 1 + m) peak = distance.
        let cruise = distance.saturating_sub((n + 1) * start).div_ceil(speed);
        let m = (cruise + 1).saturating_sub(n).max(1);
        if 2 * n + m > most {
            return None;
        }
        let weight = n * (n + m - 1);
        let (start, a) = match distance.checked_sub((2 * n + m) * start) {
            Some(over) if n > 0 => {
                let a = (over / weight).min(accel);
                (start + (over - weight * a) / (2 * n + m), a)
            }
            _ => (distance / (2 * n + m), 0),
        };
        Some(Self { start, a, n, m })
    }
}

/// How far an axis goes that just reaches its greatest speed.
const fn reach_at_speed(start: u128, speed: u128, n: u128) -> u128 {
    (n + 1) * start + n * speed
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// Runs the segments; the distance in 2^-64 step, the ticks, the greatest and least speed, and the greatest change of speed.
    fn run(travel: &Travel) -> (i128, u64) {
        let (mut sum, mut ticks) = (0_i128, 0_u64);
        for Segment { ticks: n, v, a, .. } in travel.segments() {
            let count = i128::from(n);
            sum += count * i128::from(v) + count * (count - 1) / 2 * i128::from(a);
            ticks += u64::from(n);
        }
        (sum, ticks)
    }

    proptest! {
        #[test]
        fn it_lands_exactly_within_its_gait(
            steps in prop_oneof![1_i32..50, 1_i32..1_000_000], back in any::<bool>(),
            start in prop_oneof![Just(0_u64), 1_u64..1 << 56], speed in (1_u64 << 48)..1 << 62, accel in (1_u64 << 35)..1 << 58,
            before in 0_u32..100, after in 0_u32..100,
        ) {
            let steps = if back { -steps } else { steps };
            let travel = Travel::new(steps, Gait { start, speed, accel }, before, after).unwrap();
            let segments: Vec<Segment> = travel.segments().collect();
            prop_assert!(segments.len() <= QUEUE_SEGMENTS.into());
            prop_assert_eq!(segments.iter().position(|segment| segment.last), Some(segments.len() - 1));
            prop_assert_eq!(run(&travel).0, i128::from(steps) << 64);
            // The divisions leave less than a unit for each tick.
            let (slack, mut v) = (1 + run(&travel).1, 0_i64);
            for Segment { ticks, v: first, a, .. } in segments {
                let jump = first.abs_diff(v);
                prop_assert!(jump <= accel.max(start.min(speed)) + slack, "{jump} at {first}");
                let end = first + a * i64::from(ticks - 1);
                prop_assert!(first == 0 || (first < 0) == back);
                prop_assert!(end == 0 || (end < 0) == back);
                prop_assert!(first.unsigned_abs().max(end.unsigned_abs()) <= speed + slack);
                prop_assert!(a.unsigned_abs() <= accel);
                v = end;
            }
            prop_assert!(v.unsigned_abs() <= accel.max(start.min(speed)) + slack);
        }
    }

    #[test]
    fn nothing_is_shorter_within_the_gait() {
        // From rest at 2^40 a tick^2: 10 steps take twice the square root of 10 x 2^24 ticks.
        let gait = Gait { start: 0, speed: 1 << 62, accel: 1 << 40 };
        let ticks = run(&Travel::new(10, gait, 0, 0).unwrap()).1;
        assert!((25_905..=25_908).contains(&ticks), "{ticks}");
        let cruise = Gait { start: 1 << 60, speed: 1 << 60, accel: 1 };
        assert_eq!(run(&Travel::new(-10, cruise, 0, 0).unwrap()).1, 160);
    }

    #[test]
    fn rests_are_kept_and_what_takes_too_long_is_refused() {
        let gait = Gait { start: 0, speed: 1 << 60, accel: 1 << 40 };
        let travel = Travel::new(0, gait, 3, 4).unwrap();
        assert_eq!(travel.segments().map(|segment| (segment.ticks, segment.v)).collect::<Vec<_>>(), [(3, 0), (4, 0)]);
        for slow in [Gait { speed: 1 << 30, ..gait }, Gait { accel: 1, ..gait }, Gait { speed: 0, ..gait }] {
            assert_eq!(Travel::new(-5, slow, 0, 0), Err(TooLong { steps: -5 }));
        }
    }
}

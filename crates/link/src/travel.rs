//! A move of one axis from rest to rest that always fits into its queue: acceleration, cruise and
//! deceleration, computed with integers only.
//!
//! ```text
//! V      ____________
//!       /            \        2n + m ticks: n of acceleration, m of cruise, n of deceleration;
//!     /                \      (2n + m) start + n (n - 1 + m) a = steps x 2^64, exactly
//!    |    n  |  m  |  n  |
//! ```

use crate::command::Segment;
use crate::registers::LEAST_QUEUE;
use thiserror::Error;

/// Limits of a move: speeds in 2^-64 step per tick, acceleration in 2^-64 step per tick^2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gait {
    /// Speed at which the motor starts from rest.
    pub start: u64,
    /// Greatest speed, 1 to 2^63 - 1.
    pub speed: u64,
    /// Greatest acceleration, 1 or more.
    pub accel: u64,
}

/// Error: the move needs more ticks than a segment can count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "a move of {steps} steps at this speed takes over 2^32 ticks: a greater speed or acceleration would do"
)]
pub struct TooLong {
    /// Length of the move, steps.
    pub steps: i32,
}

/// The segments of a move of one axis, at most 7. The last one ends the move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Travel {
    segments: [Option<Segment>; LEAST_QUEUE as usize],
    count: usize,
}

impl Travel {
    /// A move of `steps` steps, forward if positive, with `before` ticks of rest before it and
    /// `after` ticks behind it.
    ///
    /// The axis lands exactly: its fraction of a step is the same as before the move.
    ///
    /// # Errors
    /// [`TooLong`] if the move needs too many ticks.
    pub fn new(steps: i32, gait: Gait, before: u32, after: u32) -> Result<Self, TooLong> {
        let mut travel = Self::default();
        let rest = Segment { ticks: 0, v: 0, a: 0, j: 0, last: false };
        travel.push(Segment { ticks: before, ..rest });
        if steps != 0 {
            travel.go(steps, gait).ok_or(TooLong { steps })?;
        }
        travel.push(Segment { ticks: after, ..rest });
        if let Some(segment) =
            travel.count.checked_sub(1).and_then(|last| travel.segments.get_mut(last))
        {
            segment.iter_mut().for_each(|segment| segment.last = true);
        }
        Ok(travel)
    }

    /// The segments, in order.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        self.segments.iter().copied().flatten()
    }

    /// The segment with this index.
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
        // The remainders of the divisions are distributed over the cruise.
        let rest =
            (u128::from(steps.unsigned_abs()) << 64) - (2 * n + m) * start - n * (n + m - 1) * a;
        let (speed, faster) = (peak + rest / m, rest % m);
        self.push(Segment {
            ticks: ticks(n)?,
            v: signed(start)?,
            a: signed(a)?,
            j: 0,
            last: false,
        });
        self.push(Segment {
            ticks: ticks(faster)?,
            v: signed(speed + 1)?,
            a: 0,
            j: 0,
            last: false,
        });
        self.push(Segment {
            ticks: ticks(m - faster)?,
            v: signed(speed)?,
            a: 0,
            j: 0,
            last: false,
        });
        // The deceleration starts at the speed of the last tick of the acceleration, which is `a`
        // below the peak.
        let v = start + n.saturating_sub(1) * a;
        self.push(Segment { ticks: ticks(n)?, v: signed(v)?, a: -signed(a)?, j: 0, last: false });
        Some(())
    }
}

/// Shape of a move: speed `start` of the first tick, acceleration `a`, `n` ticks of acceleration
/// and of deceleration, `m` ticks of cruise. All are 0 or more; `m` is 1 or more.
struct Shape {
    start: u128,
    a: u128,
    n: u128,
    m: u128,
}

impl Shape {
    /// The shortest move of this number of steps within the limits.
    fn of(steps: u32, Gait { start, speed, accel }: Gait) -> Option<Self> {
        let distance = u128::from(steps) << 64;
        let (speed, accel) = (u128::from(speed).min(i64::MAX as u128), u128::from(accel.max(1)));
        let start = u128::from(start).min(speed);
        if speed == 0 {
            return None;
        }
        let most = u128::from(u32::MAX);
        let full = (speed - start).div_ceil(accel);
        // The greatest distance with n ticks of acceleration and one tick of cruise.
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
        // The number of cruise ticks that keeps the peak within the greatest speed, from (n + 1)
        // start + (n - 1 + m) peak = distance.
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

/// Distance of a move that just reaches its greatest speed.
const fn reach_at_speed(start: u128, speed: u128, n: u128) -> u128 {
    (n + 1) * start + n * speed
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// Executes the segments and returns the distance in 2^-64 step and the number of ticks.
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
        fn move_lands_exactly_within_its_limits(
            steps in prop_oneof![1_i32..50, 1_i32..1_000_000], back in any::<bool>(),
            start in prop_oneof![Just(0_u64), 1_u64..1 << 56], speed in (1_u64 << 48)..1 << 62, accel in (1_u64 << 35)..1 << 58,
            before in 0_u32..100, after in 0_u32..100,
        ) {
            let steps = if back { -steps } else { steps };
            let travel = Travel::new(steps, Gait { start, speed, accel }, before, after).unwrap();
            let segments: Vec<Segment> = travel.segments().collect();
            prop_assert!(segments.len() <= LEAST_QUEUE.into());
            prop_assert_eq!(segments.iter().position(|segment| segment.last), Some(segments.len() - 1));
            prop_assert_eq!(run(&travel).0, i128::from(steps) << 64);
            // The divisions leave a remainder of less than one unit per tick.
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
    fn move_is_the_shortest_within_the_limits() {
        // From rest with 2^40 per tick^2: 10 steps take twice the square root of 10 x 2^24 ticks.
        let gait = Gait { start: 0, speed: 1 << 62, accel: 1 << 40 };
        let ticks = run(&Travel::new(10, gait, 0, 0).unwrap()).1;
        assert!((25_905..=25_908).contains(&ticks), "{ticks}");
        let cruise = Gait { start: 1 << 60, speed: 1 << 60, accel: 1 };
        assert_eq!(run(&Travel::new(-10, cruise, 0, 0).unwrap()).1, 160);
    }

    #[test]
    fn rests_are_kept_and_too_long_moves_refused() {
        let gait = Gait { start: 0, speed: 1 << 60, accel: 1 << 40 };
        let travel = Travel::new(0, gait, 3, 4).unwrap();
        assert_eq!(
            travel.segments().map(|segment| (segment.ticks, segment.v)).collect::<Vec<_>>(),
            [(3, 0), (4, 0)]
        );
        for slow in
            [Gait { speed: 1 << 30, ..gait }, Gait { accel: 1, ..gait }, Gait { speed: 0, ..gait }]
        {
            assert_eq!(Travel::new(-5, slow, 0, 0), Err(TooLong { steps: -5 }));
        }
    }
}

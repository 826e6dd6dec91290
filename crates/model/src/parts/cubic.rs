//! P of one axis over a stretch of plain ticks, in closed form.
//!
//! These sums use wrapping arithmetic, because overflow checks would cost as much as the sums. They
//! cannot overflow: a stretch has at most 2^16 ticks, so every binomial is below 2^48 and every
//! product below 2^112. A stretch with A = J = 0 may have up to 2^31 ticks: its binomials may wrap,
//! but they are multiplied by 0.

/// The greatest number of ticks in a stretch whose acceleration or jerk is not 0.
pub(crate) const MOST_TICKS: u32 = 1 << 16;

/// V, A and J before the first tick of a stretch, in 2^-64 step per tick, tick^2 and tick^3.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Cubic {
    pub v: i64,
    pub a: i64,
    pub j: i64,
}

/// The binomial n over 2: n (n - 1) / 2.
const fn pairs(n: u32) -> i64 {
    let n = n as i64;
    n.wrapping_mul(n.wrapping_sub(1)) / 2
}

/// The binomial n over 3: n (n - 1) (n - 2) / 6.
const fn triples(n: u32) -> i64 {
    pairs(n).wrapping_mul((n as i64).wrapping_sub(2)) / 3
}

/// The exact product: 64 by 64 bits always fit 128.
const fn wide(x: i64, y: i64) -> i128 {
    (x as i128).wrapping_mul(y as i128)
}

impl Cubic {
    /// An axis at rest.
    pub const REST: Self = Self { v: 0, a: 0, j: 0 };

    /// V before tick `n`, counted from 0.
    pub const fn speed(self, n: u32) -> i128 {
        (self.v as i128).wrapping_add(wide(n as i64, self.a)).wrapping_add(wide(pairs(n), self.j))
    }

    /// A before tick `n`.
    pub const fn acceleration(self, n: u32) -> i128 {
        (self.a as i128).wrapping_add(wide(n as i64, self.j))
    }

    /// The sum that the first `n` ticks add to P, in 2^-64 step.
    pub const fn distance(self, n: u32) -> i128 {
        let linear = wide(n as i64, self.v);
        linear.wrapping_add(wide(pairs(n), self.a)).wrapping_add(wide(triples(n), self.j))
    }

    /// The result of [`Cubic::speed`] modulo 2^64.
    pub const fn speed_wrapping(self, n: u32) -> i64 {
        let linear = self.a.wrapping_mul(n as i64).wrapping_add(self.v);
        linear.wrapping_add(self.j.wrapping_mul(pairs(n)))
    }

    /// The result of [`Cubic::distance`] modulo 2^64.
    pub const fn distance_wrapping(self, n: u32) -> u64 {
        let linear = self.v.wrapping_mul(n as i64).wrapping_add(self.a.wrapping_mul(pairs(n)));
        linear.wrapping_add(self.j.wrapping_mul(triples(n))).cast_unsigned()
    }

    /// The registers before tick `n`. The cubic must satisfy [`Cubic::stays_in_range`] for `n`
    /// ticks.
    pub const fn after(self, n: u32) -> Self {
        Self {
            v: self.speed_wrapping(n),
            a: self.a.wrapping_add(self.j.wrapping_mul(n as i64)),
            j: self.j,
        }
    }

    /// The same motion in the opposite direction. It is exact if this cubic stays in range.
    pub const fn mirrored(self) -> Self {
        Self { v: self.v.wrapping_neg(), a: self.a.wrapping_neg(), j: self.j.wrapping_neg() }
    }

    /// The tick before which V has its extremum, if it is one of the first `ticks` ticks.
    fn extremum(self, ticks: u32) -> Option<u32> {
        let (a, j) = (i128::from(self.a), i128::from(self.j));
        let turns = a.signum() * j.signum() < 0;
        let tick = turns.then(|| a.unsigned_abs().div_ceil(j.unsigned_abs()))?;
        u32::try_from(tick).ok().filter(|&tick| tick < ticks)
    }

    /// True if `ticks` ticks keep both V and A in the open interval (-2^63, 2^63).
    pub fn stays_in_range(self, ticks: u32) -> bool {
        let inside = |x: i128| x.unsigned_abs() <= i64::MAX.unsigned_abs().into();
        let ends =
            [self.speed(ticks), self.acceleration(0), self.acceleration(ticks), self.j.into()];
        ends.into_iter().all(inside)
            && self.extremum(ticks).is_none_or(|tick| inside(self.speed(tick)))
    }

    /// How many of the next `ticks` ticks (at least 1) add a V with the sign of the first one. The
    /// count ends at the latest at the extremum of V.
    pub fn same_sign(self, ticks: u32) -> u32 {
        let sign = self.v.signum();
        let differs = |n: u32| self.speed(n).signum() != i128::from(sign);
        // V is monotonic up to its extremum.
        let ticks = self.extremum(ticks).map_or(ticks, |tick| tick.max(1));
        if !differs(ticks - 1) {
            return ticks;
        }
        first(1, ticks - 1, differs)
    }
}

/// The least number from `low` to `high` for which `holds` is true. The condition must be
/// monotonic; `high` is returned if it holds for no smaller number.
pub(crate) fn first(mut low: u32, mut high: u32, holds: impl Fn(u32) -> bool) -> u32 {
    while low < high {
        let middle = low.midpoint(high);
        if holds(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    /// V and A before each tick, computed tick by tick without wrapping.
    fn ticked(cubic: Cubic, ticks: u32) -> Vec<(i128, i128)> {
        let (mut v, mut a) = (i128::from(cubic.v), i128::from(cubic.a));
        let mut all = vec![(v, a)];
        for _ in 0..ticks {
            (v, a) = (v + a, a + i128::from(cubic.j));
            all.push((v, a));
        }
        all
    }

    #[test]
    fn closed_forms_equal_tick_by_tick_sums() {
        for (v, a, j) in [
            (-50, 31, -4),
            (7, -3, 1),
            (0, 5, -2),
            (0, 0, 1),
            (i64::MAX, -1, 0),
            (-9, 0, 3),
            (8, -4, 0),
        ] {
            let cubic = Cubic { v, a, j };
            let ticked = ticked(cubic, 40);
            for n in 0..40 {
                let before: i128 = ticked[..n as usize].iter().map(|(v, _)| v).sum();
                assert_eq!(cubic.distance(n), before);
                assert_eq!((cubic.speed(n), cubic.acceleration(n)), ticked[n as usize]);
            }
            let length = cubic.same_sign(40);
            let same = ticked
                .iter()
                .take_while(|(v, _)| v.signum() == i128::from(cubic.v).signum())
                .count();
            assert!(
                length as usize <= same.max(1) && (length as usize == same.min(40) || j != 0),
                "{cubic:?} {length}"
            );
        }
    }

    #[test]
    fn stays_in_range_rejects_an_extremum_out_of_range() {
        let there_and_back = Cubic { v: i64::MAX - 10, a: 8, j: -4 };
        assert!(ticked(there_and_back, 6).iter().any(|(v, _)| *v > i64::MAX.into()));
        assert!(there_and_back.speed(6) < i64::MAX.into());
        assert!(!there_and_back.stays_in_range(6));
    }

    /// V + A is in range again after A has wrapped, so only the check of A itself detects it.
    #[test]
    fn stays_in_range_rejects_an_acceleration_that_wraps() {
        let cubic = Cubic { v: 9 - i64::MAX, a: 5, j: i64::MAX };
        assert!(cubic.speed(2).unsigned_abs() < 100);
        assert!(!cubic.stays_in_range(2));
    }
}

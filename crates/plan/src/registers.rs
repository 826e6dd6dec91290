//! The registers of a segment before a tick, and the V with which a number of ticks travels a
//! distance. A unit is 2^-64 step.

use crate::edges::{pairs, product};
use crate::error::Broken;

/// The values of V, A and J before a tick; V need be a register only where a segment begins.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Registers {
    pub v: i128,
    pub a: i64,
    pub j: i64,
}

impl Registers {
    /// The values that the gateware has accumulated `n` ticks later; at most 2^32 of them if J is
    /// not 0.
    ///
    /// # Errors
    /// [`Broken::Range`] if A has no register then.
    pub fn after(self, n: u64) -> Result<Self, Broken> {
        let Self { v, a, j } = self;
        let few = n.cast_signed();
        let v = v + product(few, a);
        if j == 0 {
            return Ok(Self { v, a, j });
        }
        let a = register(i128::from(a) + product(few, j))?;
        Ok(Self { v: v + product(pairs(n), j), a, j })
    }
}

/// The value of a register.
///
/// # Errors
/// [`Broken::Range`] if it has more than 64 bits.
pub(crate) fn register(value: i128) -> Result<i64, Broken> {
    i64::try_from(value).map_err(|_| Broken::Range)
}

/// A distance in `n` equal parts, rounded down, and the remainder.
pub(crate) fn shared_out(distance: i128, n: u64) -> (i128, u64) {
    if n == 1 {
        return (distance, 0);
    }
    let magnitude = distance.unsigned_abs();
    let (part, rest) = match (u32::try_from(n), u64::try_from(magnitude >> 32)) {
        // Long division in digits of 32 bits; no rest is over 32 bits, and so no digit is either.
        (Ok(_), Ok(high)) => {
            let low = (high % n) << 32 | magnitude as u64 & u64::from(u32::MAX);
            (u128::from(high / n) << 32 | u128::from(low / n), low % n)
        }
        _ => (magnitude / u128::from(n), (magnitude % u128::from(n)) as u64),
    };
    let part = part.cast_signed();
    match (distance < 0, rest) {
        (false, _) => (part, rest),
        (true, 0) => (-part, 0),
        (true, _) => (-part - 1, n - rest),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_and_remainder_are_those_of_a_division_of_128_bits() {
        let counts = [1, 2, 3, 1000, 85_568, u64::from(u32::MAX), 1 << 32, 1 << 42];
        let distances = [0, 1, 999, 1 << 63, (1 << 64) + 5, (1 << 90) - 1, 1 << 96, 1 << 106];
        for n in counts {
            for distance in distances.into_iter().flat_map(|distance: i128| [distance, -distance]) {
                let (part, rest) = shared_out(distance, n);
                let n = i128::from(n);
                assert_eq!((part, rest.into()), (distance.div_euclid(n), distance.rem_euclid(n)));
            }
        }
    }

    #[test]
    fn registers_after_some_ticks_are_those_after_single_ones() {
        let start = Registers { v: 5, a: -7, j: 3 };
        let mut now = start;
        for n in 1..50 {
            now = now.after(1).unwrap();
            let jumped = start.after(n).unwrap();
            assert_eq!((jumped.v, jumped.a), (now.v, now.a), "{n}");
        }
        let fast = Registers { v: 0, a: i64::MAX, j: 1 };
        assert_eq!(fast.after(1).map(|now| now.v), Err(Broken::Range));
    }
}

//! Least, greatest, mean and standard deviation of a stream of values, in constant memory.

use crate::exact;
use crate::ideal::rounded;
use bigdecimal::ToPrimitive as _;
use bigdecimal::num_bigint::BigInt;
use serde::{Deserialize, Serialize};

/// An extreme value, and the pulse at which it occurred.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Extreme {
    #[serde(with = "exact")]
    pub(crate) value: f64,
    pub(crate) number: u64,
    pub(crate) ps: u64,
}

/// Units of the sums in one unit of the values.
const UNITS: f64 = 1024.0;

/// The sums are whole numbers, so that those of two parts of a stream can be added and are those of
/// the whole stream, and nothing cancels however far the values are from zero. A value beyond
/// +-2^53 counts as that in the mean and in the deviation.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Spread {
    count: u64,
    /// The sum of all values in units.
    sum: i128,
    /// The sum of all squares in square units: the low 128 bits, and the others.
    squares: (u128, u64),
    /// What is added to every value, in units.
    shift: i128,
    least: Option<Extreme>,
    greatest: Option<Extreme>,
}

impl Spread {
    pub(crate) fn add(&mut self, value: f64, number: u64, ps: u64) {
        self.count += 1;
        // A cast saturates.
        let units = rounded(value * UNITS) as i64;
        self.sum += i128::from(units);
        let size = u128::from(units.unsigned_abs());
        self.add_squares((size * size, 0));
        let here = Some(Extreme { value, number, ps });
        if self.least.is_none_or(|old| value < old.value) {
            self.least = here;
        }
        if self.greatest.is_none_or(|old| value > old.value) {
            self.greatest = here;
        }
    }

    fn add_squares(&mut self, (low, high): (u128, u64)) {
        let (sum, carry) = self.squares.0.overflowing_add(low);
        self.squares = (sum, self.squares.1 + high + u64::from(carry));
    }

    /// Adds the values of a later part of the stream, to neither of which anything was added.
    pub(crate) fn append(&mut self, later: &Self) {
        self.count += later.count;
        self.sum += later.sum;
        self.add_squares(later.squares);
        let both =
            |old: Option<Extreme>, new: Option<Extreme>, is_further: fn(f64, f64) -> bool| {
                new.filter(|new| old.is_none_or(|old| is_further(new.value, old.value))).or(old)
            };
        self.least = both(self.least, later.least, |new, old| new < old);
        self.greatest = both(self.greatest, later.greatest, |new, old| new > old);
    }

    /// The same spread with a whole number added to every value.
    pub(crate) fn shifted(mut self, by: i64) -> Self {
        self.shift += i128::from(by) * UNITS as i128;
        for extreme in [&mut self.least, &mut self.greatest].into_iter().flatten() {
            extreme.value += by as f64;
        }
        self
    }

    pub(crate) fn min(&self) -> Option<Extreme> {
        self.least
    }

    pub(crate) fn max(&self) -> Option<Extreme> {
        self.greatest
    }

    /// Root mean square about zero.
    pub(crate) fn rms(&self) -> Option<f64> {
        let (count, sum, squares, shift) = self.whole();
        let all = squares + (sum * 2 + count * &shift) * shift;
        self.root(&(all * self.count))
    }

    /// Root mean square about the mean, which is the standard deviation.
    pub(crate) fn deviation(&self) -> Option<f64> {
        let (count, sum, squares, _) = self.whole();
        self.root(&(count * squares - sum.pow(2)))
    }

    /// Count, sum, sum of squares and shift.
    fn whole(&self) -> (BigInt, BigInt, BigInt, BigInt) {
        let squares = (BigInt::from(self.squares.1) << 128_u32) + self.squares.0;
        (self.count.into(), self.sum.into(), squares, self.shift.into())
    }

    /// The square root of `squares`, which is in square units, divided by the count.
    fn root(&self, squares: &BigInt) -> Option<f64> {
        let root = squares.to_f64()?.sqrt();
        (self.count > 0).then(|| root / self.count as f64 / UNITS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn parts_of_a_stream_are_the_whole_stream(
            values in prop::collection::vec(-1e9..1e9_f64, 0..40),
            cut in any::<prop::sample::Index>(),
            shift in -1_000_000_000..1_000_000_000_i64,
        ) {
            let cut = cut.index(values.len() + 1);
            let [mut whole, mut first, mut second] = [Spread::default(); 3];
            for (number, &value) in values.iter().enumerate() {
                whole.add(value, number as u64, 7);
                let part = if number < cut { &mut first } else { &mut second };
                part.add(value, number as u64, 7);
            }
            first.append(&second);
            prop_assert_eq!(first, whole);
            let (n, shift) = (values.len() as f64, shift as f64);
            let mean = values.iter().sum::<f64>() / n;
            let about = |zero: f64| {
                let square = |value: &f64| (value - zero).powi(2);
                (values.iter().map(square).sum::<f64>() / n).sqrt()
            };
            let found = whole.shifted(shift as i64);
            for (found, wanted) in [(found.rms(), about(-shift)), (found.deviation(), about(mean))] {
                let near = |found: f64| (found - wanted).abs() <= 1e-3 + 1e-9 * wanted;
                prop_assert!(found.map_or(values.is_empty(), near), "{found:?} {wanted}");
            }
        }
    }

    #[test]
    fn spread_does_not_depend_on_the_origin_of_the_values() {
        let mut far = Spread::default();
        let values = [1.0, 2.0, 4.0, 7.0];
        for (k, value) in values.into_iter().enumerate() {
            far.add(1e12 + value, k as u64 + 1, 0);
        }
        let near = far.shifted(-1_000_000_000_000);
        assert_eq!(near.min().map(|e| (e.value, e.number)), Some((1.0, 1)));
        assert_eq!(near.max().map(|e| (e.value, e.number)), Some((7.0, 4)));
        assert!((near.rms().unwrap() - 17.5_f64.sqrt()).abs() < 1e-3);
        assert!((near.deviation().unwrap() - 5.25_f64.sqrt()).abs() < 1e-3);
    }
}

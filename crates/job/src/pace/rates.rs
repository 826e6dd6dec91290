//! A rate along planned rows: planned ticks per tick.
//!
//! Each planned row has a value; the rate is the quadratic B-spline of these values over the rows. It
//! has no corner, and in a row it lies between the values of the row and of its two neighbours.

/// Values of the rows of a window.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rates {
    /// Number of the row of the first value.
    pub first: u64,
    /// One for each row; before the first and behind the last one it stays what it is there.
    pub values: Vec<f64>,
}

impl Rates {
    /// The same value everywhere.
    pub fn constant(first: u64, value: f64) -> Self {
        Self { first, values: vec![value] }
    }

    /// The value of a row.
    pub fn of(&self, row: u64) -> f64 {
        let last = self.values.len().saturating_sub(1);
        let index = usize::try_from(row.saturating_sub(self.first)).unwrap_or(last).min(last);
        self.values.get(index).copied().unwrap_or(1.0)
    }

    /// The rate in a row, `part` of it behind its beginning.
    pub fn rate(&self, row: u64, part: f64) -> f64 {
        let [before, here, after] =
            [row.saturating_sub(1), row, row.saturating_add(1)].map(|row| self.of(row));
        let left = 1.0 - part;
        before * left * left / 2.0 + here * (0.5 + part * left) + after * part * part / 2.0
    }

    /// From these values to others: those up to row `from` stay, and `rows` further on the others
    /// have come into force, after the quintic of Flash and Hogan (1985).
    pub fn toward(&self, other: &Self, from: u64, rows: f64) -> Self {
        let first = other.first;
        let value = |index: usize| {
            let row = first + index as u64;
            let (old, new) = (self.of(row), other.of(row));
            let u = row.saturating_sub(from) as f64 / rows;
            if u >= 1.0 {
                return new;
            }
            old + (new - old) * u * u * u * (10.0 + u * (6.0 * u - 15.0))
        };
        Self { first, values: (0..other.values.len()).map(value).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rate_has_no_corner_and_stays_between_the_values() {
        let rates = Rates { first: 3, values: vec![1.0, 2.0, 0.5, 0.5, 1.5] };
        for row in 2..10 {
            let ends = [rates.rate(row, 1.0), rates.rate(row + 1, 0.0)];
            assert!((ends[0] - ends[1]).abs() < 1e-12, "{row}");
            let slopes = [
                (rates.rate(row, 1.0) - rates.rate(row, 1.0 - 1e-6)) / 1e-6,
                (rates.rate(row + 1, 1e-6) - rates.rate(row + 1, 0.0)) / 1e-6,
            ];
            assert!((slopes[0] - slopes[1]).abs() < 1e-4, "{row}: {slopes:?}");
            assert!((0.5..=2.0).contains(&rates.rate(row, 0.3)), "{row}");
        }
    }

    #[test]
    fn values_up_to_a_row_stay() {
        let old = Rates::constant(0, 1.0);
        let new = Rates { first: 0, values: vec![2.0; 20] };
        let both = old.toward(&new, 5, 4.0);
        assert!((0..=5).all(|row| both.of(row) == 1.0));
        assert!((9..30).all(|row| both.of(row) == 2.0));
        assert!((5..20).all(|row| both.of(row) <= both.of(row + 1)));
    }
}

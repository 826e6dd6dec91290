//! Least, greatest, mean and standard deviation of a stream of values, in constant memory.

/// An extreme value, and the pulse at which it occurred.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extreme {
    pub(crate) value: f64,
    pub(crate) number: u64,
    pub(crate) ps: u64,
}

/// The running moments of B. P. Welford (1962), which do not cancel however far the values are from
/// zero.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Spread {
    count: u64,
    mean: f64,
    squares: f64,
    least: Option<Extreme>,
    greatest: Option<Extreme>,
}

impl Spread {
    pub(crate) fn add(&mut self, value: f64, number: u64, ps: u64) {
        self.count += 1;
        let off = value - self.mean;
        self.mean += off / self.count as f64;
        self.squares += off * (value - self.mean);
        let here = Some(Extreme { value, number, ps });
        if self.least.is_none_or(|old| value < old.value) {
            self.least = here;
        }
        if self.greatest.is_none_or(|old| value > old.value) {
            self.greatest = here;
        }
    }

    /// The same spread with a constant added to every value.
    pub(crate) fn shifted(mut self, by: f64) -> Self {
        self.mean += by;
        for extreme in [&mut self.least, &mut self.greatest].into_iter().flatten() {
            extreme.value += by;
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
        (self.count > 0).then(|| (self.mean * self.mean + self.squares / self.count as f64).sqrt())
    }

    /// Root mean square about the mean, which is the standard deviation.
    pub(crate) fn deviation(&self) -> Option<f64> {
        (self.count > 0).then(|| (self.squares / self.count as f64).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_does_not_depend_on_the_origin_of_the_values() {
        let mut far = Spread::default();
        let values = [1.0, 2.0, 4.0, 7.0];
        for (k, value) in values.into_iter().enumerate() {
            far.add(1e12 + value, k as u64 + 1, 0);
        }
        let near = far.shifted(-1e12);
        assert_eq!(near.min().map(|e| (e.value, e.number)), Some((1.0, 1)));
        assert_eq!(near.max().map(|e| (e.value, e.number)), Some((7.0, 4)));
        assert!((near.rms().unwrap() - 17.5_f64.sqrt()).abs() < 1e-3);
        assert!((near.deviation().unwrap() - 5.25_f64.sqrt()).abs() < 1e-3);
    }
}

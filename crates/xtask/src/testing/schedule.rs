//! Which slice is started next: those that take all cores first, then the longest.

use super::slices::Slice;

/// The slices that have not been started.
pub struct Schedule {
    /// Place of each slice and the cores that it takes; the next one is the last.
    waiting: Vec<(usize, usize)>,
}

impl Schedule {
    /// Orders all slices for so many cores.
    pub fn new(slices: &[Slice], cores: usize) -> Self {
        let mut order: Vec<usize> = (0..slices.len()).collect();
        order.sort_by(|&one, &other| {
            let (one, other) = (&slices[one], &slices[other]);
            one.is_wide.cmp(&other.is_wide).then(one.seconds.total_cmp(&other.seconds))
        });
        let waiting = order.into_iter().map(|place| (place, slices[place].cores(cores))).collect();
        Self { waiting }
    }

    /// The next slice for so many cores that are free. A wide slice is never passed by a later one,
    /// so that it is not put off for ever.
    pub fn next(&mut self, free: usize) -> Option<usize> {
        self.waiting.pop_if(|(_, cores)| *cores <= free).map(|(place, _)| place)
    }
}

impl Slice {
    /// How many of all cores it takes.
    pub fn cores(&self, all: usize) -> usize {
        if self.is_wide { all } else { 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::{Schedule, Slice};

    fn slice(seconds: f64, is_wide: bool) -> Slice {
        Slice { binary: 0, names: Vec::new(), count: None, is_wide, seconds }
    }

    #[test]
    fn wide_slices_come_first_and_then_the_longest() {
        let slices = [slice(1.0, false), slice(9.0, false), slice(2.0, true), slice(5.0, false)];
        let mut schedule = Schedule::new(&slices, 2);
        assert_eq!(schedule.next(1), None);
        assert_eq!(schedule.next(2), Some(2));
        assert_eq!(schedule.next(0), None);
        assert_eq!(
            [schedule.next(2), schedule.next(1), schedule.next(1)],
            [Some(1), Some(3), Some(0)]
        );
        assert_eq!(schedule.next(2), None);
    }

    /// The makespan of a simulated run is near the least that is possible.
    #[test]
    fn no_core_idles_at_the_end() {
        let slices: Vec<Slice> = (1..=40).map(|n| slice(f64::from(n * 7 % 41), false)).collect();
        let mut schedule = Schedule::new(&slices, 2);
        let mut free_at = [0.0_f64; 2];
        while let Some(place) = schedule.next(1) {
            let core = usize::from(free_at[1] < free_at[0]);
            free_at[core] += slices[place].seconds;
        }
        assert!((free_at[0] - free_at[1]).abs() <= 2.0, "{free_at:?}");
    }
}

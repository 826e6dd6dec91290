//! Which slice is started next: the longest. Two slices that wait for half of their time share a core.
//! Slices that only wait run beside all of them, one after the other.

use super::slices::{Needs, Slice};

/// The slices that have not been started.
pub struct Schedule {
    /// Place of each slice and the half cores that it takes; the next one is the last.
    working: Vec<(usize, usize)>,
    /// The slices that only wait; the next one is the last.
    waiting: Vec<usize>,
}

impl Schedule {
    /// Orders all slices.
    pub fn new(slices: &[Slice]) -> Self {
        let mut order: Vec<usize> = (0..slices.len()).collect();
        order.sort_by(|&one, &other| slices[one].seconds.total_cmp(&slices[other].seconds));
        let waits = |place: &usize| slices[*place].needs == Needs::Patience;
        let (waiting, working): (Vec<usize>, Vec<usize>) = order.into_iter().partition(waits);
        let working = working.into_iter().map(|place| (place, slices[place].halves()));
        Self { working: working.collect(), waiting }
    }

    /// The next slice for so many half cores that are free; `waits` if a slice is running that only
    /// waits.
    pub fn next(&mut self, free: usize, waits: bool) -> Option<usize> {
        let next = if waits { None } else { self.waiting.pop() };
        next.or_else(|| self.working.pop_if(|(_, halves)| *halves <= free).map(|(place, _)| place))
    }
}

impl Slice {
    /// How many half cores it takes.
    pub fn halves(&self) -> usize {
        match self.needs {
            Needs::OneCore => 2,
            Needs::HalfACore => 1,
            Needs::Patience => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Needs, Schedule, Slice};

    fn slice(seconds: f64, needs: Needs) -> Slice {
        Slice { binary: 0, names: Vec::new(), count: None, needs, seconds }
    }

    #[test]
    fn the_longest_slices_come_first() {
        let slices = [1.0, 9.0, 2.0].map(|seconds| slice(seconds, Needs::OneCore));
        let mut schedule = Schedule::new(&slices);
        assert_eq!([4, 2].map(|free| schedule.next(free, false)), [Some(1), Some(2)]);
        assert_eq!(schedule.next(1, false), None);
        assert_eq!(schedule.next(2, false), Some(0));
        assert_eq!(schedule.next(4, false), None);
    }

    #[test]
    fn two_slices_that_wait_half_of_their_time_share_a_core() {
        let slices = [(1.0, Needs::HalfACore), (9.0, Needs::OneCore), (2.0, Needs::HalfACore)];
        let slices = slices.map(|(seconds, needs)| slice(seconds, needs));
        let mut schedule = Schedule::new(&slices);
        assert_eq!(schedule.next(4, false), Some(1));
        assert_eq!([2, 1].map(|free| schedule.next(free, false)), [Some(2), Some(0)]);
    }

    #[test]
    fn one_slice_that_waits_runs_beside_the_others() {
        let slices = [(1.0, Needs::Patience), (2.0, Needs::OneCore), (5.0, Needs::Patience)];
        let slices = slices.map(|(seconds, needs)| slice(seconds, needs));
        let mut schedule = Schedule::new(&slices);
        assert_eq!(schedule.next(4, false), Some(2), "the longer one that waits");
        assert_eq!(schedule.next(4, true), Some(1));
        assert_eq!(schedule.next(0, true), None);
        assert_eq!(schedule.next(0, false), Some(0));
        assert_eq!(schedule.next(4, false), None);
    }

    /// The makespan of a simulated run is near the least that is possible.
    #[test]
    fn no_core_idles_at_the_end() {
        let slices: Vec<Slice> =
            (1..=40).map(|n| slice(f64::from(n * 7 % 41), Needs::OneCore)).collect();
        let mut schedule = Schedule::new(&slices);
        let mut free_at = [0.0_f64; 2];
        while let Some(place) = schedule.next(2, true) {
            let core = usize::from(free_at[1] < free_at[0]);
            free_at[core] += slices[place].seconds;
        }
        assert!((free_at[0] - free_at[1]).abs() <= 2.0, "{free_at:?}");
    }
}

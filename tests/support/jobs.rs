//! Runs external tools, a few at a time.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of simulations that run at a time.
const JOBS: usize = 2;

/// Calls `work` for each item, a few at a time, and returns the results in order.
///
/// # Panics If `work` panics.
pub fn each<T: Sync, R: Send>(all: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let job = || {
        let take = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|place| *place < all.len());
        std::iter::from_fn(take).map(|place| (place, work(&all[place]))).collect::<Vec<_>>()
    };
    let mut done = std::thread::scope(|scope| {
        let jobs: Vec<_> = (0..JOBS).map(|_| scope.spawn(job)).collect();
        jobs.into_iter().flat_map(|job| job.join().expect("the tools")).collect::<Vec<_>>()
    });
    done.sort_by_key(|(place, _)| *place);
    done.into_iter().map(|(_, result)| result).collect()
}

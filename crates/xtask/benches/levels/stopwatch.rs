//! Measures processor time, which other programs on the same machine hardly affect.

use rustix::time::{ClockId, clock_gettime};

/// Processor time that this process has used, seconds.
pub fn now() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// The least time of one call, seconds, among as many calls as fit into `budget` seconds, and the
/// result of the last call.
pub fn least<T>(budget: f64, mut call: impl FnMut() -> T) -> (f64, T) {
    let begin = now();
    let mut least = f64::INFINITY;
    loop {
        let start = now();
        let result = call();
        let end = now();
        least = least.min(end - start);
        if end - begin >= budget {
            return (least, result);
        }
    }
}

/// The mean time of one of `times` calls in a row, seconds: the least among as many rows as fit
/// into `budget` seconds.
pub fn least_of(budget: f64, times: u32, mut call: impl FnMut()) -> f64 {
    least(budget, || (0..times).for_each(|_| call())).0 / f64::from(times)
}

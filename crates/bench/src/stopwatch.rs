//! Processor time: the same on a machine that others use too.

use rustix::time::{ClockId, clock_gettime};

/// Seconds of processor time that this process has used.
fn now() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Seconds of one call, the least of as many as fit into `budget` seconds, and what the last call gave.
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

//! The rhythm of a job: the time between knots, and how many samples are averaged.
//!
//! The filter averages m samples that are dt seconds apart. It keeps the jerk limit J at the
//! acceleration limit A if m dt >= 2 A / J (`filter.rs`). Each axis has one segment in each dt. A
//! dt is at least 4 ms, so an axis has at most 250 segments a second, and any eight successive
//! segments last at least 32 ms. On a slow line dt is longer, up to 16 ms; a line that is too slow
//! even then is refused.
//!
//! The time 2 A / J can be filled with fewer, longer dt or with more, shorter ones. The planner takes
//! the one with the smaller [`Rhythm::spread`]: it moves the curve less.

use crate::error::JobError;
use crate::limits::{Limit, SHORTEST};
use carrystep_core::link::{CRC_BYTES, REQUEST_HEAD, SEGMENT_FRAME_WORDS, SESSION_BYTES};
use carrystep_files::Machine;

/// Longest filter, knots: it bounds the work for a very low jerk limit. Knots then get longer, up to
/// [`LONGEST`].
const MOST_AVERAGED: f64 = 4096.0;
/// Longest time between knots, seconds: a hold or an override takes effect after the queue. The
/// last segment of a run is a tick longer.
pub(crate) const LONGEST: f64 = 0.016;
/// Bits on the line for each segment. A segment has 40 bytes of ten bits; two and a half times as
/// many leave room for answers and repeats. It gives 3000 segments a second at 3 Mbaud and 921 at
/// 921 600 baud; 3000 and 1200 were measured (`docs/performance.md`).
const BITS_A_SEGMENT: f64 = 1000.0;
/// Part of the line's time that the rows of a job may take where they are as long as may be. The
/// rest is for reads of the state, escaped bytes and repeats; a test of the virtual board carries
/// this much for six axes (`crates/virtual-board/tests/rates.rs`).
const MOST_OF_THE_LINE: f64 = 0.75;

/// The least baud rate of a UART that carries a row of so many axes in [`LONGEST`]. It counts a
/// SEGMENT frame for each axis, of ten bits a byte, and its two ENDs: where the axes do not have
/// room at the same time, the host cannot join their segments to one frame.
fn least_baud(axes: usize) -> u32 {
    let words = 4 * SEGMENT_FRAME_WORDS;
    let bytes = REQUEST_HEAD + SESSION_BYTES + words + CRC_BYTES + 2;
    (axes as f64 * bytes as f64 * 10.0 / LONGEST / MOST_OF_THE_LINE).ceil() as u32
}

/// Checks that the line of a machine can carry a job of all of its motors in time.
///
/// # Errors
/// [`JobError::SlowLine`].
pub fn check_line(machine: &Machine) -> Result<(), JobError> {
    let (axes, baud) = (machine.axes.len(), machine.baud);
    let least = least_baud(axes);
    if machine.spi || baud >= least {
        return Ok(());
    }
    Err(JobError::SlowLine { axes, baud, least })
}

/// The shortest time between knots in seconds for so many axes on a line of so many baud: 4 ms, or
/// longer if the line carries fewer segments, but at most 16 ms.
pub(crate) fn shortest(axes: usize, baud: u32) -> f64 {
    (axes as f64 * BITS_A_SEGMENT / f64::from(baud)).clamp(SHORTEST, LONGEST * 0.999)
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rhythm {
    /// Ticks from knot to knot.
    pub ticks: u32,
    /// The same in seconds.
    pub seconds: f64,
    /// Samples that are averaged.
    pub average: usize,
}

impl Rhythm {
    /// The rhythm for motors with these limits, a tick of so many seconds, and knots at least
    /// `shortest` seconds apart.
    pub fn new(limits: &[Limit], tick_seconds: f64, shortest: f64) -> Self {
        let width = limits.iter().map(|l| 2.0 * l.acceleration / l.jerk).fold(0.0, f64::max);
        let whole = (width / shortest * (1.0 - 1e-9)).max(0.0);
        let [fewer, more] = [whole.floor(), whole.ceil()].map(|n| n.clamp(1.0, MOST_AVERAGED));
        let most = ((LONGEST / tick_seconds).floor() - 1.0).max(1.0);
        let choice = |average: f64| {
            let ticks = ((width / average).max(shortest) / tick_seconds * (1.0 - 1e-12)).ceil();
            let ticks = ticks.clamp(1.0, f64::from(u32::MAX));
            // Knots that would be too long are more ones of the longest time.
            let (ticks, average) = if ticks > most {
                (most, (width / (most * tick_seconds)).ceil().max(1.0))
            } else {
                (ticks, average)
            };
            let ticks = ticks as u32;
            Self { ticks, seconds: f64::from(ticks) * tick_seconds, average: average as usize }
        };
        let [a, b] = [choice(fewer), choice(more)];
        if a.spread() <= b.spread() { a } else { b }
    }

    /// The second moment of what the emitted curve is a mean of, s^2: the samples' average and the
    /// spline. With an acceleration a, the curve is a/2 times this value off the smoothed one.
    pub fn spread(&self) -> f64 {
        let averaged = (self.average * self.average) as f64 - 1.0;
        self.seconds * self.seconds * (averaged / 12.0 + 1.0 / 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rhythm(acceleration: f64, jerk: f64) -> Rhythm {
        Rhythm::new(&[Limit { speed: 100.0, acceleration, jerk }], 1e-6, SHORTEST)
    }

    #[test]
    fn without_a_jerk_limit_knots_are_four_ms_apart_and_two_samples_are_averaged() {
        let found = rhythm(1000.0, 1000.0 / 0.004);
        assert_eq!((found.ticks, found.average), (4000, 2));
    }

    #[test]
    fn filter_is_as_long_as_the_jerk_limit_needs() {
        for jerk in [1.0, 10.0, 1e3, 1e4, 5e4, 1e5, 2.1e5, 2.5e5, 4e5, 1e6, 1e9] {
            let found = rhythm(1000.0, jerk);
            let width = found.seconds * found.average as f64;
            assert!(width * jerk >= 2000.0 * (1.0 - 1e-6), "{jerk}: {found:?}");
            assert!(found.ticks >= 4000 && found.average >= 1, "{jerk}: {found:?}");
            assert!(found.ticks < 16_000, "{jerk}: {found:?}");
        }
    }

    /// A SEGMENT has 40 bytes and two ENDs (docs/protocol.md): 420 bits, 35 000 baud for each axis.
    #[test]
    fn least_rate_of_a_line_carries_a_row_in_16_ms() {
        assert_eq!([1, 3, 6].map(least_baud), [35_000, 105_000, 210_000]);
    }

    #[test]
    fn a_slow_line_makes_knots_longer() {
        let ticks = |axes, baud| {
            let limit = Limit { speed: 100.0, acceleration: 1000.0, jerk: 250_000.0 };
            Rhythm::new(&[limit], 1e-6, shortest(axes, baud)).ticks
        };
        assert_eq!((ticks(6, 3_000_000), ticks(3, 921_600)), (4000, 4000));
        // 921 segments a second for six axes.
        assert!((6511..=8000).contains(&ticks(6, 921_600)), "{}", ticks(6, 921_600));
        assert!((15_000..16_000).contains(&ticks(6, 115_200)), "{}", ticks(6, 115_200));
    }
}

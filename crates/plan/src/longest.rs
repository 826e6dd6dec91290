//! Finds the longest time that works for a move whose given time is too long.
//!
//! The result appears only in an error message, so its precision (`CLOSE`) may change.

use bigdecimal::{BigDecimal, ToPrimitive};
use carrystep_core::Timebase;

/// The search ends when the interval of the longest time is narrower than this factor.
const CLOSE: f64 = 1.003;

/// Searches, by bisection on a logarithmic scale, for the longest time for which `works` is true.
/// It lies between `shortest` seconds, which works, and `longest` seconds, which does not.
///
/// Candidates have three significant digits and are whole ticks, so that a user can copy the
/// result. The result itself has been tried; `None` means that no candidate worked.
pub(crate) fn longest_time(
    shortest: f64,
    longest: f64,
    timebase: &Timebase,
    works: impl Fn(&BigDecimal) -> bool,
) -> Option<f64> {
    let (mut good, mut known, mut bad) = (shortest, None, longest);
    while bad / good > CLOSE {
        let middle = (good * bad).sqrt();
        let time = round(middle, timebase)?;
        if works(&time) {
            (good, known) = (middle, time.to_f64());
        } else {
            bad = middle;
        }
    }
    known
}

/// Rounds down to three significant digits and then to whole ticks.
fn round(seconds: f64, timebase: &Timebase) -> Option<BigDecimal> {
    let digit = 10_f64.powf(seconds.log10().floor() - 2.0);
    let ns = ((seconds / digit).floor() * digit * 1e9).round().to_u64()?;
    let tick_ns = timebase.tick_ns();
    Some(BigDecimal::new((ns - ns % tick_ns).into(), 9))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longest_time_is_within_two_percent_below_the_limit() {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        for limit in [0.5_f64, 3.3333, 2190.7, 654_321.0] {
            let found =
                longest_time(limit / 40.0, 1e6, &timebase, |time| time.to_f64().unwrap() <= limit)
                    .unwrap();
            assert!(found <= limit && found > 0.98 * limit, "{found} {limit}");
        }
        assert_eq!(longest_time(1.0, 1e6, &timebase, |_| false), None);
    }
}

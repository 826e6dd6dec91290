//! The longest time in which a move can be done that is too slow as it stands.

use bigdecimal::{BigDecimal, ToPrimitive};
use carrystep_core::Timebase;

/// The search ends where the longest time is known within this factor.
const CLOSE: f64 = 1.003;

/// The longest time between `shortest`, which works, and `longest`, which does not, in seconds: three digits, rounded
/// to whole ticks, so that a user can take it as it stands. Every time that is given out has been tried.
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

/// Three digits, down, to whole ticks.
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
    fn the_longest_time_is_near_the_limit_and_on_its_good_side() {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        for limit in [0.5_f64, 3.3333, 2190.7, 654_321.0] {
            let found = longest_time(limit / 40.0, 1e6, &timebase, |time| time.to_f64().unwrap() <= limit).unwrap();
            assert!(found <= limit && found > 0.98 * limit, "{found} {limit}");
        }
        assert_eq!(longest_time(1.0, 1e6, &timebase, |_| false), None);
    }
}

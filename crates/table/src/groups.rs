//! The number of pulses of each entry: one, by group, or by time.
//!
//! The numbers are fixed here and stored in the table. The controller does not count time, so that
//! the player can go back down the ramp through the same pulses.

use crate::error::TableError;
use crate::request::{MAX_ENTRIES, Pulses};
use schemars::JsonSchema;
use serde::Serialize;

/// A run of entries that all last the same number of pulses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Group {
    /// Index of the first entry after the run.
    pub end: u16,
    /// Pulses of each entry of the run, 1 or more.
    pub pulses: u16,
}

/// The least duration of an entry, in whole counts.
fn dwell(seconds: f64, timer: f64) -> u64 {
    (seconds * timer).round().max(1.0) as u64
}

/// Pulses of each entry, for entries whose delay per pulse is `counts`. The number of entries
/// stays, and the ramp gets more pulses.
pub(crate) fn stretch(counts: &[u32], pulses: &Pulses, timer: f64) -> Result<Vec<u32>, TableError> {
    match pulses {
        Pulses::One => Ok(vec![1; counts.len()]),
        Pulses::ByTime(seconds) => {
            let dwell = dwell(*seconds, timer);
            let lasting =
                |&c: &u32| u32::try_from(dwell.div_ceil(u64::from(c.max(1)))).unwrap_or(u32::MAX);
            Ok(counts.iter().map(lasting).collect())
        }
        Pulses::ByGroup(groups) => {
            let unit = groups.len().max(1);
            if !counts.len().is_multiple_of(unit) {
                return Err(TableError::Groups {
                    what: "entries",
                    length: narrow(counts.len()),
                    unit: narrow(unit),
                });
            }
            Ok(spread(groups, counts.len() / unit))
        }
    }
}

/// Pulses of each entry, for a ramp of `delays.len()` steps with the given delays in counts. The
/// number of steps stays, and an entry covers several of them.
pub(crate) fn merge(delays: &[f64], pulses: &Pulses, timer: f64) -> Result<Vec<u32>, TableError> {
    match pulses {
        Pulses::One => Ok(vec![1; delays.len()]),
        Pulses::ByTime(seconds) => Ok(chunks(delays, dwell(*seconds, timer) as f64)),
        Pulses::ByGroup(groups) => {
            let unit = groups.iter().fold(0_u32, |sum, &p| sum.saturating_add(p)).max(1);
            let length = narrow(delays.len());
            if !length.is_multiple_of(unit) {
                return Err(TableError::Groups { what: "ramp steps", length, unit });
            }
            Ok(spread(groups, (length / unit) as usize))
        }
    }
}

/// Repeats each number `times` times.
fn spread(groups: &[u32], times: usize) -> Vec<u32> {
    groups.iter().flat_map(|&p| std::iter::repeat_n(p, times)).collect()
}

/// Divides the steps into entries that each last at least `dwell` counts, except for the last one.
fn chunks(delays: &[f64], dwell: f64) -> Vec<u32> {
    let mut sizes = Vec::new();
    let (mut size, mut sum) = (0, 0.0);
    for delay in delays {
        size += 1;
        sum += delay;
        if sum >= dwell {
            sizes.push(size);
            (size, sum) = (0, 0.0);
        }
    }
    if size > 0 {
        sizes.push(size);
    }
    sizes
}

/// The mean delay of the steps of each entry.
pub(crate) fn means(delays: &[f64], sizes: &[u32]) -> Vec<f64> {
    let mut rest = delays;
    let mut mean = |&size: &u32| {
        let (steps, after) = rest.split_at((size as usize).min(rest.len()));
        rest = after;
        steps.iter().sum::<f64>() / f64::from(size)
    };
    sizes.iter().map(&mut mean).collect()
}

/// Combines neighbouring entries with equal numbers of pulses into groups. `longest` returns the
/// duration in seconds for the error message.
pub(crate) fn runs(sizes: &[u32], longest: impl Fn(u32) -> f64) -> Result<Vec<Group>, TableError> {
    if sizes.len() > MAX_ENTRIES as usize {
        return Err(TableError::TooLong { entries: sizes.len(), most: MAX_ENTRIES });
    }
    let pulses: u64 = sizes.iter().map(|&p| u64::from(p)).sum();
    if pulses >= u64::from(u32::MAX) {
        return Err(TableError::TooManyPulses { pulses });
    }
    let mut groups: Vec<Group> = Vec::new();
    for (i, &size) in sizes.iter().enumerate() {
        let too_many =
            TableError::TooManyPerEntry { pulses: size, seconds: longest(u32::from(u16::MAX)) };
        let pulses = u16::try_from(size).map_err(|_| too_many)?;
        let end = u16::try_from(i + 1).unwrap_or(u16::MAX);
        match groups.last_mut() {
            Some(group) if group.pulses == pulses => group.end = end,
            _ => groups.push(Group { end, pulses }),
        }
    }
    Ok(groups)
}

fn narrow(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entry_lasts_at_least_the_requested_time() {
        let sizes =
            stretch(&[396, 250, 126, 125, 124, 19], &Pulses::ByTime(1e-3), 250_000.0).unwrap();
        assert_eq!(sizes, [1, 1, 2, 2, 3, 14]);
        assert_eq!(chunks(&[300.0, 200.0, 60.0, 100.0, 20.0], 250.0), [1, 2, 2]);
    }

    #[test]
    fn entries_that_do_not_divide_into_groups_are_refused() {
        let groups = Pulses::ByGroup(vec![5, 10]);
        assert_eq!(stretch(&[9; 4], &groups, 1.0).unwrap(), [5, 5, 10, 10]);
        assert_eq!(merge(&[9.0; 30], &groups, 1.0).unwrap(), [5, 5, 10, 10]);
        assert!(matches!(stretch(&[9; 3], &groups, 1.0), Err(TableError::Groups { unit: 2, .. })));
        let error = merge(&[9.0; 31], &groups, 1.0).unwrap_err();
        assert_eq!(
            error.to_string(),
            "31 ramp steps do not divide into groups of 15: 30 or 45 would do"
        );
    }

    #[test]
    fn neighbours_with_equal_pulses_form_one_group() {
        let groups = runs(&[1, 1, 2, 2, 2, 1], |_| 0.0).unwrap();
        let pairs: Vec<_> = groups.iter().map(|g| (g.end, g.pulses)).collect();
        assert_eq!(pairs, [(2, 1), (5, 2), (6, 1)]);
    }
}

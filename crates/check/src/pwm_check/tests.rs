//! The check against a counter that is counted clock by clock.

use super::*;
use carrystep_core::Timebase;
use proptest::prelude::*;

const HZ: u64 = 48_000_000;
const PERIOD: u64 = 4096;

fn timing() -> PwmTiming {
    PwmTiming { timebase: Timebase::new(HZ, 2000, 4).unwrap(), divider: 1 }
}

fn ps(clock: u64) -> u64 {
    timing().timebase.clock_to_ps(clock)
}

/// The edges of the pin up to a clock; `due` are the first clocks in which the pin shows a duty.
fn pin(due: &[(u64, u16)], end: u64) -> Vec<(u64, bool)> {
    let (mut level, mut edges) = (false, Vec::new());
    for clock in 1..end {
        let duty = due.iter().rev().find(|(at, _)| *at <= clock).map_or(0, |(_, duty)| *duty);
        let now = (clock - 1) % PERIOD < duty.into();
        if std::mem::replace(&mut level, now) != now {
            edges.push((clock, now));
        }
    }
    edges
}

/// The report of a run with these edges, as clocks.
fn run(due: &[(u64, u16)], edges: &[(u64, bool)], end: u64) -> PwmReport {
    let mut check = PwmCheck::new(timing(), Some(0), Some(0), 0);
    due.iter().for_each(|&(clock, duty)| check.due(ps(clock).cast_signed(), duty));
    edges.iter().for_each(|&(clock, level)| check.pin(ps(clock), level));
    check.end(ps(end))
}

/// That of a foreign capture, which begins `early` clocks before the plan. The plan begins at the
/// clock `begin`, of which the check learns after the edges before it.
fn foreign(due: &[(u64, u16)], edges: &[(u64, bool)], begin: u64, end: u64) -> PwmReport {
    const LATE: u64 = 7_000_000_123;
    let mut check = PwmCheck::new(timing(), None, None, 0);
    let since = |clock: u64| ps(clock).cast_signed() - ps(begin).cast_signed();
    due.iter().for_each(|&(clock, duty)| check.due(since(clock), duty));
    let (before, behind) = edges.split_at(edges.partition_point(|(clock, _)| *clock < begin));
    before.iter().for_each(|&(clock, level)| check.pin(LATE + ps(clock), level));
    check.begin((LATE + ps(begin)).cast_signed());
    behind.iter().for_each(|&(clock, level)| check.pin(LATE + ps(clock), level));
    check.end(LATE + ps(end))
}

/// Duties at increasing clocks.
fn duties() -> impl Strategy<Value = Vec<(u64, u16)>> {
    let duty = prop_oneof![Just(0_u16), Just(1), Just(4095), 0_u16..4096];
    prop::collection::vec((1_u64..3 * PERIOD, duty), 1..12).prop_map(|steps| {
        let mut clock = 0;
        let at = |(wait, duty)| {
            clock += wait;
            (clock, duty)
        };
        steps.into_iter().map(at).collect()
    })
}

proptest! {
    #[test]
    fn pin_of_the_counter_passes(due in duties()) {
        let end = due[due.len() - 1].0 + 2 * PERIOD;
        let report = run(&due, &pin(&due, end), end);
        prop_assert!(report.passed && report.compared && report.longest_ns == 0.0, "{}", report);
    }

    #[test]
    fn edge_that_is_a_clock_off_or_missing_is_caught(
        due in duties(), which in any::<prop::sample::Index>(), bug in 0..3,
    ) {
        let end = due[due.len() - 1].0 + 2 * PERIOD;
        let mut edges = pin(&due, end);
        prop_assume!(edges.len() > 1);
        let which = which.index(edges.len());
        match bug {
            0 => edges[which].0 += 1,
            1 => edges[which].0 -= 1,
            // A whole pulse, or a whole gap.
            _ => drop(edges.drain(which.min(edges.len() - 2)..).take(2).count()),
        }
        edges.sort_unstable();
        let report = run(&due, &edges, end);
        prop_assert!(!report.passed && report.first_wrong.is_some(), "{}", report);
    }

    #[test]
    fn duty_that_is_a_step_off_is_caught(due in duties(), which in any::<prop::sample::Index>()) {
        let end = due[due.len() - 1].0 + 2 * PERIOD;
        let edges = pin(&due, end);
        let mut wrong = due.clone();
        let which = which.index(due.len());
        wrong[which].1 = if due[which].1 == 0 { 1 } else { due[which].1 - 1 };
        let others = pin(&wrong, end);
        // A duty may be replaced before the counter reaches the difference.
        prop_assert_eq!(run(&wrong, &edges, end).passed, edges == others);
    }

    #[test]
    fn foreign_capture_shows_where_the_counter_is_zero(due in duties()) {
        let mut due = due;
        // One duty that lasts, and one behind it.
        let last = due[due.len() - 1].0;
        due.extend([(last + 5000, 900), (last + 5000 + 4 * PERIOD, 3000)]);
        let (begin, end) = (due[0].0, last + 5000 + 8 * PERIOD);
        let edges = pin(&due, end);
        let report = foreign(&due, &edges, begin, end);
        prop_assert!(report.passed && report.compared, "{}", report);
        // The last duty is another one.
        let count = due.len();
        due[count - 1].1 = 2960;
        prop_assert!(!foreign(&due, &edges, begin, end).passed);
    }
}

#[test]
fn stuck_pin_is_caught_and_an_idle_one_is_none() {
    let due = [(5000, 2048)];
    let edges = pin(&due, 20_000);
    assert!(!run(&due, &[], 20_000).passed);
    assert!(!run(&due, &edges[..1], 20_000).passed);
    assert!(!run(&[], &edges, 20_000).passed);
    assert!(run(&[], &[], 20_000).passed);
    let never = foreign(&[(5000, 0)], &[], 5000, 20_000);
    assert!(never.passed && never.compared, "{never}");
}

#[test]
fn capture_without_a_whole_period_says_that_it_was_not_compared() {
    let due = [(100, 2048), (2000, 9), (4000, 3000)];
    let report = foreign(&due, &pin(&due, 5000), 100, 5000);
    assert!(!report.compared && report.passed, "{report}");
    assert!(report.to_string().starts_with("not checked: the PWM"), "{report}");
}

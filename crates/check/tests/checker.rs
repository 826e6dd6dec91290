//! Tests that the checker passes a correct pulse train, and names the error of each kind of wrong
//! one.

use crate::common::*;
use carrystep_check::*;
use carrystep_profile::Course;

fn sorted(mut train: Vec<PinChange>) -> Vec<PinChange> {
    train.sort_by_key(|change| change.ps);
    train
}

/// Breaks the train of a two-axis machine and returns the failures. Axis y must not have any.
fn failures(spoil: impl FnOnce(&mut Vec<PinChange>)) -> Vec<String> {
    let machine = Machine::there_and_back(2);
    let mut train = machine.train();
    spoil(&mut train);
    let report = machine.check(&sorted(train), KNOWN);
    assert!(!report.passed(), "{report}");
    assert!(report.axes[1].passed, "{report}");
    report.failures().map(str::to_owned).collect()
}

#[track_caller]
fn names(failures: &[String], wanted: &str) {
    assert!(failures.iter().any(|f| f.contains(wanted)), "{wanted:?} is not in {failures:#?}");
}

#[test]
fn correct_train_passes_with_the_figures_of_theory() {
    let machine = Machine::there_and_back(6);
    let report = machine.check(&machine.train(), KNOWN);
    assert!(report.passed(), "{report}");
    for (axis, name) in report.axes.iter().zip(NAMES) {
        assert_eq!(axis.axis, name);
        assert_eq!(axis.pulses_found, axis.pulses_expected);
        assert_eq!(axis.position_found, 0);
        // The generator rounds down to 62.5 ns.
        let (least, greatest) = (axis.error_min_ns.unwrap(), axis.error_max_ns.unwrap());
        assert!(
            (-62.501..-55.0).contains(&least) && (-5.0..=0.001).contains(&greatest),
            "{report}"
        );
        assert!(
            (axis.error_std_ns.unwrap() / axis.error_std_theory_ns - 1.0).abs() < 0.1,
            "{report}"
        );
        assert!(axis.error_bound_ns > 64.5 && axis.error_bound_ns < 70.0, "{report}");
        assert!(axis.period_jitter_max_ns.unwrap() <= axis.period_jitter_theory_ns, "{report}");
        assert_eq!(axis.step_high_min_ns, Some(1041.667));
        assert_eq!(axis.step_high_required_ns, 1000.0);
    }
}

#[test]
fn jitter_at_constant_speed_is_at_most_one_phase() {
    for steps in [1, 997, 12_345, 100_003] {
        let machine = Machine::steady(steps);
        let report = machine.check(&machine.train(), KNOWN);
        assert!(report.passed(), "{report}");
        let axis = &report.axes[0];
        assert!(axis.period_jitter_max_ns.unwrap_or(0.0) <= 62.501, "{report}");
        let ripple = axis.speed_ripple_max_percent.unwrap_or(0.0);
        assert!(
            ripple <= 1.02 * axis.speed_ripple_theory_percent,
            "{ripple} {}",
            axis.speed_ripple_theory_percent
        );
    }
}

#[test]
fn foreign_capture_gets_one_origin_for_all_axes() {
    let machine = Machine::there_and_back(3);
    let mut train = machine.train();
    for change in &mut train {
        change.ps += 7_000_000_000_123;
    }
    let report = machine.check(&train, Origin::Midpoint);
    assert!(report.passed(), "{report}");
    let offset = report.origin_ps - (ORIGIN_PS + 7_000_000_000_123);
    assert!((-31_300..=-31_000).contains(&offset), "{offset}");

    // An axis that is late is not hidden by an offset of its own.
    for change in train.iter_mut().filter(|change| change.axis == 1) {
        change.ps += 500_000;
    }
    let report = machine.check(&sorted(train), Origin::Midpoint);
    assert!(!report.passed(), "{report}");
    let fixed = machine.check(&machine.train(), Origin::Fixed { ps: ORIGIN_PS + 1_000_000 });
    assert!(!fixed.passed(), "{fixed}");
}

#[test]
fn slack_widens_the_bounds_and_is_reported() {
    let machine = Machine::there_and_back(2);
    let sample = 100_000;
    let train: Vec<PinChange> = machine
        .train()
        .into_iter()
        .map(|c| PinChange { ps: c.ps.next_multiple_of(sample), ..c })
        .collect();
    assert!(!machine.check(&train, KNOWN).passed());
    let setup = Setup { slack_ps: sample, ..machine.setup(KNOWN) };
    let report = machine.check_setup(&train, setup);
    assert!(report.passed(), "{report}");
    assert_eq!(report.slack_ns, 100.0);
    assert!(report.to_string().contains("good to 100 ns"));
}

#[test]
fn dropped_pulse_is_named() {
    for k in [1, 2, 500, 999, 1000, 1001, 1999, 2000] {
        let found = failures(|train| {
            let rise = rise(train, 0, k);
            let fall = fall(train, rise);
            train.remove(fall);
            train.remove(rise);
        });
        names(&found, &format!("axis x: pulse {k} is missing, due at "));
        names(&found, "axis x: 1999 pulses, 2000 expected");
        names(&found, "axis x: final position");
        assert_eq!(found.len(), 3, "{found:#?}");
    }
}

#[test]
fn doubled_pulse_is_named() {
    for k in [1, 2, 500, 999, 1000, 1001, 1999, 2000] {
        let found = failures(|train| {
            let rise = rise(train, 0, k);
            let fall = fall(train, rise);
            let again =
                [rise, fall].map(|at| PinChange { ps: train[at].ps + 3_000_000, ..train[at] });
            train.extend(again);
        });
        names(&found, "axis x: one pulse too many at ");
        names(&found, &format!("after pulse {k}"));
        names(&found, "axis x: 2001 pulses, 2000 expected");
        names(&found, "axis x: final position");
        assert_eq!(found.len(), 3, "{found:#?}");
    }
}

#[test]
fn pulse_late_or_early_by_two_phases_is_named() {
    let found = failures(|train| {
        let rise = rise(train, 0, 321);
        train[rise].ps += 125_000;
    });
    names(&found, "axis x: pulse 321 at ");
    names(&found, " ns late, the bound is ");
    let found = failures(|train| {
        let rise = rise(train, 0, 321);
        train[rise].ps -= 125_000;
    });
    names(&found, " ns early, the bound is ");
}

#[test]
fn short_direction_set_up_and_hold_are_named() {
    let found = failures(|train| {
        let (dir_change, rise) = (dir_change(train, 0, 1), rise(train, 0, 1001));
        train[dir_change].ps = train[rise].ps - 199_000;
    });
    assert_eq!(found.len(), 1, "{found:#?}");
    names(&found, "axis x: DIR set-up of 199.0 ns at pulse 1001 (");
    names(&found, "the driver needs 200 ns");
    let found = failures(|train| {
        let (dir_change, rise) = (dir_change(train, 0, 1), rise(train, 0, 1000));
        train[dir_change].ps = train[rise].ps + 150_000;
    });
    assert_eq!(found.len(), 1, "{found:#?}");
    names(&found, "axis x: DIR hold of 150.0 ns at pulse 1000 (");
}

#[test]
fn narrow_pulse_and_short_gap_are_named() {
    let found = failures(|train| {
        let rise = rise(train, 0, 700);
        let fall = fall(train, rise);
        train[fall].ps = train[rise].ps + 999_999;
    });
    names(&found, "axis x: STEP high of 1000.0 ns at pulse 700 (");
    let found = failures(|train| {
        let (rise, next) = (rise(train, 0, 700), rise(train, 0, 701));
        let fall = fall(train, rise);
        train[fall].ps = train[next].ps - 900_000;
    });
    names(&found, "axis x: STEP low of 900.0 ns at pulse 701 (");
}

#[test]
fn step_left_high_at_the_end_is_named() {
    let found = failures(|train| {
        let rise = rise(train, 0, 2000);
        let fall = fall(train, rise);
        train.remove(fall);
    });
    names(&found, "axis x: STEP is still high when the capture ends");
}

#[test]
fn pulse_that_is_high_at_the_start_is_named() {
    let machine = Machine::there_and_back(1);
    let make = |sink: &mut dyn PinSink| {
        sink.initial(PinChange { ps: 0, axis: 0, pin: Pin::Step, level: true }).unwrap();
        sink.change(PinChange { ps: 10, axis: 0, pin: Pin::Step, level: false }).unwrap();
        play(&machine.train(), sink);
    };
    let mut checker = Checker::new(machine.setup(KNOWN));
    make(&mut checker);
    let report = checker.finish();
    let ((), beside) = check_beside(machine.setup(KNOWN), make);
    assert_eq!(report, beside);
    let found: Vec<&str> = report.failures().collect();
    assert_eq!(found, ["axis x: STEP is high when the capture begins"]);
}

/// [`Machine::check_setup`] compares the line in the thread that has it with that of the checker.
#[test]
fn axes_are_compared_with_their_line() {
    let machine = Machine::there_and_back(3);
    let steps = vec![1000, -500, 333];
    let out = Course { steps, line_speed: Some(8.0) };
    let setup = Setup { courses: Some(vec![out].into()), ..machine.setup(KNOWN) };
    let train = machine.train();
    let correct = machine.check_setup(&train, setup.clone());
    assert!(correct.passed, "{correct}");
    assert!(correct.axes.iter().all(|axis| axis.line_off_max_steps.is_some()));
    // Axis y is 2 ms late.
    let late = |mut change: PinChange| {
        change.ps += if change.axis == 1 { 2_000_000_000 } else { 0 };
        change
    };
    let found = machine.check_setup(&sorted(train.into_iter().map(late).collect()), setup);
    let off = found.failures().filter(|failure| failure.contains("steps off its line"));
    assert_eq!(off.count(), 3, "{found}");
}

#[test]
fn wrong_direction_is_named() {
    let found = failures(|train| {
        // DIR never changes, so that the way back goes forward.
        let dir_change = dir_change(train, 0, 1);
        train.remove(dir_change);
    });
    names(&found, "axis x: pulse 1001 at ");
    names(&found, "goes forward, the profile backward");
    names(&found, "axis x: final position 2000, 0 expected");
}

#[test]
fn number_of_failure_messages_is_bounded() {
    let machine = Machine::there_and_back(1);
    let nothing = &machine.check(&[], KNOWN).axes[0];
    assert_eq!(nothing.pulses_found, 0);
    assert_eq!(nothing.error_rms_ns, None);
    let wanted = [
        "axis x: 0 pulses, 2000 expected",
        "axis x: pulse 1 and all behind it are missing, due from ",
    ];
    assert_eq!(nothing.failures.len(), 2);
    assert!(
        nothing.failures.iter().zip(wanted).all(|(found, wanted)| found.starts_with(wanted)),
        "{nothing:#?}"
    );

    let mut train = machine.train();
    train.retain(|change| change.pin == Pin::Step);
    let forward = &machine.check(&train, KNOWN).axes[0];
    assert_eq!(forward.pulses_wrong_direction, 1000);
    assert_eq!((forward.failures.len(), forward.failures_omitted), (9, 992));
}

#[test]
fn report_is_printed_as_a_table() {
    let machine = Machine::there_and_back(2);
    let text = machine.check(&machine.train(), KNOWN).to_string();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("axis     pulses  position"), "{text}");
    assert!(lines[1].starts_with("x     2000/2000       0/0"), "{text}");
    assert!(lines[1].ends_with("  ok"), "{text}");
}

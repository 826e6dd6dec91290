//! The checker accepts the pulses of planned programs and notices planted bugs in them. The pulses
//! come from the rows by an accumulator of the tests, not by the models.

use crate::common::{check, job, planned, program_on, pulses};
use carrystep_check::{Pin, PinChange};
use carrystep_program::ProgramFile;

/// A program on the machine of `sim/jobs/`.
fn program(text: &str) -> (tempfile::TempDir, ProgramFile) {
    program_on(&job("machine.toml"), text)
}

#[test]
fn pulses_of_planned_programs_pass() {
    for name in ["square_and_arc.ngc", "chords_and_star.ngc"] {
        let (_folder, file) = program(&job(name));
        let (survey, rows) = planned(&file);
        assert!(survey.landed());
        let report = check(&file, &survey, &pulses(&rows), None);
        assert!(report.passed, "{name}: {:?}", report.failures);
        assert!(report.deviation_mm > 0.005, "the tolerance is used: {report:?}");
    }
}

/// The report of the square and the arc with changed pulses.
#[track_caller]
fn caught(bug: impl FnOnce(&mut Vec<PinChange>), says: &str) {
    let (_folder, file) = program(&job("square_and_arc.ngc"));
    let (survey, rows) = planned(&file);
    let mut changes = pulses(&rows);
    bug(&mut changes);
    let report = check(&file, &survey, &changes, None);
    assert!(!report.passed, "not caught: {report:?}");
    assert!(report.failures.iter().any(|one| one.contains(says)), "{:?}", report.failures);
}

/// Places of the rising edges of an axis in a list of changes.
fn rises(changes: &[PinChange], axis: u8) -> Vec<usize> {
    let rises = |change: &PinChange| change.axis == axis && change.pin == Pin::Step && change.level;
    (0..changes.len()).filter(|&at| rises(&changes[at])).collect()
}

#[test]
fn pulse_that_is_missing_is_caught() {
    let bug = |changes: &mut Vec<PinChange>| {
        let middle = rises(changes, 0)[700];
        changes.remove(middle);
    };
    caught(bug, "axis x: the pulses end at");
}

#[test]
fn pulse_too_many_is_caught() {
    let bug = |changes: &mut Vec<PinChange>| {
        let at = rises(changes, 1)[300];
        let PinChange { ps, .. } = changes[at];
        let new = |ps, level| PinChange { ps, axis: 1, pin: Pin::Step, level };
        changes.splice(at..at, [new(ps - 3_000_000, true), new(ps - 2_900_000, false)]);
        changes.sort_by_key(|change| change.ps);
    };
    caught(bug, "axis y: the pulses end at");
}

#[test]
fn wrong_direction_is_caught_although_the_count_of_pulses_is_right() {
    let bug = |changes: &mut Vec<PinChange>| {
        let dirs = |change: &PinChange| change.axis == 0 && change.pin == Pin::Dir;
        let at = changes.iter().position(dirs).unwrap();
        changes.remove(at);
    };
    caught(bug, "the tool leaves the path");
}

#[test]
fn axis_that_is_late_is_caught_although_its_counts_are_right() {
    let bug = |changes: &mut Vec<PinChange>| {
        let late = |change: &mut PinChange| {
            change.ps += if change.axis == 1 { 5_000_000_000 } else { 0 };
        };
        changes.iter_mut().for_each(late);
        changes.sort_by_key(|change| change.ps);
    };
    caught(bug, "the tool leaves the path");
}

#[test]
fn pulses_after_the_end_are_caught() {
    let bug = |changes: &mut Vec<PinChange>| {
        changes.iter_mut().for_each(|change| change.ps += 30_000_000_000);
    };
    caught(bug, "there are pulses from");
}

#[test]
fn end_that_is_left_out_is_caught() {
    let bug = |changes: &mut Vec<PinChange>| changes.truncate(changes.len() * 9 / 10);
    caught(bug, "the pulses end before the path does");
}

#[test]
fn short_pulse_is_caught() {
    let bug = |changes: &mut Vec<PinChange>| {
        let rise = rises(changes, 0)[10];
        let fall = |change: &PinChange| change.axis == 0 && change.pin == Pin::Step;
        let at = (rise + 1..changes.len()).find(|&at| fall(&changes[at])).unwrap();
        changes[at].ps -= 60_000;
        changes.sort_by_key(|change| change.ps);
    };
    caught(bug, "axis x: STEP is high for 40 ns, 100 ns are required");
}

#[test]
fn pulses_of_another_program_are_caught() {
    let (_folder, file) = program(&job("square_and_arc.ngc"));
    let (survey, _) = planned(&file);
    let changed = job("square_and_arc.ngc").replace("G3 X0 Y0 I-20 J0", "G2 X0 Y0 I-20 J0");
    let (_other_folder, other) = program(&changed);
    let (_, rows) = planned(&other);
    let report = check(&file, &survey, &pulses(&rows), None);
    assert!(report.failures[0].contains("the tool leaves the path"), "{:?}", report.failures);
    // The arcs of lines 9 and 10 meet where the two programs part.
    assert!(report.failures[0].contains("near line 9:"), "{:?}", report.failures);
}

//! The checker accepts the pulses of planned programs and notices planted bugs in them. The pulses
//! come from the rows by an accumulator that is written here, not by the models.

#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches test functions only")]

use carrystep_check::{PathAxis, PathChecker, PathReport, PathSetup, Pin, PinChange, PinSink};
use carrystep_files::Machine;
use carrystep_job::Row;
use carrystep_program::{Legs, ProgramError, ProgramFile, Settings, Survey};
use std::path::Path;

const TICK_PS: u64 = 1_000_000;
/// The first tick begins this late, so that DIR has its set-up time before.
const ORIGIN_PS: u64 = 10_000_000;

fn program(text: &str) -> (tempfile::TempDir, ProgramFile) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("job.ngc");
    std::fs::write(&path, text).unwrap();
    let machine = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/jobs/machine.toml");
    let file =
        ProgramFile::open(&path, Machine::load(&machine).unwrap(), &machine, Settings::default());
    (folder, file.unwrap())
}

fn job(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/jobs");
    std::fs::read_to_string(folder.join(name)).unwrap()
}

/// The pulses of rows: P starts in the middle of a step, and a carry in tick n is a pulse in it.
fn pulses(rows: &[Row]) -> Vec<PinChange> {
    let mut changes = Vec::new();
    for axis in 0..rows.first().map_or(0, |row| row.segments.len()) {
        let (mut p, mut tick, mut dir) = (1_u64 << 63, 0, false);
        let mut change =
            |ps, pin, level| changes.push(PinChange { ps, axis: axis as u8, pin, level });
        for row in rows {
            let segment = row.segments[axis];
            let (mut v, mut a) = (segment.v, segment.a);
            for _ in 0..row.ticks {
                let (next, carry) = p.overflowing_add(v as u64);
                if carry != (v < 0) {
                    let ps = ORIGIN_PS + tick * TICK_PS + TICK_PS / 2;
                    if dir != (v < 0) {
                        dir = v < 0;
                        change(ps - TICK_PS / 4, Pin::Dir, dir);
                    }
                    change(ps, Pin::Step, true);
                    change(ps + 100_000, Pin::Step, false);
                }
                p = next;
                v = v.wrapping_add(a);
                a = a.wrapping_add(segment.j);
                tick += 1;
            }
        }
    }
    changes.sort_by_key(|change| change.ps);
    changes
}

fn check(file: &ProgramFile, survey: &Survey, changes: &[PinChange]) -> PathReport {
    let axes = file.machine().axes.iter().zip(file.letters().of_axes()).zip(&survey.axes);
    let axes = axes.map(|((axis, &letter), planned)| PathAxis {
        name: &axis.name,
        letter,
        step: file.letters().step()[letter],
        start_steps: planned.start_steps,
        steps: planned.steps(),
        pins_ns: axis.pins_ns,
    });
    let setup = PathSetup {
        axes: axes.collect(),
        start: file.settings().start,
        origin_ps: ORIGIN_PS,
        total_ps: survey.ticks * TICK_PS,
        slack_ps: 0,
    };
    let legs = Legs::new(file).unwrap().map(Result::unwrap);
    let mut checker = PathChecker::new(setup, Box::new(legs));
    checker.changes(changes).unwrap();
    checker.finish()
}

fn planned(file: &ProgramFile) -> (Survey, Vec<Row>) {
    let mut rows = Vec::new();
    let survey = Survey::new(file, |row| {
        rows.push(row.clone());
        Ok::<(), ProgramError>(())
    });
    (survey.unwrap(), rows)
}

#[test]
fn pulses_of_planned_programs_pass() {
    for name in ["square_and_arc.ngc", "chords_and_star.ngc"] {
        let (_folder, file) = program(&job(name));
        let (survey, rows) = planned(&file);
        assert!(survey.landed());
        let report = check(&file, &survey, &pulses(&rows));
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
    let report = check(&file, &survey, &changes);
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
    let report = check(&file, &survey, &pulses(&rows));
    assert!(report.failures[0].contains("the tool leaves the path"), "{:?}", report.failures);
    // The arcs of lines 9 and 10 meet where the two programs part.
    assert!(report.failures[0].contains("near line 9:"), "{:?}", report.failures);
}

//! Programs, their plans, and the pins that the plans make by an accumulator that is written here,
//! not by the models.

use carrystep_check::{PathAxis, PathChecker, PathReport, PathSetup, Pin, PinChange, PinSink};
use carrystep_files::{Machine, SourceText};
use carrystep_job::Row;
use carrystep_program::{Legs, Marks, ProgramError, ProgramFile, RowOutputs, Settings, Survey};
use std::path::Path;

const TICK_PS: u64 = 1_000_000;
/// The first tick begins this late, so that DIR has its set-up time before.
pub const ORIGIN_PS: u64 = 10_000_000;

/// A file of `sim/jobs/`.
pub fn job(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/jobs");
    std::fs::read_to_string(folder.join(name)).unwrap()
}

/// A program on a machine.
pub fn program_on(machine: &str, text: &str) -> (tempfile::TempDir, ProgramFile) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("job.ngc");
    std::fs::write(&path, text).unwrap();
    let source = SourceText { path: "m.toml".into(), text: machine.into() };
    let machine = Machine::from_source(&source).unwrap();
    let file = ProgramFile::open(&path, machine, Path::new("m.toml"), Settings::default());
    (folder, file.unwrap())
}

/// The survey of a program and its rows.
pub fn planned(file: &ProgramFile) -> (Survey, Vec<Row>) {
    let mut rows = Vec::new();
    let survey = Survey::new(file, |row| {
        rows.push(row.clone());
        Ok::<(), ProgramError>(())
    });
    (survey.unwrap(), rows)
}

/// The pulses of rows: P starts in the middle of a step, and a carry in tick n is a pulse in it.
pub fn pulses(rows: &[Row]) -> Vec<PinChange> {
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

/// The output pins of rows: the levels from a time on.
pub fn levels(rows: &[Row]) -> Vec<(u64, u8)> {
    let (mut now, mut tick, mut found) = (0, 0, Vec::new());
    let mut outputs = RowOutputs::default();
    for row in rows {
        let change = outputs.change(row);
        let next = (now & !change.mask) | (change.levels & change.mask);
        if std::mem::replace(&mut now, next) != next {
            found.push((ORIGIN_PS + tick * TICK_PS, next));
        }
        tick += u64::from(row.ticks);
    }
    found
}

/// The check of these pins against the program. Without levels, outputs are not checked.
pub fn check(
    file: &ProgramFile,
    survey: &Survey,
    changes: &[PinChange],
    levels: Option<&[(u64, u8)]>,
) -> PathReport {
    let letters = file.letters().of_axes().iter().zip(file.letters().moves());
    let axes = file.machine().axes.iter().zip(letters).zip(&survey.axes);
    let axes = axes.map(|((axis, (&letter, &moves)), planned)| PathAxis {
        name: &axis.name,
        letter,
        moves,
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
    if levels.is_some() {
        let marks = Marks::new(file).unwrap().map(Result::unwrap);
        checker = checker.with_outputs(Box::new(marks), file.machine().outputs.exist);
    }
    let mut pending = levels.unwrap_or_default().iter().peekable();
    for change in changes {
        while let Some((ps, levels)) = pending.next_if(|(ps, _)| *ps <= change.ps) {
            checker.outputs(*ps, *levels).unwrap();
        }
        checker.change(*change).unwrap();
    }
    for (ps, levels) in pending {
        checker.outputs(*ps, *levels).unwrap();
    }
    checker.end(ORIGIN_PS + survey.ticks * TICK_PS).unwrap();
    checker.finish()
}

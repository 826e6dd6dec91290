//! The engine produces the pulses of six parallel axes: the same edges in the same clocks after the
//! start, on random joint moves in which all axes reverse and change segment in the same tick.

use carrystep_core::engine::QUEUE_DEPTHS;
use carrystep_core::{
    AXES, Build, Command, EngineBuild, PinTiming, Program, Segment, StartPhase, Timebase,
};
use carrystep_simulators::Level;
use carrystep_simulators::engine::Events;
use carrystep_simulators::engine::replay::Recording;
use carrystep_tests::{effort, lockstep};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

/// One row of segments: its ticks, and V, A and J of each axis.
type Row = (u32, Vec<(i64, i64, i64)>);

fn rows() -> impl Strategy<Value = Vec<Row>> {
    let change = |bits: u32| prop_oneof![Just(0), -(1_i64 << bits)..(1 << bits)];
    let axis = (-(1_i64 << 61)..(1 << 61), change(50), change(40));
    let ticks = prop_oneof![Just(1_u32), 1_u32..8, 8_u32..200];
    prop::collection::vec((ticks, prop::collection::vec(axis, AXES)), 1..=QUEUE_DEPTHS[0])
}

/// A program whose start comes after the first row (the parallel axes hold one waiting segment) or
/// after all rows (the engine's host is slow).
fn program(rows: &[Row], start_after: usize) -> Program {
    let mut program = Program::new();
    for (place, (ticks, axes)) in rows.iter().enumerate() {
        for (axis, &(v, a, j)) in (0..).zip(axes) {
            let segment = Segment { ticks: *ticks, v, a, j, last: place + 1 == rows.len() };
            program.push(Command::Segment { axis, segment });
        }
        if place + 1 == start_after {
            program.push(Command::Start { mask: 0x3f });
        }
    }
    program
}

/// STEP and DIR in each clock after the start in which one of them changed.
fn changes(pins: impl Iterator<Item = (u64, u8, u8)>, start: u64) -> Vec<(u64, u8, u8)> {
    let mut changes: Vec<(u64, u8, u8)> = Vec::new();
    for (cycle, step, dir) in pins.filter(|(cycle, ..)| *cycle >= start) {
        if changes.last().is_none_or(|&(_, s, d)| (s, d) != (step, dir)) {
            changes.push((cycle - start, step, dir));
        }
    }
    changes
}

#[test]
fn engine_pulses_equal_those_of_the_parallel_axes() {
    let timebase = Timebase::new(80_000_000, 1000, 16).expect("a fine timebase");
    let pins = [PinTiming { step_high: 9, step_low: 7, dir_setup: 20, dir_hold: 11 }; AXES];
    let build = Build { timebase, phase: StartPhase::Half, pins };
    let engine = EngineBuild::minimal(&build, 1 << 40);
    let mut runner =
        TestRunner::new(Config { cases: 150, failure_persistence: None, ..Config::default() });
    let compared = std::cell::Cell::new(0);
    let held = runner.run(&rows(), |rows| {
        let parallel = program(&rows, 1);
        let record =
            lockstep::record(Level::Model, &lockstep::job(&build, &parallel)).expect("the model");
        let recording =
            Recording::new(&engine, &program(&rows, rows.len()), &Events::new(), 500_000);
        let started = recording
            .outputs
            .iter()
            .find(|(_, outputs)| outputs.started)
            .map(|(cycle, _)| cycle + 1);
        let origin = record.outcome.as_ref().and_then(|outcome| outcome.origin);
        let (Some(started), Some(origin)) = (started, origin) else { return Ok(()) };
        let expected =
            changes(record.changes.iter().map(|(cycle, out)| (*cycle, out.step, out.dir)), origin);
        let found = changes(
            recording.outputs.iter().map(|(cycle, out)| (*cycle, out.step, out.dir)),
            started,
        );
        // Moves that end in a fault are excluded, because the two cores stop differently.
        let sound = !record.changes.iter().any(|(_, out)| out.faults.any());
        if sound {
            prop_assert_eq!(&found[1..], &expected[1..]);
            compared.set(compared.get() + expected.len());
        }
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
    effort::say(&format!("{} changes of the pins", compared.get()));
    assert!(compared.get() > 10_000, "{} changes are no comparison", compared.get());
}

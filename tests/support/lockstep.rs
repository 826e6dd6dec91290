//! Compares two levels on the same program, every output in every clock.

use crate::golden::Edge;
use crate::programs;
use carrystep_core::engine::EngineOutputs;
use carrystep_core::ports::Outputs;
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, Program, StartPhase, Timebase};
use carrystep_plan::Plan;
use carrystep_simulators::engine::run::{EngineJob, EngineOutcome};
use carrystep_simulators::{Job, Level, LevelError, Outcome, run};
use carrystep_tools::kept;
use carrystep_tools::programs::{ICARUS, VERILATOR};
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;

/// All outputs in each cycle in which any of them changed, and the end of the run. A host can block
/// itself for ever (with a start that can never happen); then there is no end.
#[derive(Debug, PartialEq, Hash)]
pub struct Record {
    /// Cycle and outputs of each change.
    pub changes: Vec<(u64, Outputs)>,
    /// The end, if it came before the job's last clock.
    pub outcome: Option<Outcome>,
}

/// Runs a job at a level and records all changes.
pub fn record(level: Level, job: &Job<'_>) -> Result<Record, LevelError> {
    let mut changes = Vec::new();
    let outcome = match run(level, job, &mut |cycle, outputs| changes.push((cycle, *outputs))) {
        Err(LevelError::Endless(_)) => None,
        other => Some(other?),
    };
    Ok(Record { changes, outcome })
}

/// The first difference between two records, or `None` if they are equal.
pub fn difference(expected: &Record, found: &Record) -> Option<String> {
    let pairs = expected.changes.iter().zip(&found.changes);
    if let Some((e, f)) = pairs.into_iter().find(|(e, f)| e != f) {
        let cycle = e.0.min(f.0);
        return Some(format!(
            "first difference in cycle {cycle}:\n expected {e:?}\n found    {f:?}"
        ));
    }
    if expected.changes.len() != found.changes.len() {
        return Some(format!(
            "{} changes expected, {} found",
            expected.changes.len(),
            found.changes.len()
        ));
    }
    (expected.outcome != found.outcome)
        .then(|| format!("{:?} expected, {:?} found", expected.outcome, found.outcome))
}

/// Panics at the first clock in which a level differs from the clock-by-clock model or from the
/// fast model. Returns the record, which is that of all of them.
pub fn assert_equals_model(level: Level, job: &Job<'_>) -> Record {
    let expected = record(Level::Model, job).expect("the model");
    for level in [Level::Fast, level] {
        let found = difference_of_level(level, job, &expected);
        if let Some(difference) = found.unwrap_or_else(|error| panic!("{level}: {error}")) {
            panic!("{level} is not the model: {difference}\n program {:?}", job.program);
        }
    }
    expected
}

/// The first difference of a level from a record. An external simulation is not repeated if its
/// output is known from an earlier run, see [`kept::difference`].
fn difference_of_level(
    level: Level,
    job: &Job<'_>,
    expected: &Record,
) -> Result<Option<String>, LevelError> {
    let run = || Ok(difference(expected, &record(level, job)?));
    let tool = match level {
        Level::Icarus => ICARUS,
        Level::Verilator => VERILATOR,
        Level::Fast | Level::Model | Level::RustHdl => return run(),
    };
    kept::difference(&tool, job.question(level)?, expected, run)
}

/// Panics at the first clock in which a level of the parallel core of this many axes differs from
/// its models, in this number of random programs. They also name axes that the core does not have.
pub fn assert_random_programs_equal_model(level: Level, axes: usize, phases: u32, cases: u32) {
    let build = tight_build(phases, StartPhase::Half);
    let mut runner = TestRunner::new(Config { cases, max_shrink_iters: 100, ..Config::default() });
    let refused = Cell::new(0);
    let held = runner.run(&programs::program_with_strangers(axes), |program| {
        let job = Job { axes, ..job(&build, &program) };
        let model = assert_equals_model(level, &job);
        refused.set(
            refused.get()
                + u32::from(model.changes.iter().any(|(_, outputs)| outputs.faults.protocol)),
        );
        Ok(())
    });
    held.unwrap_or_else(|error| panic!("{error}"));
    let refused = refused.get();
    assert!(refused > cases / 4, "only {refused} programs broke the protocol");
    kept::say();
}

/// All outputs of a planned engine but those that the fast level does not tell (the `ready`s and
/// `room`), in each cycle in which one of them changed, and how it ended.
fn engine_record(
    level: Level,
    build: &EngineBuild,
    (program, ticks): (&Program, u64),
) -> (Vec<(u64, EngineOutputs)>, EngineOutcome) {
    let mut changes: Vec<(u64, EngineOutputs)> = Vec::new();
    let outcome = EngineJob::new(build, program, ticks).run(level, &mut |cycle, outputs| {
        let told = EngineOutputs { put_ready: false, start_ready: false, ready: false, ..*outputs };
        let told = EngineOutputs { room: None, ..told };
        if changes.last().is_none_or(|(_, before)| *before != told) {
            changes.push((cycle, told));
        }
    });
    (changes, outcome.unwrap_or_else(|error| panic!("{level}: {error}")))
}

/// Panics at the first clock in which a level of the engine differs from its model on planned
/// moves. Verilog is compared with it in every output where it runs.
pub fn assert_engine_equals_model(level: Level, (build, plan): &(EngineBuild, Plan)) {
    let axes = plan.moves.iter().flat_map(|planned| &planned.axes);
    let steps = axes.map(|axis| axis.steps.unsigned_abs()).sum();
    assert_engine_runs(level, build, (&plan.program(), plan.total_ticks()), steps);
}

/// The same for a program of so many ticks that makes so many steps.
pub fn assert_engine_runs(level: Level, build: &EngineBuild, program: (&Program, u64), steps: u64) {
    let (expected, ended) = engine_record(Level::Model, build, program);
    let (found, found_ended) = engine_record(level, build, program);
    if let Some((e, f)) = expected.iter().zip(&found).find(|(e, f)| e != f) {
        panic!("{level} is not the model:\n expected {e:?}\n found    {f:?}");
    }
    assert_eq!(
        (expected.len(), &ended),
        (found.len(), &found_ended),
        "{level}: changes, and the end"
    );
    let rising = expected
        .windows(2)
        .map(|pair| u64::from((pair[1].1.step & !pair[0].1.step).count_ones()))
        .sum::<u64>();
    assert_eq!((rising, ended.fault), (steps, None), "{level}: edges, and no stop");
    kept::say();
}

/// A job for a random program: time for whatever the generators make.
pub fn job<'a>(build: &'a Build, program: &'a Program) -> Job<'a> {
    Job { max_clocks: 50_000, ..Job::new(build, program, 0) }
}

/// The edges of a golden case as they appear on the pins of the axis that ran it.
pub fn edges_on_the_pins(build: &Build, record: &Record, axis: usize) -> Vec<Edge> {
    let time = &build.timebase;
    let outcome = record.outcome.as_ref().expect("the run ended");
    let zero = outcome.origin.expect("the program started") + time.latency_clocks();
    let (tick, phase) = (u64::from(time.clocks_per_tick()), u64::from(time.clocks_per_phase()));
    let mut before = false;
    let mut edges = Vec::new();
    for (cycle, outputs) in &record.changes {
        let step = outputs.step >> axis & 1 == 1;
        if step && !before {
            let since = cycle - zero;
            assert_eq!(since % tick % phase, 0, "an edge off its phase");
            let backward = outputs.dir >> axis & 1 == 1;
            edges.push((
                since / tick + 1,
                (since % tick / phase) as u32,
                if backward { -1 } else { 1 },
            ));
        }
        before = step;
    }
    edges
}

/// A build for random programs with the fewest clocks per tick. The axes have very different pin
/// timings, so that overruns and waits for set-up and for hold all occur.
pub fn tight_build(phases: u32, phase: StartPhase) -> Build {
    let pins = |step_high, step_low, dir_setup, dir_hold| PinTiming {
        step_high,
        step_low,
        dir_setup,
        dir_hold,
    };
    let pins: [PinTiming; AXES] = [
        PinTiming::SHORTEST,
        pins(2, 3, 1, 1),
        pins(8, 8, 20, 1),
        pins(1, 37, 3, 40),
        pins(19, 1, 1, 2),
        pins(5, 5, 33, 21),
    ];
    Build { pins, ..quick_build(phases, phase) }
}

/// A build with the fewest clocks per tick and pin timings that delay nothing.
pub fn quick_build(phases: u32, phase: StartPhase) -> Build {
    let timebase = Timebase::new(16_000_000, 1000, phases).expect("a fine timebase");
    Build { timebase, phase, pins: [PinTiming::SHORTEST; AXES] }
}

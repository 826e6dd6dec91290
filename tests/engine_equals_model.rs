//! The engine is its model, every output in every clock, and its memory keeps what the model knows: in Rust-HDL's
//! simulation, in Icarus and in Verilator.

use carrystep_hdl::EngineSim;
use carrystep_levels::Level;
use carrystep_levels::engine::{EngineCore, EngineHost};
use carrystep_levels::replay::{self, Recording};
use carrystep_model::Engine;
use carrystep_spec::engine::{EngineInputs, QUEUE};
use carrystep_spec::{AXES, Build, Command, PinTiming, Program, Segment, StartPhase, Timebase};
use carrystep_tests::golden::{self, Case, Edge};
use carrystep_tests::{effort, engine_programs, lockstep};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;

/// The fewest clocks that hold the turns; pins as different as in the other rungs, two of them too slow for
/// a step in every other tick.
fn build(clock_hz: u64, phases: u32, phase: StartPhase) -> Build {
    let timebase = Timebase::new(clock_hz, 1000, phases).expect("a fine timebase");
    let mut build = Build { timebase, ..lockstep::tight_build(phases, phase) };
    build.pins[3].gap = 237;
    build.pins[5].hold = 221;
    build
}

/// Runs both until the program is over and both are quiet; the clocks it took.
fn assert_equal(build: &Build, program: &Program) -> Result<u64, TestCaseError> {
    let mut model = Engine::new(build);
    let mut engine = EngineSim::new(build).expect("a fine build");
    let mut host = EngineHost::new(program);
    let mut fault = false;
    let mut quiet = 0;
    for cycle in 0..200_000_u64 {
        let mut inputs = host.inputs(fault);
        let mut expected = EngineCore::outputs(&mut model, &inputs);
        if expected.fault != fault {
            fault = expected.fault;
            inputs = host.inputs(fault);
            expected = EngineCore::outputs(&mut model, &inputs);
        }
        let found = engine.settle(&inputs);
        prop_assert_eq!(
            expected,
            found,
            "cycle {}, tick {}",
            cycle,
            cycle / u64::from(build.timebase.clocks_per_tick())
        );
        host.advance(&expected);
        quiet = if host.is_done() && (expected.idle || expected.fault) { quiet + 1 } else { 0 };
        if quiet > 12 * build.timebase.clocks_per_tick() {
            assert_kept(&model, &engine)?;
            return Ok(cycle);
        }
        EngineCore::clock(&mut model, &inputs);
        EngineCore::clock(&mut engine, &inputs);
    }
    Ok(200_000)
}

/// P, positions and discarded steps, when nothing moves.
fn assert_kept(model: &Engine, engine: &EngineSim) -> Result<(), TestCaseError> {
    for axis in 0..AXES {
        let shaper = model.shaper(axis);
        let p = u64::from(engine.kept(axis, 1)) << 32 | u64::from(engine.kept(axis, 0));
        prop_assert_eq!(model.fraction(axis), p, "P of axis {}", axis);
        prop_assert_eq!(shaper.position, engine.kept(axis, 2).cast_signed(), "position of axis {}", axis);
        prop_assert_eq!(shaper.discarded, engine.kept(axis, 3), "discarded steps of axis {}", axis);
    }
    Ok(())
}

/// Runs random programs until they have taken so many clocks.
fn run_programs(build: &Build, usual: u64, one: impl Fn(&Program) -> Result<u64, TestCaseError>) {
    let (clocks, enough) = (Cell::new(0), effort::clocks(usual));
    let config = Config { cases: 10, max_shrink_iters: 400, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new(config);
    while clocks.get() < enough {
        let held = runner.run(&engine_programs::program(), |program| {
            clocks.set(clocks.get() + one(&program)?);
            Ok(())
        });
        held.unwrap_or_else(|error| panic!("{error}\n of {build:?}"));
    }
    effort::say(&format!("{} clocks", clocks.get()));
}

fn in_rust_hdl(build: &Build, usual: u64) {
    run_programs(build, usual, |program| assert_equal(build, program));
}

#[test]
fn random_programs_at_16_phases() {
    in_rust_hdl(&build(80_000_000, 16, StartPhase::Half), 500_000);
}

#[test]
fn random_programs_at_4_phases_with_clocks_to_spare() {
    in_rust_hdl(&build(96_000_000, 4, StartPhase::Zero), 300_000);
}

#[test]
fn random_programs_at_1_phase_in_the_shortest_tick() {
    in_rust_hdl(&build(79_000_000, 1, StartPhase::Half), 300_000);
}

fn in_verilog(level: Level, build: &Build, usual: u64) -> Seen {
    let verilog = carrystep_export::engine_verilog(build, "a test").expect("a fine build");
    let seen = Cell::new(Seen::default());
    run_programs(build, usual, |program| {
        let recording = Recording::new(build, program, 200_000);
        let difference = replay::difference(level, &verilog, &recording).expect("the tools");
        prop_assert!(difference.is_none(), "{}", difference.unwrap_or_default());
        seen.set(seen.get().with(&recording));
        Ok(recording.clocks)
    });
    effort::say(&format!("{:?}", seen.get()));
    seen.get()
}

/// What happened in random programs: lock-step over nothing would prove nothing.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    clocks: u64,
    edges: u64,
    /// Edges of several axes in one clock.
    together: u64,
    overspeed: u64,
    underrun: u64,
    overrun: u64,
    protocol: u64,
    /// Faults of several axes at one strobe.
    faults_together: u64,
    cleared: u64,
}

impl Seen {
    fn with(mut self, recording: &Recording) -> Self {
        self.clocks += recording.clocks;
        for pair in recording.outputs.windows(2) {
            let [(_, before), (_, now)] = pair else { continue };
            let rising = (now.step & !before.step).count_ones();
            self.edges += u64::from(rising);
            self.together += u64::from(rising > 1);
            let (was, is) = (before.faults, now.faults);
            let both = (is.overspeed | is.underrun).count_ones() > 1;
            self.overspeed += u64::from(was.overspeed == 0 && is.overspeed != 0);
            self.underrun += u64::from(was.underrun == 0 && is.underrun != 0);
            self.overrun += u64::from(was.overrun == 0 && is.overrun != 0);
            self.protocol += u64::from(!was.protocol && is.protocol);
            self.faults_together += u64::from(!was.any() && both);
            self.cleared += u64::from(before.fault && !now.fault);
        }
        self
    }

    fn assert_everything(&self) {
        let Self { clocks, edges, together, overspeed, underrun, overrun, protocol, faults_together, cleared } = *self;
        let all = [clocks, edges, together, overspeed, underrun, overrun, protocol, faults_together, cleared];
        assert!(all.iter().all(|count| *count > 0), "random programs miss something: {self:?}");
    }
}

#[test]
fn random_programs_in_verilator() {
    in_verilog(Level::Verilator, &build(80_000_000, 16, StartPhase::Half), 5_000_000).assert_everything();
}

#[test]
fn random_programs_in_verilator_at_4_phases() {
    in_verilog(Level::Verilator, &build(96_000_000, 4, StartPhase::Zero), 3_000_000);
}

#[test]
fn random_programs_in_icarus() {
    in_verilog(Level::Icarus, &build(80_000_000, 16, StartPhase::Zero), 300_000);
}

/// All golden cases of a phase, one an axis; started together, each to its last edge. The short ones in every run.
#[test]
fn golden_vectors_in_verilator() {
    let vectors = golden::engine_vectors();
    for phase in [StartPhase::Zero, StartPhase::Half] {
        let cases: Vec<&Case> = vectors
            .iter()
            .filter(|case| case.phase() == phase && (effort::is_long() || case.total_ticks <= 400_000))
            .collect();
        for cases in cases.chunks(AXES) {
            let build = Build { pins: [PinTiming::SHORTEST; AXES], ..build(80_000_000, 16, phase) };
            let recording = Recording::new(&build, &golden_program(cases), u64::MAX);
            let verilog = carrystep_export::engine_verilog(&build, "a test").expect("a fine build");
            let difference = replay::difference(Level::Verilator, &verilog, &recording).expect("the tools");
            assert_eq!(difference, None);
            for (axis, case) in cases.iter().enumerate() {
                case.assert_edges(&edges(&build, &recording, axis));
                let [low, high, ..] = recording.kept[axis];
                assert_eq!(u64::from(high) << 32 | u64::from(low), case.p_end(), "{}", case.name);
            }
        }
    }
}

/// What fits into the queues, the start, and the rest as the queues have room.
fn golden_program(cases: &[&Case]) -> Program {
    let segments: Vec<Vec<Segment>> = cases.iter().map(|case| case.segments()).collect();
    let part = |rows: std::ops::Range<usize>| {
        let mut part = Program::new();
        for row in rows {
            let lanes = (0..).zip(&segments).filter_map(|(axis, lane)| lane.get(row).map(|segment| (axis, *segment)));
            part.extend(lanes.map(|(axis, segment)| Command::Segment { axis, segment }));
        }
        part
    };
    let start = Command::Start { mask: (1 << cases.len()) - 1 };
    let rows = segments.iter().map(Vec::len).max().unwrap_or(0);
    [part(0..QUEUE), vec![start], part(QUEUE..rows)].concat()
}

/// The edges of an axis: tick, phase and direction.
fn edges(build: &Build, recording: &Recording, axis: usize) -> Vec<Edge> {
    let time = &build.timebase;
    let started = recording.outputs.iter().find(|(_, outputs)| outputs.started).expect("a start").0;
    let zero = started + 1 + time.latency_clocks();
    let (tick, phase) = (u64::from(time.clocks_per_tick()), u64::from(time.clocks_per_phase()));
    let level = |mask: u8| mask >> axis & 1 == 1;
    let mut before = false;
    let mut edges = Vec::new();
    for (cycle, outputs) in &recording.outputs {
        if level(outputs.step) && !before {
            let since = cycle - zero;
            assert_eq!(since % phase, 0, "an edge off its phase");
            edges.push((since / tick + 1, (since % tick / phase) as u32, if level(outputs.dir) { -1 } else { 1 }));
        }
        before = level(outputs.step);
    }
    edges
}

#[test]
fn nothing_happens_to_an_engine_without_a_host() {
    let build = build(80_000_000, 16, StartPhase::Half);
    let mut engine = EngineSim::new(&build).expect("a fine build");
    for _ in 0..1000 {
        let outputs = engine.settle(&EngineInputs::default());
        assert!(outputs.idle && !outputs.fault && outputs.step == 0 && outputs.dir == 0);
        engine.clock();
    }
}

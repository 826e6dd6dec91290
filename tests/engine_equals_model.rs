//! Compares the engine with its model: every output in every clock, and the contents of its memory.
//! The engine runs in Rust-HDL's simulation, in Icarus and in Verilator.

use carrystep_hdl::EngineSim;
use carrystep_levels::Level;
use carrystep_levels::engine::replay::{self, Recording};
use carrystep_levels::engine::{EngineCore, EngineHost, Events};
use carrystep_model::Engine;
use carrystep_spec::engine::{CAUSES, Cause, EngineInputs, Limits, QUEUE};
use carrystep_spec::{AXES, Build, Command, EngineBuild, PinTiming, Program, Segment, StartPhase, Timebase};
use carrystep_tests::engine_programs::build;
use carrystep_tests::golden::{self, Case, Edge};
use carrystep_tests::{effort, engine_programs};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use std::cell::Cell;

/// Runs both until the program is over and both are idle. Returns the number of clocks.
fn assert_equal(build: &EngineBuild, program: &Program, events: &Events) -> Result<u64, TestCaseError> {
    let mut model = Engine::new(build);
    let mut engine = EngineSim::new(build).expect("a fine build");
    let mut host = EngineHost::new(&build.guard, program, events);
    let mut fault = false;
    let mut quiet = 0;
    for cycle in 0..200_000_u64 {
        let mut inputs = host.inputs(fault);
        let mut expected = EngineCore::outputs(&mut model, &inputs);
        if expected.fault.is_some() != fault {
            fault = expected.fault.is_some();
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
        quiet = if host.is_done() && (expected.idle || expected.halted) { quiet + 1 } else { 0 };
        if quiet > 12 * build.timebase.clocks_per_tick() {
            assert_kept(build, &model, &engine)?;
            return Ok(cycle);
        }
        EngineCore::clock(&mut model, &inputs);
        EngineCore::clock(&mut engine, &inputs);
    }
    Ok(200_000)
}

/// Compares P, positions and discarded steps while nothing moves.
fn assert_kept(build: &EngineBuild, model: &Engine, engine: &EngineSim) -> Result<(), TestCaseError> {
    for axis in 0..build.axes() {
        let shaper = model.shaper(axis);
        let p = u64::from(engine.kept(axis, 1)) << 32 | u64::from(engine.kept(axis, 0));
        prop_assert_eq!(model.fraction(axis), p, "P of axis {}", axis);
        prop_assert_eq!(shaper.position, engine.kept(axis, 2).cast_signed(), "position of axis {}", axis);
        prop_assert_eq!(shaper.discarded, engine.kept(axis, 3), "discarded steps of axis {}", axis);
    }
    Ok(())
}

/// Runs random programs until they have taken the required number of clocks.
fn run_programs(build: &EngineBuild, usual: u64, one: impl Fn(&Program, &Events) -> Result<u64, TestCaseError>) {
    let (clocks, enough) = (Cell::new(0), effort::clocks(usual));
    let mut config = Config { cases: 4, max_shrink_time: 20_000, failure_persistence: None, ..Config::default() };
    while clocks.get() < enough {
        // A fixed seed is incremented, so that each round has other programs.
        if let RngSeed::Fixed(seed) = &mut config.rng_seed {
            *seed = seed.wrapping_add(1);
        }
        let held = TestRunner::new(config.clone()).run(&engine_programs::program(build.axes()), |(program, events)| {
            clocks.set(clocks.get() + one(&program, &events)?);
            Ok(())
        });
        held.unwrap_or_else(|error| panic!("{error}\n of {build:?}"));
    }
    effort::figures(&format!("{} clocks, no difference", clocks.get()));
}

fn in_rust_hdl(build: &EngineBuild, usual: u64) {
    run_programs(build, usual, |program, events| assert_equal(build, program, events));
}

#[test]
fn random_programs_at_16_phases() {
    in_rust_hdl(&build(6, 80_000_000, 16, StartPhase::Half, Limits::Pair), 400_000);
}

#[test]
fn random_programs_at_1_phase_in_the_shortest_tick() {
    in_rust_hdl(&build(6, 79_000_000, 1, StartPhase::Half, Limits::One), 200_000);
}

#[test]
fn random_programs_of_eight_axes_at_4_phases_with_clocks_to_spare() {
    in_rust_hdl(&build(8, 120_000_000, 4, StartPhase::Zero, Limits::Each), 200_000);
}

#[test]
fn random_programs_of_eight_axes_at_1_phase_in_the_shortest_tick() {
    in_rust_hdl(&build(8, 105_000_000, 1, StartPhase::Half, Limits::Pair), 200_000);
}

#[test]
fn random_programs_of_one_axis_in_the_shortest_phases() {
    in_rust_hdl(&build(1, 32_000_000, 16, StartPhase::Half, Limits::Pair), 100_000);
}

#[test]
fn random_programs_of_one_axis_in_the_shortest_tick() {
    in_rust_hdl(&build(1, 16_000_000, 4, StartPhase::Zero, Limits::One), 100_000);
}

fn in_verilog(level: Level, build: &EngineBuild, usual: u64) -> Seen {
    let verilog = carrystep_export::engine_verilog(build, "a test").expect("a fine build");
    let seen = Cell::new(Seen::default());
    run_programs(build, usual, |program, events| {
        let recording = Recording::new(build, program, events, 200_000);
        let difference = replay::difference(level, &verilog, &recording).expect("the tools");
        prop_assert!(difference.is_none(), "{}", difference.unwrap_or_default());
        seen.set(seen.get().with(&recording));
        Ok(recording.clocks)
    });
    effort::say(&format!("{:?}", seen.get()));
    seen.get()
}

/// Counts of what happened in random programs, because a lock-step in which nothing happens would
/// prove nothing.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    clocks: u64,
    edges: u64,
    /// Clocks in which several axes have an edge.
    together: u64,
    /// Number of stops by each cause.
    causes: [u64; CAUSES.len()],
    /// Edges after the call of a stop, which belong to ramps.
    ramped: u64,
    cleared: u64,
    /// Axes that found their limit in homing while other axes were still waiting.
    homed: u64,
}

impl Seen {
    fn with(mut self, recording: &Recording) -> Self {
        self.clocks += recording.clocks;
        for pair in recording.outputs.windows(2) {
            let [(_, before), (_, now)] = pair else { continue };
            let rising = (now.step & !before.step).count_ones();
            self.edges += u64::from(rising);
            self.together += u64::from(rising > 1);
            self.homed += u64::from(now.homing != 0 && before.homing & !now.homing != 0);
            match (before.fault, now.fault) {
                (None, Some((cause, _))) => self.causes[cause as usize] += 1,
                (Some((Cause::Stop, _)), Some(_)) => self.ramped += u64::from(rising),
                (Some(_), None) => self.cleared += 1,
                _ => {}
            }
        }
        self
    }

    fn assert_everything(&self) {
        let Self { clocks, edges, together, causes, ramped, cleared, homed } = *self;
        let all = [[clocks, edges, together, ramped, cleared, homed].as_slice(), &causes].concat();
        assert!(all.iter().all(|count| *count > 0), "random programs miss something: {self:?}");
        let stops: u64 = causes.iter().sum();
        effort::figures(&format!("{edges} edges, {stops} stops of all {} causes", CAUSES.len()));
    }
}

#[test]
fn random_programs_in_verilator() {
    let build = build(6, 80_000_000, 16, StartPhase::Half, Limits::Pair);
    in_verilog(Level::Verilator, &build, 7_000_000).assert_everything();
}

#[test]
fn random_programs_of_eight_axes_in_verilator() {
    let build = build(8, 112_000_000, 16, StartPhase::Half, Limits::Each);
    let seen = in_verilog(Level::Verilator, &build, 2_000_000);
    assert!(seen.edges > 0 && seen.together > 0, "too little happens: {seen:?}");
}

#[test]
fn random_programs_of_one_axis_in_verilator() {
    in_verilog(Level::Verilator, &build(1, 32_000_000, 16, StartPhase::Zero, Limits::Pair), 1_000_000);
}

#[test]
fn random_programs_in_icarus() {
    in_verilog(Level::Icarus, &build(6, 96_000_000, 4, StartPhase::Zero, Limits::One), 150_000);
}

#[test]
fn random_programs_of_one_and_of_eight_axes_in_icarus() {
    in_verilog(Level::Icarus, &build(1, 32_000_000, 16, StartPhase::Half, Limits::Each), 50_000);
    in_verilog(Level::Icarus, &build(8, 112_000_000, 16, StartPhase::Zero, Limits::Pair), 100_000);
}

/// All golden cases of one start phase, one per axis, are started together and run to their last
/// edge. Only a long run includes the long cases.
#[test]
fn golden_vectors_in_verilator() {
    let vectors = golden::engine_vectors();
    for phase in [StartPhase::Zero, StartPhase::Half] {
        let cases: Vec<&Case> = vectors
            .iter()
            .filter(|case| case.phase() == phase && (effort::is_long() || case.total_ticks <= 400_000))
            .collect();
        for cases in cases.chunks(AXES) {
            let timebase = Timebase::new(80_000_000, 1000, 16).expect("a fine timebase");
            let build = Build { timebase, phase, pins: [PinTiming::SHORTEST; AXES] };
            let build = EngineBuild::minimal(&build, 1 << 40);
            let recording = Recording::new(&build, &golden_program(cases), &Events::new(), u64::MAX);
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

/// The segments that fit into the queues, then the start, then the other segments as the queues
/// have room.
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

/// The edges of an axis as tick, phase and direction.
fn edges(build: &EngineBuild, recording: &Recording, axis: usize) -> Vec<Edge> {
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
fn engine_without_a_host_stays_idle() {
    let build = build(6, 80_000_000, 16, StartPhase::Half, Limits::None);
    let mut engine = EngineSim::new(&build).expect("a fine build");
    for _ in 0..1000 {
        let outputs = engine.settle(&EngineInputs::default());
        assert!(outputs.idle && outputs.fault.is_none() && outputs.step == 0 && outputs.dir == 0 && !outputs.enabled);
        engine.clock();
    }
}

//! The exported engine in Icarus and in Verilator is the engine's model, every output in every
//! clock.

use carrystep_core::engine::{CAUSES, Cause, LimitWiring, QUEUE_DEPTHS};
use carrystep_core::{
    AXES, Build, Command, EngineBuild, PinTiming, Program, Segment, StartPhase, Timebase,
};
use carrystep_simulators::Level;
use carrystep_simulators::engine::Events;
use carrystep_simulators::engine::replay::{self, Recording};
use carrystep_tests::effort;
use carrystep_tests::engine_builds::{build, parameter_sets, with_latches};
use carrystep_tests::engine_programs::run_programs;
use carrystep_tests::golden::{self, Case, Edge};
use carrystep_tests::repeats;
use carrystep_tools::kept;
use proptest::prelude::*;
use std::cell::Cell;

pub fn in_verilog(level: Level, build: &EngineBuild, usual: u64) -> Seen {
    let verilog = carrystep_verilog::engine_verilog(build, "a test").expect("a fine build");
    in_this_verilog(level, &verilog, build, usual)
}

fn in_this_verilog(level: Level, verilog: &str, build: &EngineBuild, usual: u64) -> Seen {
    let seen = Cell::new(Seen::default());
    // One program of the generator can have more clocks than all that Icarus is to compare.
    let most = if level == Level::Icarus { usual.max(40_000) } else { 200_000 };
    run_programs(build, usual, |program, events| {
        let recording = Recording::new(build, program, events, most);
        let difference = replay::difference(level, verilog, &recording).expect("the tools");
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
pub struct Seen {
    clocks: u64,
    pub edges: u64,
    /// Clocks in which several axes have an edge.
    together: u64,
    /// Number of stops by each cause.
    causes: [u64; CAUSES.len()],
    /// Edges after the call of a stop, which belong to ramps.
    ramped: u64,
    cleared: u64,
    /// Hits of seeks.
    hits: u64,
    /// Edges of latches that they did not latch.
    further: u64,
    /// Changes of the records that latches hold, and edges that several latches accept at once.
    records: u64,
    shared: u64,
    /// Changes of outputs, and edges of the PWM.
    switched: u64,
    modulated: u64,
    /// Cuts that were executed, and those that were refused.
    cuts: u64,
    refused: u64,
}

impl Seen {
    fn with(mut self, recording: &Recording) -> Self {
        self.clocks += recording.clocks;
        for pair in recording.outputs.windows(2) {
            let [(_, before), (_, now)] = pair else { continue };
            let rising = (now.step & !before.step).count_ones();
            self.edges += u64::from(rising);
            self.together += u64::from(rising > 1);
            self.hits += u64::from(now.hits & !before.hits != 0);
            let counts = now.latch_edges.iter().zip(before.latch_edges);
            self.further += u64::from(counts.into_iter().any(|(now, before)| *now > before));
            self.records += u64::from(now.latch_records != before.latch_records);
            let accepted = before.latch_armed & !now.latch_armed;
            self.shared += u64::from(accepted.count_ones() > 1 && !now.resetting);
            self.switched += u64::from(now.outputs != before.outputs);
            self.modulated += u64::from(now.pwm != before.pwm);
            let decided = before.cut_busy && !now.cut_busy;
            self.cuts += u64::from(decided && !now.cut_refused);
            self.refused += u64::from(decided && now.cut_refused);
            match (before.fault, now.fault) {
                (None, Some((cause, _))) => self.causes[cause as usize] += 1,
                (Some((Cause::Stop, _)), Some(_)) => self.ramped += u64::from(rising),
                (Some(_), None) => self.cleared += 1,
                _ => {}
            }
        }
        self
    }

    pub fn assert_everything(&self) {
        let Self { clocks, edges, together, causes, ramped, cleared, hits, further, .. } = *self;
        let Self { switched, modulated, cuts, refused, .. } = *self;
        let moved = [clocks, edges, together, ramped, cleared, hits, further];
        let counts = [moved.as_slice(), &[switched, modulated, cuts, refused]].concat();
        let all = [counts.as_slice(), &causes].concat();
        assert!(all.iter().all(|count| *count > 0), "random programs miss something: {self:?}");
        let stops: u64 = causes.iter().sum();
        effort::figures(&format!("{edges} edges, {stops} stops of all {} causes", CAUSES.len()));
    }
}

#[test]
fn random_programs_in_verilator() {
    let build = build(6, 80_000_000, 16, StartPhase::Half, LimitWiring::Pair);
    in_verilog(Level::Verilator, &build, 7_000_000).assert_everything();
}

#[test]
fn random_programs_of_eight_axes_in_verilator() {
    let build = build(8, 112_000_000, 16, StartPhase::Half, LimitWiring::Each);
    let seen = in_verilog(Level::Verilator, &build, 2_000_000);
    assert!(seen.edges > 0 && seen.together > 0, "too little happens: {seen:?}");
}

#[test]
fn random_programs_with_two_and_with_four_latches() {
    for (level, usual) in [(Level::Verilator, 1_500_000), (Level::Icarus, 30_000)] {
        for count in [2, 4] {
            let build = build(6, 80_000_000, 16, StartPhase::Half, LimitWiring::Pair);
            let seen = in_verilog(level, &with_latches(build, count), usual);
            let is_much = level == Level::Icarus || (seen.records > 0 && seen.shared > 0);
            assert!(is_much, "too little happens: {seen:?}");
        }
    }
}

#[test]
fn random_programs_of_one_axis_in_verilator() {
    in_verilog(
        Level::Verilator,
        &build(1, 32_000_000, 16, StartPhase::Zero, LimitWiring::Pair),
        1_000_000,
    );
}

#[test]
fn random_programs_in_icarus() {
    in_verilog(
        Level::Icarus,
        &build(6, 96_000_000, 4, StartPhase::Zero, LimitWiring::One),
        150_000,
    );
}

#[test]
fn random_programs_of_one_and_of_eight_axes_in_icarus() {
    in_verilog(
        Level::Icarus,
        &build(1, 32_000_000, 16, StartPhase::Half, LimitWiring::Each),
        50_000,
    );
    in_verilog(
        Level::Icarus,
        &build(8, 112_000_000, 16, StartPhase::Zero, LimitWiring::Pair),
        50_000,
    );
}

/// The Verilog of the one build, instantiated with the parameters of the other under the top's
/// usual name.
fn with_parameters(verilog: &str, of: &EngineBuild) -> String {
    const TOP: &str = "module carrystep_engine #(\n";
    let other = carrystep_verilog::engine_verilog(of, "a test").expect("a fine build");
    let (_, head) = other.split_once(TOP).expect("parameters");
    let (parameters, rest) = head.split_once("\n) (\n").expect("ports");
    let (ports, _) = rest.split_once("\n);").expect("the end of the ports");
    let overrides = parameters.lines().filter_map(|line| {
        let (declared, value) =
            line.trim().strip_prefix("parameter ")?.trim_end_matches(',').split_once(" = ")?;
        Some(format!(".{}({value})", declared.rsplit(' ').next()?))
    });
    let overrides: Vec<String> = overrides.collect();
    assert!(overrides.len() > 30, "too few parameters: {overrides:?}");
    let connections: Vec<String> = ports
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .filter_map(|line| line.trim().trim_end_matches(',').rsplit(' ').next())
        .map(|port| format!(".{port}({port})"))
        .collect();
    let ports = ports.replace("output reg ", "output wire");
    format!(
        "{}\nmodule carrystep_engine (\n{ports}\n);\n    instantiated #({}) core ({});\nendmodule\n",
        verilog.replace(TOP, "module instantiated #(\n"),
        overrides.join(", "),
        connections.join(", "),
    )
}

#[test]
fn verilog_of_one_build_with_the_parameters_of_others_is_theirs() {
    let sets = parameter_sets();
    let verilog = carrystep_verilog::engine_verilog(&sets[0], "a test").expect("a fine build");
    for (build, usual) in sets.iter().zip([1_000_000; 4]) {
        let seen =
            in_this_verilog(Level::Verilator, &with_parameters(&verilog, build), build, usual);
        assert!(seen.edges > 0 && seen.together > 0, "too little happens: {seen:?}");
        // Icarus repeats what Verilator has compared.
        let usual = repeats::part(50_000, 5);
        in_this_verilog(Level::Icarus, &with_parameters(&verilog, build), build, usual);
    }
}

/// A comparison that would not see a wrong parameter would prove nothing.
#[test]
fn verilog_with_one_wrong_parameter_is_another() {
    let sets = parameter_sets();
    let verilog = carrystep_verilog::engine_verilog(&sets[0], "a test").expect("a fine build");
    let mut wrong = sets[1].clone();
    wrong.pins[0].step_high += 1;
    let text = with_parameters(&verilog, &wrong);
    let differs = Cell::new(false);
    run_programs(&sets[1], 50_000, |program, events| {
        let recording = Recording::new(&sets[1], program, events, 200_000);
        let difference = replay::difference(Level::Icarus, &text, &recording).expect("the tools");
        differs.set(differs.get() || difference.is_some());
        Ok(recording.clocks)
    });
    assert!(differs.get(), "a STEP that is one clock too long is not seen");
}

/// All golden cases of one start phase, one per axis, are started together and run to their last
/// edge. Only a run of repeats includes the long cases; the parallel core runs them every time.
#[test]
fn golden_vectors_in_verilator() {
    let vectors = golden::engine_vectors();
    for phase in [StartPhase::Zero, StartPhase::Half] {
        let cases: Vec<&Case> = vectors
            .iter()
            .filter(|case| {
                case.phase() == phase && (repeats::in_full() || case.total_ticks <= 200_000)
            })
            .collect();
        for cases in cases.chunks(AXES) {
            let timebase = Timebase::new(80_000_000, 1000, 16).expect("a fine timebase");
            let build = Build { timebase, phase, pins: [PinTiming::SHORTEST; AXES] };
            let build = EngineBuild::minimal(&build, 1 << 40);
            let recording =
                Recording::new(&build, &golden_program(cases), &Events::new(), u64::MAX);
            let verilog =
                carrystep_verilog::engine_verilog(&build, "a test").expect("a fine build");
            let difference =
                replay::difference(Level::Verilator, &verilog, &recording).expect("the tools");
            assert_eq!(difference, None);
            for (axis, case) in cases.iter().enumerate() {
                case.assert_edges(&edges(&build, &recording, axis));
                let [low, high, ..] = recording.kept[axis];
                assert_eq!(u64::from(high) << 32 | u64::from(low), case.p_end(), "{}", case.name);
            }
        }
    }
    kept::say();
}

/// The segments that fit into the queues, then the start, then the other segments as the queues
/// have room.
fn golden_program(cases: &[&Case]) -> Program {
    let segments: Vec<Vec<Segment>> = cases.iter().map(|case| case.segments()).collect();
    let part = |rows: std::ops::Range<usize>| {
        let mut part = Program::new();
        for row in rows {
            let lanes = (0..)
                .zip(&segments)
                .filter_map(|(axis, lane)| lane.get(row).map(|segment| (axis, *segment)));
            part.extend(lanes.map(|(axis, segment)| Command::Segment { axis, segment }));
        }
        part
    };
    let start = Command::Start { mask: (1 << cases.len()) - 1 };
    let rows = segments.iter().map(Vec::len).max().unwrap_or(0);
    [part(0..QUEUE_DEPTHS[0]), vec![start], part(QUEUE_DEPTHS[0]..rows)].concat()
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
            edges.push((
                since / tick + 1,
                (since % tick / phase) as u32,
                if level(outputs.dir) { -1 } else { 1 },
            ));
        }
        before = level(outputs.step);
    }
    edges
}

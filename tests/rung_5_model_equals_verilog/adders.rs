//! The exported engine with several adders is the engine's model, every output in every clock; and
//! what an engine with several adders could do wrong is seen.

use carrystep_core::engine::{LimitWiring, SeekSource};
use carrystep_core::{Command, EngineBuild, Program, Segment, StartPhase};
use carrystep_simulators::Level;
use carrystep_simulators::engine::replay::{self, Recording};
use carrystep_simulators::engine::{Event, Events};
use carrystep_tests::effort;
use carrystep_tests::engine_builds::{build, on_adders};
use carrystep_tests::engine_programs::run_programs;
use carrystep_tests::mutants::planted::{Planted, plant};
use carrystep_tests::{lockstep, moves};
use proptest::prop_assert;
use std::cell::RefCell;

use crate::engine::{Seen, in_verilog};

/// Six axes on six adders in a tick of 16 clocks.
fn six_on_six() -> EngineBuild {
    on_adders(build(6, 16_000_000, 4, StartPhase::Half, LimitWiring::Pair), 6)
}

/// Six axes on two adders in a tick of 42 clocks.
fn six_on_two() -> EngineBuild {
    on_adders(build(6, 42_000_000, 1, StartPhase::Zero, LimitWiring::Each), 2)
}

#[test]
fn random_programs_of_six_axes_on_six_adders_in_verilator() {
    let seen = in_verilog(Level::Verilator, &six_on_six(), 600_000);
    if effort::is_long() {
        seen.assert_everything();
    }
    assert_moves(seen);
}

/// An ordinary run has random programs of this engine with the planted bugs.
#[test]
fn random_programs_of_six_axes_on_two_adders_in_verilator() {
    if !effort::is_long() {
        return;
    }
    assert_moves(in_verilog(Level::Verilator, &six_on_two(), 600_000));
}

/// A long run has these in Verilator.
#[test]
fn random_programs_on_several_adders_in_icarus() {
    if !effort::is_long() {
        in_verilog(Level::Icarus, &six_on_six(), 20_000);
    }
}

#[test]
fn random_programs_of_eight_axes_on_eight_adders() {
    if effort::is_long() {
        let eight = build(8, 48_000_000, 16, StartPhase::Half, LimitWiring::One);
        assert_moves(in_verilog(Level::Verilator, &on_adders(eight, 8), 300_000));
    }
}

fn assert_moves(seen: Seen) {
    assert!(seen.edges > 0, "too little happens: {seen:?}");
}

/// The Verilog is compared in every output of every clock; the plan says how fast the pulses are.
#[test]
fn six_axes_at_1_900_000_steps_a_second_each() {
    let (file, plan) = moves::six_fast_axes();
    let moved = (file.machine.engine(), plan);
    for level in [Level::Fast, Level::Verilator] {
        lockstep::assert_engine_equals_model(level, &moved);
    }
    let (build, plan) = &moved;
    let axes = plan.moves.iter().flat_map(|planned| &planned.axes);
    let speeds = axes.flat_map(|axis| &axis.segments).map(|segment| segment.v.unsigned_abs());
    // 1.9 million steps/s are 0.475 steps in a tick of 250 ns.
    let most = speeds.max().expect("a move") as f64 / 2_f64.powi(64);
    assert!((0.474..=0.475).contains(&most), "{most} steps a tick");
    assert_eq!((build.timebase.clocks_per_tick(), build.adders), (16, 6));
}

/// Bugs of an engine of six axes on two adders, in the module, around an expression.
const BUGS: [(&str, &str, &str, &str, &str); 9] = [
    (
        "the axes of the second adder ramp only for a seek",
        "engine",
        ".ramp({})",
        "stops_ramp | lane_seek_slows[1]",
        "lane_seek_slows[1]",
    ),
    (
        "the axes of the second adder ramp one tick late",
        "engine",
        ".ramp({})",
        "stops_ramp | lane_seek_slows[1]",
        "(stops_ramp & late_ramp) | lane_seek_slows[1]",
    ),
    (
        "a word goes to the axis of the other adder too",
        "engine",
        ".take({})",
        "take & is_own_1",
        "take",
    ),
    (
        "a word for the second adder is stored by the first one",
        "engine",
        ".put({})",
        "taken[1]",
        "taken[0]",
    ),
    (
        "the latch misses the axes of the second adder",
        "engine",
        ".latches({}),\n        .samples(switches_1_samples)",
        "edge_latch_latches",
        "1'b0",
    ),
    (
        "a freezing cause behind another one of its time slot is not told",
        "findings",
        "assign tells = {};",
        "ended | again",
        "ended",
    ),
    (
        "the highest axis of a time slot is the culprit",
        "findings",
        "lowest = {};",
        "all & (NO_LANES - all)",
        "all[1] ? 2'd2 : all",
    ),
    (
        "a hit of the second adder does not delay a snapshot",
        "engine",
        "some_meet = {};",
        "some_meet | readout_1_meets",
        "some_meet",
    ),
    (
        "a cut does not ask the second adder",
        "engine",
        "some_miss = {};",
        "some_miss | queue_1_misses",
        "some_miss",
    ),
];

/// A register that one of the bugs needs: the ramp of a stop, one tick later.
const LATE: &str = "
    reg late_ramp = 1'b0;
    always @(posedge clock) if (strobe) late_ramp <= stops_ramp;

    carrystep_lane_slots";

/// Axis 0 runs out of segments in the tick in which V of axis 1 leaves its range, and the same for
/// the axes 3 and 2: of each pair, one cause freezes, and the axis with the lower number is the
/// culprit.
fn two_causes_in_a_time_slot() -> (Program, Events) {
    let dry = Segment { ticks: 2, v: 1 << 60, a: 0, j: 0, last: false };
    let fast = Segment { ticks: 9, v: 1 << 62, a: 1 << 62, j: 0, last: true };
    let mut program = Program::new();
    for (first, second) in [((0, dry), (1, fast)), ((3, dry), (2, fast)), ((2, dry), (3, fast))] {
        for (axis, segment) in [first, second] {
            program.push(Command::Segment { axis, segment });
        }
        program.push(Command::Start { mask: 1 << first.0 | 1 << second.0 });
        program.extend([Command::Wait { clocks: 4000 }, Command::Clear]);
    }
    (program, Events::new())
}

/// Axes of the second adder hit their own switches while the host requests snapshots and cuts.
fn hits_beside_snapshots() -> (Program, Events) {
    let slow = Segment { ticks: 5000, v: 1 << 56, a: 0, j: 0, last: true };
    let program: Program = (0..6)
        .flat_map(|axis| [slow; 3].map(|segment| Command::Segment { axis, segment }))
        .chain([Command::Start { mask: 0x3f }, Command::Wait { clocks: 200_000 }])
        .collect();
    let source = SeekSource { axis: 0, row: 2, own: true, level: true };
    let mut events = vec![(30_000, Event::SeekSource(source)), (30_000, Event::Seek(0x3f))];
    events.extend((0..3000).map(|turn| (31_000 + 42 * turn, Event::Snapshot)));
    events.push((32_000, Event::Inputs0(0x02)));
    events.push((60_000, Event::Inputs0(0x22)));
    // Axis 3 has no segment in that slot, axis 0 has.
    events.extend([(100_000, Event::Name(0, 2)), (100_000, Event::Name(3, 5))]);
    events.push((102_000, Event::Cut));
    events.extend((0..4000).map(|turn| (50 * turn, Event::Kick)));
    events.sort_by_key(|(cycle, _)| *cycle);
    (program, events)
}

#[test]
fn bugs_of_several_adders_are_caught() {
    let build = six_on_two();
    let right = carrystep_verilog::engine_verilog(&build, "a test").expect("a fine build");
    let (head, top) = right.rsplit_once("module carrystep_engine").expect("the top module");
    let top = top.replacen("\n    carrystep_lane_slots", LATE, 1);
    let planted = BUGS.map(|(name, module, around, right, wrong)| {
        Planted::new(name, module, around, right, wrong)
    });
    let verilog = plant(&format!("{head}module carrystep_engine{top}"), &planted);
    let differs = |number: usize, recording: &Recording| {
        replay::difference_of_mutant(&verilog, number, recording).expect("the tools").is_some()
    };
    let mut left: Vec<usize> = (1..=BUGS.len()).collect();
    for (program, events) in [two_causes_in_a_time_slot(), hits_beside_snapshots()] {
        let recording = Recording::new(&build, &program, &events, 300_000);
        assert!(!differs(0, &recording), "the Verilog without a bug is the model");
        left.retain(|number| !differs(*number, &recording));
    }
    let left = RefCell::new(left);
    run_programs(&build, 600_000, |program, events| {
        let recording = Recording::new(&build, program, events, 200_000);
        prop_assert!(!differs(0, &recording), "the Verilog without a bug is the model");
        left.borrow_mut().retain(|number| !differs(*number, &recording));
        Ok(recording.clocks)
    });
    let left: Vec<&str> = left.borrow().iter().map(|number| BUGS[number - 1].0).collect();
    assert_eq!(left, [""; 0], "nobody catches these");
}

//! Homing: an axis that waits for its limit finds it, slows down alone and reports its position
//! there, while the other axes continue unchanged. The exported Verilog does the same in every
//! clock, and planted bugs are caught.

use carrystep_core::engine::{
    AxisStatus, Cause, Guard, LimitWiring, SeekSource, StateItem, StatePage, commanded_steps,
};
use carrystep_core::{
    AXES, Build, Command, EngineBuild, PinTiming, Program, Segment, StartPhase, Timebase,
};
use carrystep_hdl::EngineSim;
use carrystep_simulators::Level;
use carrystep_simulators::engine::replay::{self, Recording};
use carrystep_simulators::engine::{EngineCore, EngineHost, Event, Events};
use carrystep_tests::planted;
use carrystep_tools::kept;

/// The clock in which the limit becomes active; by then all axes have cruised for some hundred
/// ticks.
const THEN: u64 = 30_000;

/// The axis that homes; it moves backward.
const HOMING: usize = 1;

fn build(limits: LimitWiring) -> EngineBuild {
    let timebase = Timebase::new(80_000_000, 1000, 16).expect("a fine timebase");
    let pins = [PinTiming { step_high: 5, step_low: 5, dir_setup: 3, dir_hold: 3 }; AXES];
    let build = EngineBuild::minimal(&Build { timebase, phase: StartPhase::Half, pins }, 1 << 53);
    EngineBuild {
        guard: Guard { round: 2, debounce: 3, enable: 2, limits, ..build.guard },
        ..build
    }
}

/// All axes move at a sixteenth of a step per tick, the odd ones backward, in three segments each.
fn cruise() -> Program {
    let segment = |axis: u8, ticks, last| {
        let v = if axis.is_multiple_of(2) { 1 << 60 } else { -(1 << 60) };
        Command::Segment { axis, segment: Segment { ticks, v, a: 0, j: 0, last } }
    };
    let rows = [(400, false), (100, false), (400, true)];
    let mut program: Program = rows
        .iter()
        .flat_map(|&(ticks, last)| (0..6).map(move |axis| segment(axis, ticks, last)))
        .collect();
    program.push(Command::Start { mask: 0x3f });
    program
}

/// Each axis waits for its own limit at its low end.
const OWN: SeekSource = SeekSource { axis: 0, row: 0, own: true, level: true };

/// The axis waits for its limit from the start; the limit is active for some ticks from clock
/// `then` on.
fn events(then: u64) -> Events {
    let limit = 1 << HOMING;
    vec![
        (99, Event::SeekSource(OWN)),
        (100, Event::Seek(limit)),
        (then, Event::LimitMin(limit)),
        (then + 3_000, Event::LimitMin(0)),
    ]
}

fn run(limits: LimitWiring, program: &Program, events: &Events) -> Recording {
    Recording::new(&build(limits), program, events, 300_000)
}

/// Cycles of the rising edges of an axis.
fn edges(recording: &Recording, axis: usize) -> Vec<u64> {
    let level = |mask: u8| mask >> axis & 1 == 1;
    let pairs = recording.outputs.windows(2);
    pairs
        .filter(|pair| !level(pair[0].1.step) && level(pair[1].1.step))
        .map(|pair| pair[1].0)
        .collect()
}

#[test]
fn homing_axis_slows_down_alone_at_its_limit() {
    for limits in [LimitWiring::Pair, LimitWiring::Each] {
        let free = run(limits, &cruise(), &Events::new());
        let homed = run(limits, &cruise(), &events(THEN));
        assert!(
            homed.outputs.iter().all(|(_, out)| out.fault.is_none()),
            "{limits:?}: nothing is called"
        );
        for axis in (0..AXES).filter(|axis| *axis != HOMING) {
            assert_eq!(edges(&free, axis), edges(&homed, axis), "{limits:?}, axis {axis}");
        }
        let (all, fewer) = (edges(&free, HOMING), edges(&homed, HOMING));
        let met = homed
            .outputs
            .iter()
            .find(|(cycle, out)| *cycle > 200 && out.seeking == 0)
            .expect("it meets its limit")
            .0;
        // The ramp takes 128 ticks, and a step needs two more ticks to reach the pins.
        let last = *fewer.last().expect("it has moved");
        assert!(
            met > THEN && last > met + 20 * 80 && last < met + 131 * 80,
            "{limits:?}: {met}, {last}"
        );
        assert!(fewer.len() + 20 < all.len(), "{limits:?}: {} of {} steps", fewer.len(), all.len());
        assert!(
            homed.outputs.last().is_some_and(|(_, out)| out.idle),
            "{limits:?}: its queue is empty"
        );
    }
}

#[test]
fn limit_of_an_axis_that_does_not_home_stops_all_axes() {
    let other = vec![
        (99, Event::SeekSource(OWN)),
        (100, Event::Seek(1 << HOMING)),
        (THEN, Event::LimitMin(1 << 3)),
        (THEN + 3_000, Event::LimitMin(0)),
    ];
    let recording = run(LimitWiring::Pair, &cruise(), &other);
    assert_eq!(
        recording.outputs.iter().find_map(|(_, out)| out.fault),
        Some((Cause::Limit, 1 << 3))
    );
}

#[test]
fn start_after_the_hit_is_cancelled_until_the_seek_is_ended() {
    let program = [cruise(), vec![Command::Start { mask: 1 << HOMING }]].concat();
    let recording = run(LimitWiring::Pair, &program, &events(THEN));
    assert_eq!(recording.outputs.iter().find_map(|(_, out)| out.fault), None);
    let (_, last) = recording.outputs.last().expect("outputs");
    assert!(last.hits == 1 << HOMING && !last.armed && last.idle, "{last:?}");
    // Without a seek that has hit, the same start finds an empty queue.
    let ended = [events(THEN), vec![(THEN + 100_000, Event::Seek(0))]].concat();
    let recording = run(LimitWiring::Pair, &program, &ended);
    let (_, last) = recording.outputs.last().expect("outputs");
    assert_eq!(last.hits, 0, "{last:?}");
}

/// The words on the page of the limit are those of the tick after the one in which it was found,
/// once, and no other axis has any.
#[test]
fn state_at_the_limit_is_that_of_the_next_tick() {
    let build = build(LimitWiring::Pair);
    let mut engine = EngineSim::new(&build).expect("a fine build");
    let mut host = EngineHost::new(&build, &cruise(), &events(THEN));
    let mut at_limit = Vec::new();
    let (mut live, mut waited, mut ticks_when_found) = (None, false, None);
    while at_limit.len() < 5 {
        let inputs = host.inputs(false);
        let found = engine.settle(&inputs);
        match found.state.of_adder(0) {
            // The page of a switch is its row.
            Some(word) if word.page == StatePage::Seek && word.item != StateItem::Switch => {
                assert_eq!(word.axis as usize, HOMING);
                at_limit.push((word.item, word.word));
            }
            Some(word) if word.item == StateItem::Ticks => live = Some(word.word),
            _ => {}
        }
        waited |= found.seeking != 0;
        if waited && found.seeking == 0 && ticks_when_found.is_none() {
            ticks_when_found = live;
        }
        host.advance(&found);
        EngineCore::clock(&mut engine, &inputs);
    }
    let word = |item| at_limit.iter().find(|(found, _)| *found == item).expect("an item").1;
    let ticks = ticks_when_found.expect("the limit was found");
    assert_eq!(word(StateItem::Ticks), ticks + 1);
    let status = AxisStatus::of_word(word(StateItem::Status));
    assert!(
        status.running && commanded_steps(word(StateItem::Position).cast_signed(), status) < -10
    );
}

/// Runs in which the limit becomes active in every part of a tick, while segments still arrive and
/// a start waits.
fn recordings() -> Vec<Recording> {
    let late = |ticks| Command::Segment {
        axis: HOMING as u8,
        segment: Segment { ticks, v: 0, a: 0, j: 0, last: true },
    };
    let busy = [cruise(), (1..12).map(late).collect()].concat();
    let waiting = [cruise(), vec![Command::Start { mask: 1 << HOMING }]].concat();
    let mut all: Vec<_> =
        (0..12).map(|k| run(LimitWiring::Pair, &busy, &events(THEN + 371 * k))).collect();
    all.extend((0..3).map(|k| run(LimitWiring::Pair, &waiting, &events(THEN + 601 * k))));
    all
}

/// True if the changed Verilog differs from the model.
fn caught(change: impl Fn(String) -> String) -> bool {
    let verilog = change(
        carrystep_verilog::engine_verilog(&build(LimitWiring::Pair), "a test")
            .expect("a fine build"),
    );
    let differs = |recording: &Recording| {
        replay::difference(Level::Verilator, &verilog, recording).expect("the tools").is_some()
    };
    recordings().iter().any(differs)
}

#[test]
fn verilog_homes_in_the_same_clock_as_the_model() {
    assert!(!caught(|verilog| verilog));
    kept::say();
}

const BUGS: [planted::Bug; 5] = [
    ("a limit of the seek stops all", "switches_found & !seek_control_forgives", "switches_found"),
    ("the limit is met once more on the way", "(mine | mine_slows)", "mine"),
    ("all axes slow down", "(slowing & axis_one_hot_next)", "(slowing)"),
    ("the queue keeps what waits", "next_live = newest;", "next_live = live_now;"),
    (
        "a start does not notice an axis that slows",
        "drops <= drops | (masked & seek_control_slows);",
        "drops <= drops;",
    ),
];

#[test]
fn planted_bugs_in_homing_are_caught() {
    planted::assert_all_caught(&BUGS, |plant| caught(plant));
}

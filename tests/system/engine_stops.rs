//! Every cause stops the engine as docs/clock-by-clock.md specifies. The exported Verilog does the
//! same in every clock, and bugs planted in its guard are caught.

use carrystep_core::engine::{Cause, Guard, LimitWiring};
use carrystep_core::{
    AXES, Build, Command, EngineBuild, PinTiming, Program, Segment, StartPhase, Timebase,
};
use carrystep_simulators::Level;
use carrystep_simulators::engine::replay::{self, Recording};
use carrystep_simulators::engine::{Event, Events};
use carrystep_tests::planted;
use carrystep_tools::kept;

/// Mask of the axes that move backward: 1, 3 and 5.
const BACKWARD: u8 = 0b10_1010;

/// The clock of the events; by then all axes have cruised for some hundred ticks.
const THEN: u64 = 30_000;

fn build(limits: LimitWiring) -> EngineBuild {
    let timebase = Timebase::new(80_000_000, 1000, 16).expect("a fine timebase");
    let mut pins = [PinTiming { step_high: 5, step_low: 5, dir_setup: 3, dir_hold: 3 }; AXES];
    pins[5].step_low = 200;
    let build = EngineBuild::minimal(&Build { timebase, phase: StartPhase::Half, pins }, 1 << 53);
    let guard = Guard { round: 2, debounce: 3, enable: 2, watchdog: 40, limits, ..build.guard };
    EngineBuild { guard, ..build }
}

/// All axes at a sixteenth of a step per tick, every other one backward.
fn cruise(ticks: u32, v: i64, a: i64, last: bool) -> Program {
    let segment =
        |axis: u8| Segment { ticks, v: if axis.is_multiple_of(2) { v } else { -v }, a, j: 0, last };
    let mut program: Program =
        (0..6).map(|axis| Command::Segment { axis, segment: segment(axis) }).collect();
    program.push(Command::Start { mask: 0x3f });
    program
}

/// A program, the events around it, and the expected stop.
struct Case {
    name: &'static str,
    limits: LimitWiring,
    program: Program,
    events: Events,
    fault: (Cause, u8),
    /// True if edges follow the call: a ramp has some, a freeze has none.
    ramps: bool,
}

fn cases() -> Vec<Case> {
    let at = |event, end| vec![(THEN, event), (THEN + 2_000, end)];
    let quiet = |mut events: Events| {
        events.extend((0..60).map(|i| (i * 3_000, Event::Kick)));
        events.sort_by_key(|(cycle, _)| *cycle);
        events
    };
    let case = |name, events: Events, fault, ramps| Case {
        name,
        limits: LimitWiring::Pair,
        program: cruise(600, 1 << 60, 1 << 51, true),
        events: quiet(events),
        fault,
        ramps,
    };
    let stop_then_estop = vec![
        (THEN, Event::Stop(true)),
        (THEN + 1, Event::Stop(false)),
        (THEN + 4_000, Event::EStop(true)),
    ];
    let stop_then_estop = [stop_then_estop, vec![(THEN + 8_000, Event::EStop(false))]].concat();
    vec![
        case("e-stop", at(Event::EStop(true), Event::EStop(false)), (Cause::EStop, 0), false),
        case("host stop", at(Event::Stop(true), Event::Stop(false)), (Cause::Stop, 0), true),
        case("host stop, then e-stop", stop_then_estop, (Cause::Stop, 0), true),
        case(
            "low limits",
            at(Event::LimitMin(0x3f), Event::LimitMin(0)),
            (Cause::Limit, 0b10),
            true,
        ),
        case(
            "high limits",
            at(Event::LimitMax(0x3c), Event::LimitMax(0)),
            (Cause::Limit, 0b100),
            true,
        ),
        Case {
            limits: LimitWiring::Each,
            ..case(
                "limits for both ends",
                at(Event::LimitMin(8), Event::LimitMin(0)),
                (Cause::Limit, 8),
                true,
            )
        },
        Case {
            limits: LimitWiring::One,
            ..case(
                "one limit for all",
                at(Event::LimitMin(1), Event::LimitMin(0)),
                (Cause::Limit, 1),
                true,
            )
        },
        Case {
            events: vec![(0, Event::Kick)],
            ..case("silence", Vec::new(), (Cause::Watchdog, 0), true)
        },
        Case {
            program: cruise(300, 1 << 60, 0, false),
            ..case("a dry queue", Vec::new(), (Cause::Underrun, 1), true)
        },
        Case {
            program: cruise(300, 1 << 60, 1 << 58, true),
            ..case("overspeed", Vec::new(), (Cause::Overspeed, 1), false)
        },
        Case {
            program: cruise(300, i64::MAX - 5, 0, true),
            ..case("overrun", Vec::new(), (Cause::Overrun, 0b10_0000), false)
        },
        Case {
            program: [cruise(300, 1 << 60, 0, true), vec![Command::Start { mask: 1 }]].concat(),
            ..case("a start of nothing", Vec::new(), (Cause::Protocol, 0), false)
        },
    ]
}

impl Case {
    /// The recording of the case, followed by a clear and a second move.
    fn recording(&self) -> Recording {
        let again =
            [vec![Command::Wait { clocks: 120_000 }, Command::Clear], cruise(40, 1 << 60, 0, true)]
                .concat();
        let program = [self.program.clone(), again].concat();
        let mut events = self.events.clone();
        events.extend((40..200).map(|i| (i * 3_000, Event::Kick)));
        events.sort_by_key(|(cycle, _)| *cycle);
        Recording::new(&build(self.limits), &program, &events, 400_000)
    }
}

#[test]
fn every_cause_stops_as_specified_and_a_clear_resumes() {
    for case in cases() {
        let recording = case.recording();
        let name = case.name;
        let called = recording.outputs.iter().position(|(_, out)| out.fault.is_some());
        let called = called.unwrap_or_else(|| panic!("{name}: nothing stops it"));
        let (fault_at, first) = &recording.outputs[called];
        assert_eq!(first.fault, Some(case.fault), "{name}, in cycle {fault_at}");
        let stopped = recording.outputs[called..].iter().take_while(|(_, out)| out.fault.is_some());
        let edges = stopped
            .clone()
            .zip(stopped.clone().skip(1))
            .filter(|(a, b)| b.1.step & !a.1.step != 0)
            .count();
        assert_eq!(edges > 0, case.ramps, "{name}: {edges} edges after the call");
        assert!(
            stopped.clone().all(|(_, out)| out.fault == Some(case.fault)),
            "{name}: the first cause stays"
        );
        assert!(
            stopped.last().is_some_and(|(_, out)| out.halted && out.step == 0),
            "{name}: it comes to rest"
        );
        let (_, end) = recording.outputs.last().expect("an end");
        assert!(end.fault.is_none() && end.idle, "{name}: the second move runs to its end");
    }
}

#[test]
fn limit_stops_only_axes_that_move_toward_it() {
    let case = &cases()[3];
    let recording = case.recording();
    let fault = recording.outputs.iter().find_map(|(_, out)| out.fault);
    assert_eq!(fault.map(|(_, axes)| axes & !BACKWARD), Some(0));
}

/// The first case in which the Verilog differs from the model.
fn caught(change: impl Fn(String) -> String) -> Option<&'static str> {
    cases().into_iter().find_map(|case| {
        let verilog =
            carrystep_verilog::engine_verilog(&build(case.limits), "a test").expect("a fine build");
        let difference = replay::difference(Level::Verilator, &change(verilog), &case.recording())
            .expect("the tools");
        difference.map(|_| case.name)
    })
}

#[test]
fn verilog_stops_in_the_same_clock_as_the_model() {
    assert_eq!(caught(|verilog| verilog), None);
    kept::say();
}

const BUGS: [planted::Bug; 6] = [
    ("a ramp speeds up", "assign upward = word[12];", "assign upward = !word[12];"),
    (
        "a ramp begins before it knows the way",
        "assign steady = ramp & !word[13];",
        "assign steady = 1'b0;",
    ),
    (
        "a later cause takes the place of the first",
        "if (calls & !called) begin",
        "if (calls) begin",
    ),
    ("a limit stops the other way", "(back ^ row[0])", "(back ~^ row[0])"),
    (
        "an e-stop does not freeze",
        "if (urgent | (strobe & found_freezing) | ending)",
        "if (breaks | (strobe & found_freezing) | ending)",
    ),
    ("a clear leaves the pins frozen", "freeze <= 1'b0;", "freeze <= freeze;"),
];

#[test]
fn planted_bugs_in_the_guard_are_caught() {
    planted::assert_all_caught(&BUGS, |plant| caught(plant).is_some());
}

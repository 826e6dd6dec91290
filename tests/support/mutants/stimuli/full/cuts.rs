//! Recordings of cuts, in each axis and each slot, accepted and refused.

use super::super::Stimulus;
use super::super::cruise::{TICK, cruise};
use super::super::kinds::first_tick;
use super::{THEN, sorted};
use carrystep_core::{AXES, Command, EngineBuild, Program, Segment};
use carrystep_simulators::engine::{Event, Events};

/// Number of slots of an axis.
const SLOTS: u64 = 8;

pub(super) fn all(build: &EngineBuild) -> Vec<Stimulus> {
    let mut all: Vec<_> = (0..AXES as u8).map(|axis| in_every_slot(build, axis)).collect();
    all.extend([of_all_axes(build), at_any_time(build), with_stops(build), few(build)]);
    all.extend([0, 5].into_iter().flat_map(|axis| of_an_end(build, axis)));
    all
}

fn segment(axis: u8, ticks: u32, last: bool) -> Command {
    let v = if axis.is_multiple_of(2) { 1 << 56 } else { -(1 << 56) };
    let v = v + (i64::from(axis) << 50);
    Command::Segment { axis, segment: Segment { ticks, v, a: 0, j: 0, last } }
}

/// The host keeps the queue of an axis full, so that all slots are in use. Every 75 ticks it names
/// another slot and requests a cut; then it fills the queue again.
fn in_every_slot(build: &EngineBuild, axis: u8) -> Stimulus {
    let mut program: Program = (0..7).map(|_| segment(axis, 11, false)).collect();
    program.push(Command::Start { mask: 1 << axis });
    program.extend((0..130).map(|place| segment(axis, 11, place == 129)));
    let cut = |number: u64| {
        let at = THEN + 75 * TICK * number + 13 * number;
        [(at, Event::Name(axis, (3 * number % SLOTS) as u8)), (at + 2 * TICK + 5, Event::Cut)]
    };
    let events = (0..2 * SLOTS).flat_map(cut).collect();
    Stimulus::new(build, format!("cuts of axis {axis}"), &program, &events)
}

/// One to six segments wait behind the running one. In each axis the host names the slots from the
/// last one down: at first those that hold no segment, then the end of the queue, and so on. Now
/// and then it names a slot of the next axis too.
fn few(build: &EngineBuild) -> Stimulus {
    let mut program = Program::new();
    for axis in 0..AXES as u8 {
        let count = 2 + axis;
        program.extend((0..count).map(|place| segment(axis, 800, place + 1 == count)));
    }
    program.push(Command::Start { mask: 0x3f });
    let mut events = Events::new();
    for number in 0..AXES as u64 * SLOTS {
        let (axis, slot) = ((number % AXES as u64) as u8, (number / AXES as u64) as u8);
        let at = 3 * THEN + 11 * TICK * number;
        let name = |axis, slot| (at, Event::Name(axis, slot));
        events.push(name(axis, 7 - slot));
        if number % 7 == 6 {
            events.push(name((axis + 1) % AXES as u8, 1));
        }
        events.push((at + 3 * TICK, Event::Cut));
    }
    Stimulus::new(build, "cuts of short queues", &program, &sorted(events))
}

/// The host names the running segment, and the cut is decided in the last tick of this segment, in
/// the tick before, and in the tick after.
fn of_an_end(build: &EngineBuild, axis: u8) -> Vec<Stimulus> {
    // No segment is being written when the second one ends.
    let mut program: Program = (0..4).map(|place| segment(axis, 13, place == 3)).collect();
    program.extend([Command::Start { mask: 1 << axis }, Command::Wait { clocks: 9_000 }]);
    program.push(Command::Clear);
    let run = |name: &str, events: &Events| {
        let name = format!("cuts of axis {axis} that are decided {name} a segment ends");
        Stimulus::new(build, name, &program, events)
    };
    let last_tick = first_tick(&run("when", &Events::new())) + 2 * 13 - 1;
    let cut = |(name, decides): (&str, u64)| {
        // The tick before the one that decides is that of the request.
        let at = (decides - 1) * TICK + 40;
        run(name, &vec![(at - 5 * TICK, Event::Name(axis, 2)), (at, Event::Cut)])
    };
    let ticks = [("before", last_tick - 1), ("when", last_tick), ("after", last_tick + 1)];
    ticks.map(cut).into()
}

/// Cuts of all axes at once: all keep their segments, or one of them does not, which is another
/// axis each time.
fn of_all_axes(build: &EngineBuild) -> Stimulus {
    let row = |ticks, last| (0..AXES as u8).map(move |axis| segment(axis, ticks, last));
    let mut program: Program = (0..6).flat_map(|_| row(140, false)).collect();
    program.push(Command::Start { mask: 0x3f });
    program.extend((0..6).flat_map(|place| row(140, place == 5)));
    let mut events = Events::new();
    // Slot 1 runs in the 140 ticks after the start, which comes when the queues hold six rows.
    let started = 6 * 8 * AXES as u64 * TICK;
    for (number, wrong) in (0..=AXES as u64).enumerate() {
        let at = started + (160 + 70 * number as u64) * TICK;
        let names = (0..AXES as u8).map(|axis| {
            // The segment that ran long ago is not kept.
            let slot = if u64::from(axis) == wrong { 1 } else { 4 + number as u8 / 2 };
            (at, Event::Name(axis, slot))
        });
        events.extend(names);
        events.push((at + 9 * TICK, Event::Cut));
    }
    Stimulus::new(build, "cuts of all axes", &program, &events)
}

/// Cuts that are requested in any clock of a tick, several in a row, without a name, while a
/// segment is partly written, and names without a cut.
fn at_any_time(build: &EngineBuild) -> Stimulus {
    let mut program: Program = (0..5).map(|_| segment(2, 40, false)).collect();
    program.push(Command::Start { mask: 4 });
    program.extend((0..60).map(|place| segment(2, 40, place == 59)));
    let mut events = Events::new();
    for number in 0..40_u64 {
        let at = THEN + number * (23 * TICK + 7);
        events.push((at, Event::Name(2, (number % SLOTS) as u8)));
        events.push((at + TICK + 31, Event::Cut));
        match number % 5 {
            // Again in the next clock, two ticks later and three ticks later. In the tick between,
            // which examines the names, a request finds a difference: the gateware examines the
            // same names once more, where clock-by-clock.md and the model have forgotten them.
            0 => events.push((at + TICK + 32, Event::Cut)),
            1 => events.push((at + 3 * TICK + 31, Event::Cut)),
            2 => events.push((at + 4 * TICK + 31, Event::Cut)),
            // Another slot is named before the request, or after it.
            3 => events.push((at + TICK + 1, Event::Name(2, (number % 3) as u8))),
            _ => events.push((at + 2 * TICK + 5, Event::Name(2, (number % 3) as u8))),
        }
        if number % 6 == 5 {
            events.push((at + 9 * TICK, Event::Cut));
        }
    }
    Stimulus::new(build, "cuts at any time", &program, &sorted(events))
}

/// Names and requests that meet a stop, its clear, and a reset: none of them is left over.
fn with_stops(build: &EngineBuild) -> Stimulus {
    let mut program = Program::new();
    for _ in 0..5 {
        for axis in [1, 5] {
            program.extend((0..3).map(|place| segment(axis, 60, place == 2)));
        }
        program.push(Command::Start { mask: 0b10_0010 });
        program.extend([Command::Wait { clocks: 60 * TICK as u32 }, Command::Clear]);
        program.push(Command::Wait { clocks: 20 * TICK as u32 });
    }
    program.extend(cruise(5, [1 << 57; AXES]));
    let mut events = Events::new();
    for number in 0..8_u64 {
        let at = THEN + number * (61 * TICK + 29);
        events.push((at, Event::Name(1, number as u8)));
        events.push((at + 11, Event::Name(5, 2)));
        // The stop comes before, with and after the request.
        events.push((at + (4 + number) * TICK, Event::Cut));
        let stop = at + 7 * TICK + 43;
        if number % 3 == 2 {
            events.extend([(stop, Event::Reset(true)), (stop + 1, Event::Reset(false))]);
            events.push((stop + 4 * TICK, Event::Cut));
        } else {
            events.extend([(stop, Event::Stop(true)), (stop + 1, Event::Stop(false))]);
        }
    }
    Stimulus::new(build, "cuts and stops", &program, &sorted(events))
}

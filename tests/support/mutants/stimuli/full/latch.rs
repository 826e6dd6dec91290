//! Recordings of the latch: edges of any length at any time, armed or not.

use super::super::Stimulus;
use super::super::cruise::{TICK, both_ways, cruise};
use super::{THEN, sorted};
use carrystep_core::{EngineBuild, Program};
use carrystep_simulators::engine::{Event, Events};

/// Ticks that an edge takes in this build.
const LOOKS: u64 = 3;

pub(super) fn all(build: &EngineBuild) -> Vec<Stimulus> {
    let edges =
        |name: &str, events: Events| Stimulus::new(build, name, &program(), &sorted(events));
    vec![
        edges("edges of the latch", of_any_length()),
        edges("edges that are not latched", further()),
        edges("the latch is armed at its edge", armed_at_the_edge()),
        edges("resets of the latch", resets()),
    ]
}

/// All axes move, so that the words of every tick differ.
fn program() -> Program {
    let moves = |ticks| cruise(ticks, both_ways((1 << 56) + 98_765));
    [moves(900), moves(900)].concat()
}

/// The pin is active from a clock on, for this number of clocks.
fn pulse(at: u64, clocks: u64) -> [(u64, Event); 2] {
    [(at, Event::Latch(1)), (at + clocks, Event::Latch(0))]
}

/// Pulses for fewer and for more ticks than an edge takes, and gaps of all these lengths, from
/// every eighth clock of a tick on. Most of them find the latch armed.
fn of_any_length() -> Events {
    let mut events = Events::new();
    let mut at = THEN;
    for offset in 0..12 {
        for ticks in 1..=LOOKS + 1 {
            events.push((at, Event::LatchArm(1)));
            let begins = at + 8 * offset;
            events.extend(pulse(begins, ticks * TICK - 50));
            // A short gap, which the latch does not accept, and a second pulse.
            let again = begins + ticks * TICK - 50 + (ticks - 1) * TICK / 2;
            events.extend(pulse(again, 2 * TICK));
            at += 13 * TICK;
        }
    }
    events
}

/// More edges than the counter of further edges can count; then the latch is armed again, so that
/// the counter restarts.
fn further() -> Events {
    let mut events = vec![(THEN, Event::LatchArm(1))];
    for number in 0..40 {
        events.extend(pulse(THEN + TICK + number * (7 * TICK + 1), 3 * TICK + 10));
        if [20, 22, 29].contains(&number) {
            events.push((THEN + TICK + number * 7 * TICK, Event::LatchArm(1)));
        }
    }
    events
}

/// The latch is armed in each of the clocks around the one that accepts an edge.
fn armed_at_the_edge() -> Events {
    let mut events = Events::new();
    let first = THEN / TICK * TICK;
    for number in 0..12 {
        let at = first + number * 14 * TICK;
        events.extend(pulse(at, 5 * TICK));
        // The pin's flip-flops show the pulse at the strobe of the tick in which it begins.
        let accepts = at + LOOKS * TICK - 1;
        events.push((accepts + number - 6, Event::LatchArm(1)));
        if number % 2 == 0 {
            events.push((accepts + number - 5, Event::LatchArm(1)));
        }
    }
    events
}

/// Resets in which the latch is armed, its pin is active and accepted, or counted; it has counted
/// edges, and its words are just being output.
fn resets() -> Events {
    let mut events = Events::new();
    for number in 0..8 {
        let at = THEN + number * 40 * TICK;
        events.push((at, Event::LatchArm(1)));
        if number % 2 == 0 {
            events.extend(pulse(at + 2 * TICK, 4 * TICK));
            events.extend(pulse(at + 10 * TICK, 4 * TICK));
        }
        // From the freeze to the end of the reset it takes five ticks.
        let reset = at + 20 * TICK;
        events.extend([(reset, Event::Reset(true)), (reset + 1, Event::Reset(false))]);
        events.extend(pulse(reset + number * TICK / 2 + 11, (2 + number) * TICK));
        // Armed in the middle of the reset, which has no effect, and after it.
        events.push((reset + 5 * TICK / 2 + 7 * number, Event::LatchArm(1)));
    }
    events
}

//! The latch keeps the state of the very tick after the strobe that accepts its edge, and motion
//! does not change. An open interlock ramps the axes down, and no clear is possible until it closes.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_core::engine::{Cause, InputRow, Latch, LimitWiring, SeekSource, StatePage};
use carrystep_core::{EngineBuild, PinTiming, Segment};
use support::random::Random;
use support::script::{Act, Run, run};

/// An engine that only the interlock stops.
fn build(random: &mut Random, looks: u8) -> EngineBuild {
    let mut build = support::build(random);
    let guard = &mut build.guard;
    (guard.watchdog, guard.enable, guard.round, guard.debounce) = (0, 0, 4, 1);
    guard.limits = LimitWiring::None;
    guard.inputs = [InputRow { exist: 1, low: random.next() as u8 & 1 }; 2];
    guard.latches = vec![Latch::of_pin(random.below(2) == 0, looks)];
    build.pins.fill(PinTiming::SHORTEST);
    build
}

/// All axes accelerate for some hundred ticks.
fn moves(random: &mut Random, axes: usize) -> Vec<(usize, Act)> {
    let mut script: Vec<(usize, Act)> = (0..axes as u8)
        .map(|axis| {
            let (v, a) = (random.signed(60), random.signed(50));
            (0, Act::Segments(axis, vec![Segment { ticks: 600, v, a, j: 0, last: true }]))
        })
        .collect();
    script.push((0, Act::Start(((1_u16 << axes) - 1) as u8)));
    script
}

/// Asserts that an axis has, in this tick and on this page, the words that it has live in the other
/// run. The page of a hit has no word of beat 5.
fn assert_kept(kept: &Run, live: &Run, tick: usize, page: StatePage) {
    for (one, other) in kept.words(tick).iter().zip(live.words(tick)) {
        assert_eq!((one.page, other.page), (page, StatePage::Live), "tick {tick}");
        assert_eq!((one.p, one.position, one.ticks), (other.p, other.position, other.ticks));
        assert_eq!((one.status, one.ticks as usize), (other.status, tick));
        if page != StatePage::Seek {
            assert_eq!((one.left, one.discarded), (other.left, other.discarded));
        }
    }
}

#[test]
fn latched_words_are_those_of_the_tick_after_the_last_look() {
    let mut bounces = 0;
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let looks = random.one_of(&[1, 2, 3, 16]);
        let build = build(&mut random, looks);
        let per_tick = build.timebase.clocks_per_tick() as usize;
        let looks = usize::from(looks);
        let mut script = moves(&mut random, build.axes());
        let live = run(&build, &script, 250);
        let arm = 100 * per_tick + random.below(per_tick as u64) as usize;
        script.push((arm, Act::Arm));
        // The pin bounces: a pulse that too few strobes see is no edge.
        let mut at = arm + 1 + random.below(3 * per_tick as u64) as usize;
        for _ in 0..random.below(3) {
            let pulse = 1 + random.below(((looks - 1) * per_tick).max(1) as u64) as usize;
            if looks > 1 {
                script.extend([(at, Act::Latch(true)), (at + pulse, Act::Latch(false))]);
                bounces += 1;
                at += pulse + per_tick + random.below(per_tick as u64) as usize;
            }
        }
        script.push((at, Act::Latch(true)));
        let second = at + (looks + 2) * per_tick;
        script.push((second, Act::Latch(false)));
        script.push((second + (looks + 2) * per_tick, Act::Latch(true)));
        // A strobe sees the pin as it was two cycles before.
        let strobe =
            (0..).map(|k| k * per_tick + per_tick - 1).find(|at_strobe| at_strobe - 2 >= at);
        let tick = strobe.unwrap() / per_tick + looks;
        // The strobe that accepts the edge finds the request for a snapshot, which waits.
        script.push(((tick - 1) * per_tick + 20, Act::Snapshot));
        script.sort_by_key(|(at, _)| *at);
        let latched = run(&build, &script, 250);
        for axis in 0..build.axes() {
            assert_eq!(latched.ticks_on(StatePage::Latch, axis), [tick], "seed {seed}");
            assert_eq!(latched.ticks_on(StatePage::Snapshot, axis), [tick + 1], "seed {seed}");
            assert_eq!(live.edges(axis), latched.edges(axis), "seed {seed}, axis {axis}");
        }
        assert_kept(&latched, &live, tick, StatePage::Latch);
        let armed = |cycle: usize| latched.cycles[cycle].1.latch_armed == 1;
        assert!(!armed(arm) && armed(arm + 1) && armed(tick * per_tick - 1), "seed {seed}");
        assert!(!armed(tick * per_tick), "seed {seed}");
        let edges = latched.cycles.last().unwrap().1.latch_edges[0];
        assert_eq!(edges, 1, "seed {seed}: the second edge is counted only");
    }
    assert!(bounces > 20);
}

/// The latch, a hit and a snapshot want the same tick: the latch comes first, then the hit with the
/// state of its later tick, then the snapshot.
#[test]
fn hit_and_snapshot_come_after_the_latch() {
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let build = build(&mut random, 1);
        let per_tick = build.timebase.clocks_per_tick() as usize;
        let mut script = moves(&mut random, build.axes());
        let own = build.axes() == 1 && random.below(2) == 0;
        let source = SeekSource { axis: 0, row: 2, own, level: true };
        // An axis that seeks is at rest: a ramp would change its words.
        script.retain(|(_, act)| !matches!(act, Act::Segments(0, _)));
        let others = ((1_u16 << build.axes()) - 2) as u8;
        script.retain(|(_, act)| !matches!(act, Act::Start(_)));
        if others != 0 {
            script.push((0, Act::Start(others)));
        }
        let live = run(&build, &script, 150);
        let probe = 100 * per_tick + random.below(4 * per_tick as u64) as usize;
        // The sample of the probe is in clock 10 of the ticks 2, 6, 10 ...
        let tick = (0..).find(|tick| tick % 4 == 2 && tick * per_tick + 10 >= probe).unwrap();
        let edge = tick * per_tick - 2 + random.below(per_tick as u64) as usize;
        let mut tail = vec![
            (probe, Act::Switches(2, 1)),
            (edge, Act::Latch(true)),
            (tick * per_tick + 20, Act::Snapshot),
        ];
        tail.sort_by_key(|(at, _)| *at);
        script.extend([
            (50 * per_tick, Act::Source(source)),
            (51 * per_tick, Act::Seek(1)),
            (52 * per_tick, Act::Arm),
        ]);
        script.extend(tail);
        let run = run(&build, &script, 150);
        let ticks = |page| run.ticks_on(page, 0);
        assert_eq!(ticks(StatePage::Latch), [tick + 1], "seed {seed}");
        assert_eq!(ticks(StatePage::Seek), [tick + 2], "seed {seed}");
        assert_eq!(ticks(StatePage::Snapshot), [tick + 3], "seed {seed}");
        for (k, page) in (1..).zip([StatePage::Latch, StatePage::Seek, StatePage::Snapshot]) {
            assert_kept(&run, &live, tick + k, page);
        }
    }
}

#[test]
fn open_interlock_ramps_and_blocks_the_clear_until_it_closes() {
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let build = build(&mut random, 1);
        let per_tick = build.timebase.clocks_per_tick() as usize;
        let mut at = |tick: usize| tick * per_tick + random.below(per_tick as u64) as usize;
        let (open, clear, close) = (at(120), at(400), at(450));
        let mut script = moves(&mut random, build.axes());
        script.extend([
            (open, Act::Switches(3, 1)),
            (clear, Act::Clear(true)),
            (close, Act::Switches(3, 0)),
        ]);
        let run = run(&build, &script, 500);
        let first = run.cycles.iter().position(|(_, outputs)| outputs.fault.is_some()).unwrap();
        let tick = (0..).find(|tick| tick % 4 == 3 && tick * per_tick + 10 >= open).unwrap();
        assert_eq!(first, (tick + 1) * per_tick, "seed {seed}");
        assert_eq!(run.cycles[first].1.fault, Some((Cause::Interlock, 0)), "seed {seed}");
        assert!(run.cycles[1..].iter().all(|(_, outputs)| outputs.enabled), "seed {seed}");
        let lost = |axis| run.engine.shaper(axis).discarded;
        assert!((0..build.axes()).all(|axis| lost(axis) == 0), "seed {seed}: a ramp loses no step");
        let halted = run.cycles.iter().position(|(_, outputs)| outputs.halted).unwrap();
        assert!(halted < clear, "seed {seed}");
        let freed = run.cycles[first..].iter().position(|(_, outputs)| outputs.fault.is_none());
        let tick = (0..).find(|tick| tick % 4 == 3 && tick * per_tick + 10 >= close).unwrap();
        // The strobe of that tick begins the clear, and the next one ends it.
        assert_eq!(freed.map(|after| first + after), Some((tick + 2) * per_tick), "seed {seed}");
        assert!(run.cycles[first + freed.unwrap()..].iter().all(|(_, o)| o.fault.is_none()));
    }
}

//! Seeks: a hit ramps down its axes and no other, exactly; it is never a fault; what was armed or is
//! queued for a hit axis is dropped until the host ends the seek; any other limit stops all axes.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_core::engine::{
    Cause, InputRow, Latch, LimitWiring, SeekSource, StatePage, commanded_steps,
};
use carrystep_core::{EngineBuild, PinTiming, Segment};
use support::random::Random;
use support::script::{Act, Run, run};

/// The tick in which the host writes the seek, and the one in which the switches change.
const SEEK: u64 = 200;
const HIT: u64 = 240;

/// An engine that is stopped by nothing but limits and the interlock.
fn build(random: &mut Random) -> EngineBuild {
    let mut build = support::build(random);
    let all = ((1_u16 << build.axes()) - 1) as u8;
    let guard = &mut build.guard;
    (guard.watchdog, guard.enable) = (0, 0);
    guard.round = random.one_of(&[4, 8]);
    guard.inputs = [(); 2].map(|()| InputRow { exist: all, low: random.next() as u8 & all });
    guard.latches = vec![Latch::of_pin(false, 1)];
    build.pins.fill(PinTiming::SHORTEST);
    build
}

/// A cruise of all axes in three segments, and its speeds, 2^-64 step per tick.
fn cruise(random: &mut Random, axes: usize) -> (Vec<(usize, Act)>, Vec<i64>) {
    let speeds: Vec<i64> = (0..axes)
        .map(|_| {
            let v = (1 << 60) + (random.next() >> 4).cast_signed();
            if random.once_in(2) { -v } else { v }
        })
        .collect();
    let segment = |v, ticks, last| Segment { ticks, v, a: 0, j: 0, last };
    let mut script: Vec<(usize, Act)> = (0..)
        .zip(&speeds)
        .map(|(axis, &v)| {
            let segments =
                vec![segment(v, 190, false), segment(v, 50, false), segment(v, 5000, true)];
            (0, Act::Segments(axis, segments))
        })
        .collect();
    script.push((0, Act::Start(((1_u16 << axes) - 1) as u8)));
    (script, speeds)
}

/// The distance of a ramp of its own, whose first tick only finds the direction.
fn ramp(v: i64, stop: u64) -> i128 {
    let (v, stop) = (i128::from(v), i128::from(stop));
    let sum: i128 = (0..=v.abs() / stop).map(|k| v.abs() - k * stop).sum();
    v + sum * v.signum()
}

/// The commanded place of an axis on a page in a tick, 2^-64 step.
fn place(run: &Run, tick: usize, axis: usize) -> i128 {
    let words = run.words(tick)[axis];
    let steps = commanded_steps(words.position, words.status);
    (i128::from(steps) << 64) + i128::from(words.p)
}

/// A random source whose switches stop nothing at the level that is no hit, the axes that wait, and
/// the switches of its row that reach its level.
fn source(random: &mut Random, build: &EngineBuild) -> (SeekSource, u8, u8) {
    let all = ((1_u16 << build.axes()) - 1) as u8;
    let row = match build.guard.limits {
        LimitWiring::Pair => random.below(4),
        LimitWiring::Each => random.one_of(&[0, 2, 3]),
        _ => 2 + random.below(2),
    } as u8;
    let own = random.below(2) == 0;
    let axis = random.below(build.axes() as u64) as u8;
    let mut mask = random.next() as u8 & all | 1 << axis;
    let mut reached = if own { random.next() as u8 & all | 1 << axis } else { 1 << axis };
    if row < 2 {
        // The limit of an axis that does not wait would stop all axes.
        reached &= mask;
    }
    let mut source = SeekSource { axis, row, own, level: row < 2 || random.below(2) == 0 };
    if row == 3 {
        // The interlock stays closed.
        if axis == 0 {
            (source.level, mask, reached) = (true, mask & !1, 0);
        }
        (mask, reached) = (if own { mask & !1 } else { mask }, reached & !1);
    }
    (source, mask, reached)
}

#[test]
fn hit_ramps_its_axes_exactly_and_changes_no_edge_of_another() {
    let (mut own, mut common, mut level_0, mut limits) = (0, 0, 0, 0);
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let build = build(&mut random);
        let per_tick = build.timebase.clocks_per_tick() as usize;
        let (mut script, speeds) = cruise(&mut random, build.axes());
        let (source, mask, reached) = source(&mut random, &build);
        let all = ((1_u16 << build.axes()) - 1) as u8 & if source.row == 3 { !1 } else { u8::MAX };
        let levels = |reached: u8| {
            Act::Switches(source.row, all & if source.level { reached } else { !reached })
        };
        let any_clock = |random: &mut Random, tick: u64| {
            tick as usize * per_tick + random.below(per_tick as u64) as usize
        };
        script.push((1, levels(0)));
        script.push((any_clock(&mut random, SEEK), Act::Source(source)));
        script.push((any_clock(&mut random, SEEK + 1), Act::Seek(mask)));
        let free = run(&build, &script, 500);
        script.push((any_clock(&mut random, HIT), levels(reached)));
        let found = run(&build, &script, 500);
        assert!(free.is_free() && found.is_free(), "seed {seed}: a hit is no fault");
        let hit = match (source.own, reached) {
            (true, _) => mask & reached,
            (false, 0) => 0,
            (false, _) => mask,
        };
        own += u64::from(source.own && hit != 0 && hit != mask);
        common += u64::from(!source.own && hit != 0);
        level_0 += u64::from(!source.level && hit != 0);
        limits += u64::from(source.row < 2 && hit != 0);
        let last = found.cycles.last().unwrap().1;
        assert_eq!((last.seeking, last.hits), (mask & !hit, hit), "seed {seed}");
        for (axis, &v) in speeds.iter().enumerate() {
            let name = format!("seed {seed}, axis {axis}, {source:?}");
            let captured = found.ticks_on(StatePage::Seek, axis);
            if hit >> axis & 1 == 0 {
                assert_eq!(free.edges(axis), found.edges(axis), "{name}");
                assert_eq!(captured.len(), usize::from(!source.own && hit != 0), "{name}");
                continue;
            }
            let [tick] = captured[..] else { panic!("{name}: {captured:?}") };
            let goal = place(&found, tick, axis) + ramp(v, build.guard.stop[axis]);
            assert_eq!(found.place(axis), goal, "{name}");
        }
        // Whether the host ends the seek in the ramp or never, the ramps are the same.
        script.push((any_clock(&mut random, HIT + 6 * 8), Act::Seek(0)));
        let ended = run(&build, &script, 500);
        for axis in (0..build.axes()).filter(|axis| hit >> axis & 1 == 1) {
            assert_eq!(ended.edges(axis), found.edges(axis), "seed {seed}, axis {axis}");
        }
        let last = ended.cycles.last().unwrap().1;
        assert_eq!((last.seeking, last.hits), (0, 0), "seed {seed}");
    }
    assert!(
        [own, common, level_0, limits].iter().all(|&count| count > 10),
        "{own} {common} {level_0} {limits}"
    );
}

/// The host ends a seek, or never does. Until then a hit axis takes no segment and no start.
#[test]
fn hit_axis_drops_segments_and_starts_until_the_host_ends_the_seek() {
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let mut build = build(&mut random);
        build.guard.limits = LimitWiring::None;
        let per_tick = build.timebase.clocks_per_tick() as usize;
        let axis = random.below(build.axes() as u64) as u8;
        let source = SeekSource { axis, row: 2, own: random.below(2) == 0, level: true };
        let (mut script, _) = cruise(&mut random, build.axes());
        let more = |v| vec![Segment { ticks: 20, v, a: 0, j: 0, last: true }];
        let mut at = |tick: usize| tick * per_tick + random.below(per_tick as u64) as usize;
        script.extend([
            (at(200), Act::Source(source)),
            (at(201), Act::Seek(1 << axis)),
            // This start waits for the end of the cruise.
            (at(210), Act::Segments(axis, more(1 << 61))),
            (at(230), Act::Start(1 << axis)),
            (at(240), Act::Switches(2, 1 << axis)),
            // These find the axis in its ramp or at rest.
            (at(300), Act::Segments(axis, more(1 << 61))),
            (at(600), Act::Segments(axis, more(1 << 61))),
            (at(620), Act::Start(1 << axis)),
        ]);
        let kept = run(&build, &script, 900);
        script.extend([
            (at(700), Act::Seek(0)),
            (at(720), Act::Segments(axis, more(-(1 << 61)))),
            (at(740), Act::Start(1 << axis)),
        ]);
        let ended = run(&build, &script, 900);
        assert!(kept.is_free() && ended.is_free(), "seed {seed}");
        let starts = |run: &Run| run.cycles.iter().filter(|(_, outputs)| outputs.started).count();
        assert_eq!((starts(&kept), starts(&ended)), (1, 2), "seed {seed}");
        let at_rest = kept.words(890)[usize::from(axis)].status;
        // Three of the cruise, of which one or two were dropped, and three more.
        assert_eq!((at_rest.slot, at_rest.waiting, at_rest.running), (6, 0, false), "seed {seed}");
        let moved = ended.place(axis.into()) - kept.place(axis.into());
        assert_eq!(moved, -20 * (1 << 61), "seed {seed}");
    }
}

/// A source that already has its level is hit by its next sample, whether or not the axes move.
#[test]
fn source_with_its_level_is_hit_by_the_next_sample() {
    for seed in 0..200 {
        let mut random = Random::new(seed);
        let mut build = build(&mut random);
        build.guard.limits = LimitWiring::Pair;
        let per_tick = build.timebase.clocks_per_tick() as usize;
        let axis = random.below(build.axes() as u64) as u8;
        let row = random.below(4) as u8;
        let level = row != 3 && random.below(2) == 0;
        let source = SeekSource { axis, row, own: random.below(2) == 0, level };
        let at = 100 * per_tick + random.below(10 * per_tick as u64) as usize;
        let script = [
            (1, Act::Switches(row, if level { 1 << axis } else { 0 })),
            (at - 1, Act::Source(source)),
            (at, Act::Seek(1 << axis)),
        ];
        let run = run(&build, &script, 130);
        let round = build.guard.round as usize;
        // The seek counts from the cycle after its write on.
        let beat = 13 * usize::from(axis) + 12;
        let tick =
            (0..).find(|tick| tick % round == usize::from(row) && tick * per_tick + beat > at);
        let tick = tick.unwrap();
        let hit = if source.own { tick * per_tick + beat } else { (tick + 1) * per_tick - 1 };
        let first = run.cycles.iter().position(|(_, outputs)| outputs.hits != 0);
        assert_eq!(first, Some(hit + 1), "seed {seed}: {source:?}");
        let (_, before) = run.cycles[hit];
        assert_eq!(before.seeking, 1 << axis, "seed {seed}");
        let captured = run.ticks_on(StatePage::Seek, axis.into());
        assert_eq!(captured, [tick + 1], "seed {seed}");
        assert!(run.is_free());
    }
}

/// The first stop of a run.
fn fault(run: &Run) -> Option<(Cause, u8)> {
    run.cycles.iter().find_map(|(_, outputs)| outputs.fault)
}

#[test]
fn any_other_limit_than_the_source_stops_all_axes() {
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let mut build = build(&mut random);
        build.guard.limits = LimitWiring::Pair;
        // Ramps are long enough for the host to change the source in them.
        build.guard.stop.fill(1 << 52);
        let per_tick = build.timebase.clocks_per_tick() as usize;
        let axes = build.axes() as u8;
        let (cruise, speeds) = cruise(&mut random, axes.into());
        let axis = random.below(axes.into()) as u8;
        let other = (axis + 1) % axes;
        let toward = u8::from(speeds[usize::from(axis)] > 0);
        let own = |row| SeekSource { axis: 7, row, own: true, level: true };
        let common = |row| SeekSource { own: false, axis, ..own(row) };
        let probe = SeekSource { axis: 0, row: 2, own: false, level: true };
        let mut at = |tick: usize| tick * per_tick + random.below(per_tick as u64) as usize;
        let mut fault_of = |source, mask, then: Option<SeekSource>| {
            let mut script = cruise.clone();
            script.extend([
                (at(200), Act::Source(source)),
                (at(201), Act::Seek(mask)),
                (at(240), Act::Switches(toward, 1 << axis)),
            ]);
            script.extend(then.map(|source| (at(270), Act::Source(source))));
            fault(&run(&build, &script, 400))
        };
        let stops = Some((Cause::Limit, 1 << axis));
        for source in [own(toward), common(toward)] {
            assert_eq!(fault_of(source, 1 << axis, None), None, "seed {seed}: the source");
            assert_eq!(fault_of(source, 1 << axis, Some(probe)), stops, "seed {seed}: no longer");
            if other != axis {
                assert_eq!(fault_of(source, 1 << other, None), stops, "seed {seed}: not awaited");
            }
        }
        for source in [own(1 - toward), common(1 - toward), probe] {
            assert_eq!(fault_of(source, 1 << axis, None), stops, "seed {seed}: {source:?}");
        }
    }
}

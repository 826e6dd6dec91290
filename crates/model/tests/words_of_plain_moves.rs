//! In moves without a stop, the words of every tick are those of the closed form of the segments:
//! P, the commanded steps, the ticks left, the slot and the queue. Snapshots show the same.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_core::engine::{COMMIT, EngineInputs, LimitWiring, Put, StatePage, commanded_steps};
use carrystep_core::{EngineBuild, PinTiming, Segment};
use carrystep_model::Engine;
use std::collections::VecDeque;
use support::host::{Cycle, words};
use support::random::Random;
use support::words::{AxisWords, counted, of_tick, positions};

/// Ticks after each move, in which its last steps reach the pins.
const REST: u32 = 8;

/// What an axis has done up to the beginning of a move.
#[derive(Debug, Clone, Copy, Default)]
struct Done {
    /// Sum of all V since configuration, 2^-64 step.
    distance: i128,
    segments: usize,
}

/// The distance of the first `n` ticks of a segment, 2^-64 step: n V + n (n - 1) / 2 A
/// + n (n - 1) (n - 2) / 6 J.
fn distance(segment: &Segment, n: u32) -> i128 {
    let n = i128::from(n);
    let [v, a, j] = [segment.v, segment.a, segment.j].map(i128::from);
    n * v + n * (n - 1) / 2 * a + n * (n - 1) * (n - 2) / 6 * j
}

/// A move of up to seven segments for each axis.
fn plan(random: &mut Random, axes: usize) -> Vec<Vec<Segment>> {
    let plan_axis = |_| {
        let count = 1 + random.below(7);
        let segment = |k| Segment {
            ticks: 1 + random.below(60) as u32,
            v: random.next().cast_signed() >> (2 + random.below(4)),
            a: random.signed(54),
            j: random.signed(47),
            last: k + 1 == count,
        };
        (0..count).map(segment).collect()
    };
    (0..axes).map(plan_axis).collect()
}

/// Executes a move, with snapshots in any clock. Returns its cycles from the beginning of a tick
/// on, and the tick of the start among them.
fn execute(engine: &mut Engine, random: &mut Random, plan: &[Vec<Segment>]) -> (Vec<Cycle>, usize) {
    let build = engine.motion().build();
    let per_tick = build.timebase.clocks_per_tick() as usize;
    let rests_at = EngineInputs::default().levels(&build.guard);
    let mut words: VecDeque<Put> = (0_u8..)
        .zip(plan)
        .flat_map(|(axis, segments)| segments.iter().flat_map(move |s| words(axis, *s)))
        .collect();
    let mask = (1_u16 << plan.len()) - 1;
    let total = |segments: &Vec<Segment>| segments.iter().map(|s| s.ticks).sum::<u32>();
    let longest = plan.iter().map(total).max().unwrap_or(0);
    let (mut cycles, mut start, mut offered) = (Vec::new(), None, false);
    while start
        .is_none_or(|start| cycles.len() < (start + longest as usize + REST as usize) * per_tick)
    {
        // A segment that is committed in a tick can be started from the next one on.
        let start_now = words.is_empty() && !offered;
        let inputs = EngineInputs {
            put: words.front().copied(),
            start: start_now.then_some(mask as u8),
            snapshot: random.once_in(100),
            enable: true,
            ..rests_at
        };
        let outputs = engine.outputs(&inputs);
        if outputs.put_ready {
            words.pop_front();
        }
        offered |= start_now && outputs.start_ready;
        if outputs.started {
            start = Some(cycles.len() / per_tick);
        }
        assert_eq!(outputs.fault, None);
        engine.clock(&inputs);
        cycles.push((inputs, outputs));
    }
    (cycles, start.unwrap_or_default())
}

/// Checks the words of an axis after `n` ticks of its move.
fn check(build: &EngineBuild, words: &AxisWords, done: Done, plan: &[Segment], n: u32) {
    let (mut before, mut begun, mut left) = (0, 0, None);
    let mut moved = done.distance;
    for segment in plan {
        if n >= before {
            begun += 1;
            moved += distance(segment, segment.ticks.min(n - before));
            let ticks = n - before;
            left = (ticks < segment.ticks).then(|| segment.ticks - 1 - ticks);
        }
        before += segment.ticks;
    }
    let sum = i128::from(build.phase.start_value()) + moved;
    assert_eq!(words.p, sum as u64, "P after {n} ticks");
    let commanded = commanded_steps(words.position, words.status);
    assert_eq!(commanded, (sum >> 64) as i32, "commanded steps after {n} ticks");
    assert_eq!((words.status.running, words.left), (left.is_some(), left), "after {n} ticks");
    let slot = (done.segments + begun) % 8;
    assert_eq!(usize::from(words.status.slot), slot, "slot after {n} ticks");
    assert_eq!(usize::from(words.status.waiting), plan.len() - begun, "after {n} ticks");
}

#[test]
fn words_of_every_tick_are_those_of_the_closed_form() {
    let (mut snapshots, mut steps, mut reversed) = (0, 0, 0);
    for seed in 0..150 {
        let mut random = Random::new(seed);
        let mut build = support::build(&mut random);
        build.guard.limits = LimitWiring::None;
        build.guard.watchdog = 0;
        build.pins.fill(PinTiming::SHORTEST);
        let axes = build.axes();
        let per_tick = build.timebase.clocks_per_tick() as usize;
        let mut engine = Engine::new(&build);
        let mut done = vec![Done::default(); axes];
        let mut history: Vec<Cycle> = Vec::new();
        let mut count = vec![0; axes];
        for _ in 0..3 {
            let plan = plan(&mut random, axes);
            let first = history.len() / per_tick;
            let (cycles, start) = execute(&mut engine, &mut random, &plan);
            history.extend(cycles);
            let made = positions(&history, axes);
            let mut queued = vec![0; axes];
            for tick in first..history.len() / per_tick {
                let from = tick * per_tick;
                let cycles = &history[from..from + per_tick];
                if tick == 0 {
                    assert!(cycles.iter().all(|(_, o)| o.state.is_none() && !o.refreshed));
                    continue;
                }
                for (axis, words) in of_tick(cycles, axes).iter().enumerate() {
                    assert_eq!(words.ticks as usize, tick);
                    assert_eq!(words.position, count[axis], "counted in tick {tick}");
                    let next = counted(count[axis], made[from + 13 * axis + 6][axis]);
                    steps += u64::from(next != count[axis]);
                    reversed += u64::from(next < count[axis]);
                    count[axis] = next;
                    snapshots += u64::from(words.page == StatePage::Snapshot);
                    if tick > first + start {
                        let n = (tick - first - start - 1) as u32;
                        check(&build, words, done[axis], &plan[axis], n);
                    } else {
                        // Segments are only queued.
                        assert_eq!(usize::from(words.status.waiting), queued[axis]);
                        assert!(!words.status.running);
                    }
                }
                for (inputs, outputs) in cycles {
                    let put = inputs.put.filter(|put| outputs.put_ready && put.word == COMMIT);
                    put.iter().for_each(|put| queued[usize::from(put.axis)] += 1);
                }
            }
            for (done, plan) in done.iter_mut().zip(&plan) {
                done.segments += plan.len();
                done.distance += plan.iter().map(|s| distance(s, s.ticks)).sum::<i128>();
            }
        }
    }
    assert!(snapshots > 1000 && steps > 2000 && reversed > 1000, "{snapshots} {steps} {reversed}");
}

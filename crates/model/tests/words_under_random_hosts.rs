//! Under a host that does everything, the words of every tick agree with books that are kept
//! differently: steps are counted on the pins, carries are the overflows of the exact sum of all
//! changes of P, segments are counted as they are committed, and switches, hits of seeks, edges of
//! the latch and snapshots are found in the history of the inputs.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_core::EngineBuild;
use carrystep_core::engine::COMMIT;
use carrystep_model::Engine;
use support::books::{Around, Counts};
use support::host::{Cycle, Host};
use support::random::Random;
use support::words::{AxisWords, counted, of_tick, positions};

/// What is read from an axis' registers in a tick.
#[derive(Debug, Clone, Copy)]
struct Registers {
    p: u64,
    waiting: usize,
    /// The discarded steps of the shaper in beat 4.
    discarded: u32,
}

/// A run: its cycles, and the registers of all axes in each tick.
struct Run {
    cycles: Vec<Cycle>,
    registers: Vec<Vec<Registers>>,
}

fn run(build: &EngineBuild, seed: u64, ticks: usize) -> Run {
    let per_tick = build.timebase.clocks_per_tick() as usize;
    let (mut engine, mut host) = (Engine::new(build), Host::new(build, seed));
    let mut run = Run { cycles: Vec::new(), registers: Vec::new() };
    for cycle in 0..ticks * per_tick {
        let clock = cycle % per_tick;
        let now = |axis| Registers {
            p: engine.fraction(axis),
            waiting: engine.motion().waiting(axis),
            discarded: engine.shaper(axis).discarded,
        };
        if clock == 0 {
            run.registers.push((0..build.axes()).map(now).collect());
        } else if clock % 13 == 4 && clock / 13 < build.axes() {
            run.registers[cycle / per_tick][clock / 13].discarded = now(clock / 13).discarded;
        }
        let inputs = host.inputs(&engine);
        let outputs = engine.outputs(&inputs);
        engine.clock(&inputs);
        host.clock(&inputs, &outputs);
        run.cycles.push((inputs, outputs));
    }
    run
}

/// The books of an axis.
#[derive(Debug, Clone, Copy, Default)]
struct Books {
    /// P and all carries since the queues were emptied last, as one number.
    sum: i128,
    /// The position that was counted then.
    base: i32,
    position: i32,
    discarded: u32,
    /// Segments that came into the queue since then.
    segments: usize,
}

/// How often things have happened that the test is about.
#[derive(Debug, Default)]
struct Met {
    /// Ticks with a discarded step.
    discarded: u64,
    /// Clears of axes with steps on their way.
    dropped_steps: u64,
    /// Ticks in which a seek has dropped several segments.
    dropped_segments: u64,
    /// Resets of axes with discarded steps.
    resets: u64,
}

fn check(build: &EngineBuild, run: &Run, met: &mut Met) -> Counts {
    let (axes, per_tick) = (build.axes(), build.timebase.clocks_per_tick() as usize);
    let start = build.phase.start_value();
    let made = positions(&run.cycles, axes);
    let mut books = vec![Books { sum: start.into(), ..Books::default() }; axes];
    let mut before: Vec<Option<AxisWords>> = vec![None; axes];
    let mut around = Around::new(build);
    let (mut resetting, mut was_emptied) = (0, false);
    for tick in 0..run.registers.len() - 1 {
        let (from, to) = (tick * per_tick, (tick + 1) * per_tick);
        let cycles = &run.cycles[from..to];
        let words = if tick == 0 { Vec::new() } else { of_tick(cycles, axes) };
        for (axis, words) in words.iter().enumerate() {
            let Books { sum, base, position, discarded, segments } = books[axis];
            let registers = run.registers[tick][axis];
            let carries = (sum >> 64) as i32;
            let on_way = carries - (position - base);
            let place = format!("axis {axis} in tick {tick}");
            assert_eq!(words.page, around.page_of[axis], "{place}");
            assert_eq!(words.p, registers.p, "{place}");
            assert_eq!(words.ticks as usize, tick, "{place}");
            assert_eq!(words.position, position, "{place}");
            assert!(words.discarded.is_none_or(|word| word == discarded), "{place}");
            assert_eq!((i32::from(words.status.on_way) - on_way) % 16, 0, "{place}");
            assert_eq!(usize::from(words.status.waiting), registers.waiting, "{place}");
            let begun = segments - registers.waiting;
            assert_eq!(usize::from(words.status.slot), begun % 8, "{place}");
            let rests = cycles[0].1.halted || cycles[0].1.idle;
            assert!(!(rests && words.status.running), "{place}");
            let last = before[axis].replace(*words);
            let slots = last.map_or(0, |last| words.status.slot.wrapping_sub(last.status.slot) & 7);
            met.dropped_segments +=
                u64::from(slots > 1 && cycles[0].1.fault.is_none() && !was_emptied);
        }
        // The strobe that ends this tick.
        resetting = if cycles[0].1.resetting { resetting + 1 } else { 0 };
        let is_cleared = cycles[0].1.fault.is_some() && run.cycles[to].1.fault.is_none();
        let forgets = resetting > 1;
        let empties = forgets || is_cleared;
        for (axis, books) in books.iter_mut().enumerate() {
            let registers = run.registers[tick][axis];
            let runs = words.get(axis).is_some_and(|words| words.status.running);
            if tick > 0 {
                books.position = counted(books.position, made[from + 13 * axis + 6][axis]);
            }
            if registers.discarded != books.discarded && !runs {
                books.discarded += 1;
                met.discarded += 1;
            }
            let v = run.registers[tick + 1][axis].p.wrapping_sub(registers.p).cast_signed();
            assert!(runs || v == 0 || empties, "axis {axis} moves in tick {tick}");
            books.sum += i128::from(v);
            let commits = |(inputs, outputs): &&Cycle| {
                let put = inputs.put.filter(|put| usize::from(put.axis) == axis);
                outputs.put_ready && put.is_some_and(|put| put.word == COMMIT)
            };
            books.segments += cycles.iter().filter(commits).count();
            if empties {
                let on_way = before[axis].map_or(0, |words| words.status.on_way);
                met.dropped_steps += u64::from(on_way != 0);
                (books.sum, books.base, books.segments) = (start.into(), books.position, 0);
            }
            if forgets {
                met.resets += u64::from(books.discarded != 0);
                books.discarded = 0;
            }
        }
        was_emptied = empties;
        let switches: Vec<_> = words.iter().map(|words| words.switch).collect();
        around.tick(&run.cycles, (from, to), &switches);
    }
    around.counts
}

#[test]
fn words_of_every_tick_agree_with_books_that_are_kept_differently() {
    let mut met = Met::default();
    let mut counts = [0; 10];
    for seed in 0..400 {
        let mut random = Random::new(seed);
        let build = support::build(&mut random);
        let of_run = check(&build, &run(&build, random.next(), 1000), &mut met).all();
        counts.iter_mut().zip(of_run).for_each(|(sum, count)| *sum += count);
    }
    let Met { discarded, dropped_steps, dropped_segments, resets } = met;
    let all = [discarded, dropped_steps, dropped_segments, resets];
    assert!(all.iter().chain(&counts).all(|&count| count > 1), "{met:?} {counts:?}");
}

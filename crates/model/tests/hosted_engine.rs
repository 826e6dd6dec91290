//! The fast engine with its readout equals the engine clock by clock, whatever clocks its leaps end
//! in, and a memory that receives the words of its leaps equals one that receives every word.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_core::EngineBuild;
use carrystep_core::engine::{Latch, StateItem, StatePage, StateWord};
use carrystep_model::fast::{Change, Edge};
use carrystep_model::{Engine, HostedEngine};
use support::host::{Cycle, run};
use support::random::Random;

/// What the comparisons have met.
#[derive(Debug, Default)]
struct Met {
    edges: u64,
    leapt: u64,
    clocks: u64,
    discarded: u64,
    /// Words of each page.
    pages: [u64; 4],
    /// Words of switches.
    switches: u64,
    hits: u64,
    edges_of_the_latch: u64,
    /// Changes of the records that latches hold.
    records: u64,
    /// Leaps that ended in each beat of a time slot.
    ends: [u64; 13],
    faults: u64,
    clears: u64,
    resets: u64,
}

/// The last word of each address; the words of page 3 in each record.
struct Memory([u32; 1024]);

impl Memory {
    fn store(&mut self, word: StateWord) {
        let record = if word.page == StatePage::Latch { word.record } else { 0 };
        self.0[usize::from(record) << 8 | usize::from(word.address())] = word.word;
    }
}

/// Repeats recorded inputs on the fast engine. Its leaps have random lengths, but never go beyond
/// a change of the inputs.
fn compare(build: &EngineBuild, history: &[Cycle], random: &mut Random, met: &mut Met) {
    let (mut fast, mut slow) = (HostedEngine::new(build), Engine::new(build));
    let (mut fast_edges, mut slow_edges) = (Vec::new(), Vec::new());
    let (mut fast_memory, mut slow_memory) = (Memory([0; 1024]), Memory([0; 1024]));
    let per_tick = u64::from(build.timebase.clocks_per_tick());
    let longest = random.one_of(&[30, 300, 3000, u64::MAX]);
    while let Some((inputs, outputs)) = history.get(fast.cycle() as usize) {
        let from = fast.cycle();
        let rest = &history[from as usize..];
        let same = rest.iter().take_while(|(other, _)| other == inputs).count() as u64;
        let most = same.min(1 + random.below(longest));
        let leapt = fast.leap(inputs, most, &mut fast_edges, &mut |word| fast_memory.store(word));
        if leapt == 0 {
            assert_eq!(fast.outputs(inputs), *outputs, "outputs in cycle {from}");
            outputs.state.into_iter().for_each(|word| fast_memory.store(word));
            fast.clock(inputs, &mut fast_edges);
        } else if fast.cycle() % per_tick < 13 {
            met.ends[(fast.cycle() % per_tick) as usize] += 1;
        }
        met.leapt += leapt;
        for cycle in from..fast.cycle() {
            let (inputs, outputs) = &history[cycle as usize];
            assert_eq!(slow.outputs(inputs), *outputs);
            outputs.state.into_iter().for_each(|word| slow_memory.store(word));
            let before: Vec<_> = (0..build.axes()).map(|axis| *slow.shaper(axis)).collect();
            slow.clock(inputs);
            for (axis, before) in (0..).zip(&before) {
                let (clock, now) = (cycle + 1, slow.shaper(axis));
                let edge = |change| Edge { clock, axis: axis as u8, change, backward: now.dir };
                slow_edges.extend((now.step && !before.step).then(|| edge(Change::Rise)));
                slow_edges.extend((now.dir != before.dir).then(|| edge(Change::DirChange)));
            }
        }
        let now = fast.cycle();
        assert_eq!(fast_edges, slow_edges, "edges up to cycle {now}");
        assert_eq!(fast.core(), slow.motion(), "motion in cycle {now}");
        assert_eq!(fast.readout(), slow.readout(), "readout in cycle {now}");
        assert_eq!(fast_memory.0, slow_memory.0, "memory in cycle {now}, after {leapt} clocks");
        met.edges += fast_edges.len() as u64;
        fast_edges.clear();
        slow_edges.clear();
    }
    met.clocks += fast.cycle();
    met.discarded +=
        (0..build.axes()).map(|axis| u64::from(slow.shaper(axis).discarded)).sum::<u64>();
}

#[test]
fn leaps_that_end_in_any_clock_leave_the_registers_and_words_of_every_clock() {
    let mut met = Met::default();
    for seed in 0..200 {
        let mut random = Random::new(seed);
        let mut build = support::build(&mut random);
        // Every second build that has a latch has more of them, two of which look alike.
        if let (Some(&latch), 0) = (build.guard.latches.first(), seed % 2) {
            let looks = latch.looks % 16 + 1;
            build.guard.latches.extend([latch, Latch { looks, ..latch }]);
        }
        let history = run(&build, random.next(), 60_000);
        for pair in history.windows(2) {
            let [now, next] = [&pair[0].1, &pair[1].1];
            met.faults += u64::from(now.fault.is_none() && next.fault.is_some());
            met.clears += u64::from(now.fault.is_some() && next.fault.is_none());
            met.resets += u64::from(now.resetting && !next.resetting);
            met.hits += u64::from(next.hits & !now.hits != 0);
            met.edges_of_the_latch += u64::from(next.latch_edges > now.latch_edges);
            met.records += u64::from(next.latch_records != now.latch_records);
            match now.state.of_adder(0) {
                Some(word) if word.item == StateItem::Switch => met.switches += 1,
                Some(word) => met.pages[word.page as usize] += 1,
                None => {}
            }
        }
        compare(&build, &history, &mut random, &mut met);
    }
    assert!(met.leapt > met.clocks / 4, "{met:?}");
    assert!(met.edges > 5000 && met.discarded > 100, "{met:?}");
    assert!(met.pages.iter().all(|&words| words > 1000), "{met:?}");
    assert!(met.ends.iter().all(|&ends| ends > 10), "{met:?}");
    assert!(met.switches > 100_000 && met.edges_of_the_latch > 20, "{met:?}");
    assert!(met.records > 20, "{met:?}");
    assert!(
        [met.faults, met.clears, met.resets, met.hits].iter().all(|&count| count > 20),
        "{met:?}"
    );
}

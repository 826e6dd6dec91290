//! Several latches: each keeps the state of the tick after its edge, whatever the others do, until
//! it is armed again; and arming one that is not there is a fault.

#![allow(clippy::unwrap_used)] // a test may panic

use carrystep_core::engine::{
    Cause, EngineBuild, EngineInputs, EngineOutputs, Guard, Latch, MAX_LATCHES, StateItem,
    StatePage,
};
use carrystep_core::{AXES, Build, PinTiming, StartPhase, Timebase};
use carrystep_model::Engine;
use std::collections::BTreeMap;

fn build(latches: &[Latch]) -> EngineBuild {
    let timebase = Timebase::new(64_000_000, 1000, 4).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, 1 << 40);
    build.pins.truncate(2);
    build.guard = Guard { latches: latches.to_vec(), ..Guard::minimal(vec![1 << 40; 2]) };
    build.check().unwrap();
    build
}

/// An engine, and what a host keeps of it: the words of each record, by axis and item.
struct Bench {
    engine: Engine,
    per_tick: u32,
    records: [BTreeMap<(u8, u8), u32>; 4],
    /// The outputs of the last clock.
    outputs: EngineOutputs,
}

impl Bench {
    fn new(build: &EngineBuild) -> Self {
        Self {
            engine: Engine::new(build),
            per_tick: build.timebase.clocks_per_tick(),
            records: Default::default(),
            outputs: EngineOutputs::default(),
        }
    }

    /// Runs for one tick with these levels of the pins; the latches of `arm` are armed in its first
    /// clock. Returns the fault at its end.
    fn tick(&mut self, latch: u8, arm: u8) -> Option<Cause> {
        for clock in 0..self.per_tick {
            let latch_arm = if clock == 0 { arm } else { 0 };
            let inputs = EngineInputs { latch, latch_arm, ..EngineInputs::default() };
            self.outputs = self.engine.outputs(&inputs);
            if let Some(word) = self.outputs.state.of_adder(0)
                && word.page == StatePage::Latch
            {
                let record = &mut self.records[usize::from(word.record)];
                record.insert((word.axis, word.item as u8), word.word);
            }
            self.engine.clock(&inputs);
        }
        self.outputs.fault.map(|(cause, _)| cause)
    }

    /// The number of the tick that the record of this latch holds.
    fn tick_of(&self, latch: usize) -> u32 {
        let record = &self.records[usize::from(self.outputs.latch_records[latch])];
        assert_eq!(record[&(0, StateItem::Ticks as u8)], record[&(1, StateItem::Ticks as u8)]);
        record[&(0, StateItem::Ticks as u8)]
    }
}

#[test]
fn latches_of_one_strobe_share_a_record_and_keep_it() {
    let mut bench = Bench::new(&build(&[Latch::of_pin(false, 1); MAX_LATCHES]));
    bench.tick(0, 0b0011);
    bench.tick(0b0011, 0);
    bench.tick(0, 0);
    bench.tick(0, 0b0010);
    let both = bench.tick_of(0);
    assert_eq!(bench.outputs.latch_records[..2], [1, 1]);
    bench.tick(0b0010, 0);
    bench.tick(0, 0);
    bench.tick(0, 0);
    assert_eq!(bench.outputs.latch_records, [1, 2, 0, 0]);
    assert_eq!((bench.tick_of(0), bench.tick_of(1)), (both, both + 3));
}

/// A random host arms latches whose pins change at random; it knows the tick of the last edge of
/// each latch from the pins alone.
#[test]
fn each_latch_holds_the_tick_of_its_own_edge_until_it_is_armed_again() {
    for count in 2..=MAX_LATCHES {
        let latches: Vec<Latch> =
            (0..count).map(|number| Latch::of_pin(number % 2 == 1, 1)).collect();
        let all = (1_u8 << count) - 1;
        let low = 0b1010 & all;
        let mut bench = Bench::new(&build(&latches));
        let mut state = 1_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as u32
        };
        let (mut active, mut armed) = (0_u8, 0_u8);
        let mut expected: [Option<u32>; MAX_LATCHES] = [None; MAX_LATCHES];
        let mut shared = 0;
        // The pins rest at their inactive levels for two ticks.
        for tick in 0..3000_u32 {
            let arm = if random() % 4 == 0 { random() as u8 & all } else { 0 };
            armed |= arm;
            for (latch, expected) in expected.iter_mut().enumerate() {
                if arm >> latch & 1 == 1 {
                    *expected = None;
                }
            }
            let before = active;
            if tick > 2 && random() % 2 == 0 {
                active = random() as u8 & all;
            }
            let edges = active & !before;
            assert_eq!(bench.tick(active ^ low, arm), None);
            let hits = edges & armed;
            armed &= !edges;
            shared += u32::from(hits.count_ones() > 1);
            for (latch, expected) in expected.iter_mut().enumerate().take(count) {
                if hits >> latch & 1 == 1 {
                    // The words are output in the tick after the strobe that accepts the edge.
                    *expected = Some(tick + 1);
                } else if let Some(tick_of_edge) = expected
                    && *tick_of_edge <= tick
                {
                    assert_eq!(bench.tick_of(latch), *tick_of_edge, "latch {latch}, tick {tick}");
                }
            }
        }
        assert!(shared > 20, "{shared}");
    }
}

#[test]
fn arming_a_latch_that_is_not_there_is_a_fault_in_a_build_with_several() {
    let latch = Latch::of_pin(false, 1);
    for (count, arm, fault) in [
        (0, 1, None),
        (1, 0b1110, None),
        (2, 0b0011, None),
        (2, 0b0100, Some(Cause::Protocol)),
        (3, 0b1000, Some(Cause::Protocol)),
        (4, 0b1111, None),
    ] {
        let mut bench = Bench::new(&build(&vec![latch; count]));
        bench.tick(0, 0);
        assert_eq!(bench.tick(0, arm), fault, "{count} latches, {arm:#b}");
    }
}

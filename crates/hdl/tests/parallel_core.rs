//! Checks the parallel core at its ports: starts, latency, faults, clear and its number of axes.

use carrystep_core::ports::{Inputs, Outputs};
use carrystep_core::{AXES, Build, PinTiming, Segment, StartPhase, Timebase};
use carrystep_hdl::ParallelSim;

const C: u64 = 48;
const LAST: Segment = Segment { ticks: 8, v: 1 << 61, a: 0, j: 0, last: true };

struct Bench {
    core: ParallelSim,
    cycle: u64,
}

impl Bench {
    fn new() -> Self {
        Self::of_axes(AXES)
    }

    fn of_axes(axes: usize) -> Self {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        let pins = [PinTiming { step_high: 5, step_low: 5, dir_setup: 2, dir_hold: 2 }; AXES];
        let build = Build { timebase, phase: StartPhase::Half, pins };
        Self { core: ParallelSim::new(&build, axes).unwrap(), cycle: 0 }
    }

    fn clock(&mut self, inputs: Inputs) -> Outputs {
        let outputs = self.core.settle(&inputs);
        self.core.clock();
        self.cycle += 1;
        outputs
    }

    fn rest(&mut self) -> Outputs {
        self.clock(Inputs::default())
    }

    fn segment(&mut self, axis: u8, segment: Segment) -> bool {
        self.clock(Inputs { segment: Some((axis, segment)), ..Inputs::default() }).seg_ready
    }

    fn start(&mut self, mask: u8) -> bool {
        self.clock(Inputs { start: Some(mask), ..Inputs::default() }).start_ready
    }

    /// Runs until the outputs fulfil the condition. Returns the first cycle in which they do.
    fn until(&mut self, what: impl Fn(&Outputs) -> bool) -> u64 {
        for _ in 0..10_000 {
            if what(&self.rest()) {
                return self.cycle - 1;
            }
        }
        panic!("it never happens");
    }
}

#[test]
fn first_edge_appears_after_the_latency() {
    let mut bench = Bench::new();
    assert!(bench.segment(2, LAST) && bench.start(1 << 2));
    let loaded = bench.until(|o| o.started) + 1;
    assert_eq!(loaded % C, 0);
    // P begins at half a step and V is 1/8 step per tick: tick 4 carries at its very end.
    let edge = bench.until(|o| o.step == 1 << 2);
    assert_eq!(edge, loaded + 3 * C + 15 * 3 + 2 * C + 1);
    bench.until(|o| o.idle);
    assert_eq!(bench.rest().position, [0, 0, 1, 0, 0, 0]);
    assert!((0..AXES).all(|axis| bench.core.fraction(axis) == Some(1 << 63)));
}

#[test]
fn all_axes_of_a_start_mask_start_on_one_tick() {
    let mut bench = Bench::new();
    for axis in 0..6 {
        let v = if axis % 2 == 0 { LAST.v } else { -LAST.v };
        assert!(bench.segment(axis, Segment { v, ..LAST }));
    }
    assert!(!bench.segment(3, LAST), "one segment waits, a second is not taken");
    assert!(bench.start(0x3f));
    assert!(!bench.start(0), "a start is armed");
    bench.until(|o| o.step == 0x15);
    bench.until(|o| o.idle);
    assert_eq!(bench.rest().position, [1, -1, 1, -1, 1, -1]);
}

#[test]
fn start_of_an_axis_without_a_segment_is_a_protocol_fault() {
    let mut bench = Bench::new();
    bench.segment(0, LAST);
    bench.start(3);
    let outputs = bench.rest();
    assert!(outputs.faults.protocol && !outputs.seg_ready && !outputs.start_ready);
    bench.clock(Inputs { clear: true, ..Inputs::default() });
    assert!(!bench.rest().faults.any());
    assert!(bench.segment(0, LAST), "the queue is empty after a clear");
}

#[test]
fn segment_for_no_axis_or_of_zero_ticks_is_a_protocol_fault() {
    for (axis, ticks) in [(6, 1), (7, 1), (0, 0)] {
        let mut bench = Bench::new();
        assert!(bench.segment(axis, Segment { ticks, ..LAST }));
        assert!(bench.rest().faults.protocol);
    }
}

/// The last axis of each core moves, and the one after it does not exist.
#[test]
fn core_has_as_many_axes_as_were_asked_for() {
    for axes in 1..=AXES {
        let mut bench = Bench::of_axes(axes);
        let last = axes as u8 - 1;
        assert!(bench.segment(last, LAST));
        assert!(bench.start(0xff << last), "the mask has no bit for a further axis");
        bench.until(|o| o.started);
        bench.until(|o| o.idle);
        let outputs = bench.rest();
        assert_eq!(outputs.position.iter().sum::<i32>(), 1);
        assert_eq!((outputs.position[axes - 1], outputs.faults.any()), (1, false));
        assert_eq!(bench.core.fraction(axes), None);
        assert!(bench.segment(last + 1, LAST), "taken, and the protocol fault");
        assert!(bench.rest().faults.protocol);
    }
}

#[test]
fn other_numbers_of_axes_are_refused() {
    let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    for axes in [0, 7, usize::MAX] {
        let error = ParallelSim::new(&build, axes).err().unwrap();
        assert_eq!(error.to_string(), format!("{axes} axes: the parallel core has 1 to 6"));
    }
}

#[test]
fn underrun_freezes_all_axes_until_clear() {
    let mut bench = Bench::new();
    bench.segment(0, Segment { last: false, ..LAST });
    bench.segment(5, Segment { ticks: 1000, ..LAST });
    bench.start(0x21);
    bench.until(|o| o.faults.underrun == 1);
    for _ in 0..3 * C {
        bench.rest();
    }
    let frozen = bench.rest();
    assert_eq!(frozen.step, 0);
    let clear = Inputs { clear: true, ..Inputs::default() };
    bench.clock(clear);
    let after = bench.rest();
    assert!(!after.faults.any() && after.idle);
    assert_eq!((after.position, after.discarded), (frozen.position, frozen.discarded));
}

#[test]
fn step_rate_above_the_pin_timing_is_an_overrun() {
    let mut bench = Bench::new();
    let timebase = Timebase::new(16_000_000, 1000, 16).unwrap();
    let pins = [PinTiming { step_high: 40, step_low: 40, dir_setup: 1, dir_hold: 1 }; AXES];
    bench.core =
        ParallelSim::new(&Build { timebase, phase: StartPhase::Half, pins }, AXES).unwrap();
    bench.segment(4, Segment { ticks: 1000, v: i64::MAX, ..LAST });
    bench.start(1 << 4);
    bench.until(|o| o.faults.overrun == 1 << 4);
    bench.until(|o| o.step == 0);
    // Every carry is a pulse or is counted as discarded. Here one pulse was made; the shaper and
    // the freeze discarded the other steps.
    for _ in 0..C {
        bench.rest();
    }
    let outputs = bench.rest();
    assert_eq!(outputs.position[4], 1);
    assert!(outputs.discarded[4] >= 2);
}

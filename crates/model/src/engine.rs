//! The engine as a description of what it does, not of how: six accumulators with queues, whose ticks
//! take effect at the strobe, for all axes at once (docs/engine.md).
//!
//! ```text
//! strobe      ^ n - 1        ^ n            ^ n + 1        ^
//! words put   |--------------| seen by tick n + 1
//! tick n      |  worked out  |
//! its step    |              |              | at phase q, on the pin one clock later
//! ```

use crate::phase::{bisect, crosses};
use crate::shaper;
use carrystep_spec::engine::{COMMIT, EngineInputs, EngineOutputs, PUT_BEAT, Put, QUEUE, SEGMENT_WORDS, TURN};
use carrystep_spec::{AXES, Build, Faults};
use std::collections::VecDeque;

/// A segment as the queue holds it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Segment {
    /// Ticks after the next one.
    left: u32,
    v: i64,
    a: i64,
    j: i64,
    last: bool,
}

/// What a tick leaves for the pins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Stage {
    /// Backward, and the phase.
    step: Option<(bool, u32)>,
    sign: i8,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Lane {
    p: u64,
    running: Option<Segment>,
    /// The running segment's V + A did not fit.
    unfit: bool,
    queue: VecDeque<Segment>,
    /// Committed in this tick.
    fresh: Option<Segment>,
    words: [u32; SEGMENT_WORDS as usize],
    computed: Stage,
    emitted: Stage,
    overspeed: bool,
    underrun: bool,
    shaper: shaper::State,
}

/// The engine's state; [`Engine::outputs`] and [`Engine::clock`] are its one clock cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Engine {
    build: Build,
    /// Clock in the tick.
    clock: u32,
    /// Ticks since configuration, as far as it matters: none or some.
    turns: bool,
    armed: Option<u8>,
    protocol: bool,
    /// Too fast or dry, since some strobe.
    stopped: bool,
    /// Whole ticks without motion after a fault, up to 1.
    halted: Option<u32>,
    clearing: bool,
    /// Whole ticks in which nothing ran or waited, up to 2.
    rest: u32,
    lanes: [Lane; AXES],
}

impl Engine {
    /// The engine as it is configured.
    pub fn new(build: &Build) -> Self {
        let lane = |axis: usize| Lane {
            p: build.phase.start_value(),
            running: None,
            unfit: false,
            queue: VecDeque::new(),
            fresh: None,
            words: [0; SEGMENT_WORDS as usize],
            computed: Stage::default(),
            emitted: Stage::default(),
            overspeed: false,
            underrun: false,
            shaper: shaper::State::at_configuration(build.pins[axis]),
        };
        Self {
            build: build.clone(),
            clock: 0,
            turns: false,
            armed: None,
            protocol: false,
            stopped: false,
            halted: None,
            clearing: false,
            rest: 2,
            lanes: std::array::from_fn(lane),
        }
    }

    /// P of an axis.
    pub fn fraction(&self, axis: usize) -> u64 {
        self.lanes[axis].p
    }

    /// The registers of one shaper.
    pub fn shaper(&self, axis: usize) -> &shaper::State {
        &self.lanes[axis].shaper
    }

    /// The outputs in this cycle, given its inputs.
    pub fn outputs(&self, inputs: &EngineInputs) -> EngineOutputs {
        let fault = self.fault();
        let bits = |of: fn(&Lane) -> bool| bits(&self.lanes, of);
        EngineOutputs {
            put_ready: !fault && self.takes(inputs.put.unwrap_or(Put { axis: 0, word: 0, data: 0 })),
            start_ready: !fault && self.strobe() && self.armed.is_none(),
            step: bits(|lane| lane.shaper.step),
            dir: bits(|lane| lane.shaper.dir),
            idle: self.rest == 2
                && self.armed.is_none()
                && self.lanes.iter().all(|lane| lane.shaper.owed.is_none() && !lane.shaper.step),
            fault,
            halted: self.halted.is_some(),
            faults: Faults {
                overrun: bits(|lane| lane.shaper.overrun),
                overspeed: bits(|lane| lane.overspeed),
                underrun: bits(|lane| lane.underrun),
                protocol: self.protocol,
            },
            started: self.strobe() && matches!(self.decision(&self.ticked()), Decision::Go(_)),
        }
    }

    /// Goes to the next cycle.
    pub fn clock(&mut self, inputs: &EngineInputs) {
        let outputs = self.outputs(inputs);
        let (fault, steps_high) = (outputs.fault, outputs.step != 0);
        let Build { timebase, pins, .. } = self.build.clone();
        let (phase, sub) = (self.clock / timebase.clocks_per_phase(), self.clock % timebase.clocks_per_phase());
        for (lane, pins) in self.lanes.iter_mut().zip(pins) {
            let request = lane.emitted.step.filter(|step| sub == 0 && step.1 == phase).map(|step| step.0);
            let input = shaper::Input { request, sign: lane.emitted.sign, frozen: fault };
            lane.shaper = shaper::clock(lane.shaper, input, pins);
        }
        if let Some(put) = inputs.put.filter(|_| outputs.put_ready) {
            self.put(put);
        }
        if self.strobe() {
            self.end_tick(inputs, fault, steps_high);
        } else if fault {
            self.armed = None;
        }
        self.clock = (self.clock + 1) % timebase.clocks_per_tick();
    }

    fn fault(&self) -> bool {
        self.stopped || self.protocol || self.lanes.iter().any(|lane| lane.shaper.overrun)
    }

    fn strobe(&self) -> bool {
        self.clock + 1 == self.build.timebase.clocks_per_tick()
    }

    /// A word is taken in its axis' turn, unless the queue is full; for an axis that does not exist, at once.
    fn takes(&self, put: Put) -> bool {
        let axis = u32::from(put.axis);
        self.lanes
            .get(usize::from(put.axis))
            .is_none_or(|lane| self.turns && self.clock == axis * TURN + PUT_BEAT && lane.queue.len() < QUEUE)
    }

    fn put(&mut self, put: Put) {
        let Some(lane) = self.lanes.get_mut(usize::from(put.axis)) else {
            self.protocol = true;
            return;
        };
        self.rest = 0;
        if put.word == COMMIT {
            let [left, v, v_high, a, a_high, j, j_high] = lane.words;
            let long = |low: u32, high: u32| (u64::from(high) << 32 | u64::from(low)).cast_signed();
            let (v, a, j) = (long(v, v_high), long(a, a_high), long(j, j_high));
            lane.fresh = Some(Segment { left, v, a, j, last: put.data & 1 == 1 });
        } else {
            lane.words[usize::from(put.word)] = put.data;
        }
    }

    /// The axes after this tick.
    fn ticked(&self) -> [Lane; AXES] {
        let bits = self.build.timebase.phase_bits();
        let halted = self.halted.is_some();
        std::array::from_fn(|axis| if halted { self.lanes[axis].halt() } else { self.lanes[axis].tick(bits) })
    }

    /// What becomes of the armed start at this strobe.
    fn decision(&self, ticked: &[Lane; AXES]) -> Decision {
        let found = ticked.iter().any(|lane| lane.overspeed || lane.underrun);
        let Some(mask) = self.armed.filter(|_| !self.fault() && !found) else { return Decision::Wait };
        // What counts is what waited before this tick.
        if mask & bits(&self.lanes, |lane| lane.queue.is_empty()) != 0 {
            Decision::Unfed
        } else if mask & bits(ticked, |lane| lane.running.is_some()) != 0 {
            Decision::Wait
        } else {
            Decision::Go(mask)
        }
    }

    /// The strobe: everything that the tick has brought takes effect.
    fn end_tick(&mut self, inputs: &EngineInputs, fault: bool, steps_high: bool) {
        let mut lanes = self.ticked();
        let decision = self.decision(&lanes);
        let found = lanes.iter().any(|lane| lane.overspeed || lane.underrun);
        let active =
            self.lanes.iter().any(|lane| (lane.running.is_some() && self.halted.is_none()) || !lane.queue.is_empty());
        // A word put in this very cycle has already set `rest` to 0; turns never reach a strobe.
        self.rest = if active { 0 } else { (self.rest + 1).min(2) };
        for lane in &mut lanes {
            lane.queue.extend(lane.fresh.take());
        }
        if self.armed.is_none() && !fault {
            self.armed = inputs.start;
        }
        match decision {
            Decision::Wait => {}
            Decision::Unfed => self.protocol = true,
            Decision::Go(mask) => {
                self.armed = None;
                for (axis, lane) in lanes.iter_mut().enumerate().filter(|(axis, _)| mask >> axis & 1 == 1) {
                    debug_assert!(lane.running.is_none(), "axis {axis} runs");
                    lane.running = lane.queue.pop_front();
                    lane.unfit = false;
                }
            }
        }
        if fault {
            self.armed = None;
        }
        self.lanes = lanes;
        self.turns = true;
        if self.clearing {
            self.clear();
            return;
        }
        self.clearing = inputs.clear && self.halted == Some(1) && !steps_high;
        self.stopped |= found;
        self.halted = (fault || found).then(|| self.halted.map_or(0, |ticks| (ticks + 1).min(1)));
    }

    fn clear(&mut self) {
        for lane in &mut self.lanes {
            lane.p = self.build.phase.start_value();
            lane.queue.clear();
            lane.overspeed = false;
            lane.underrun = false;
            lane.shaper.overrun = false;
        }
        self.stopped = false;
        self.protocol = false;
        self.halted = None;
        self.clearing = false;
    }
}

/// What becomes of an armed start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Decision {
    Wait,
    /// A masked axis has nothing waiting.
    Unfed,
    Go(u8),
}

impl Lane {
    /// One tick of an axis that may move.
    fn tick(&self, phase_bits: u32) -> Self {
        let mut next = Self { emitted: self.computed, computed: Stage::default(), ..self.clone() };
        let Some(Segment { left, v, a, j, last }) = self.running else { return next };
        next.running = None;
        // abs(V) < 2^63, always: half a step per tick is where direction and carry lose their meaning.
        if self.unfit || v == i64::MIN {
            next.overspeed = true;
            return next;
        }
        let step = crosses(self.p, v).then(|| (v < 0, bisect(self.p, v, phase_bits)));
        next.computed = Stage { step, sign: v.signum() as i8 };
        next.p = self.p.wrapping_add(v.cast_unsigned());
        next.unfit = false;
        if let Some(left) = left.checked_sub(1) {
            let (faster, unfit) = v.overflowing_add(a);
            next.running = Some(Segment { left, v: faster, a: a.wrapping_add(j), j, last });
            next.unfit = unfit;
        } else if !last {
            next.running = next.queue.pop_front();
            next.underrun = next.running.is_none();
        }
        next
    }

    /// One tick of an axis that may not.
    fn halt(&self) -> Self {
        Self { emitted: self.computed, computed: Stage::default(), running: None, ..self.clone() }
    }
}

fn bits(lanes: &[Lane; AXES], of: impl Fn(&Lane) -> bool) -> u8 {
    lanes.iter().enumerate().fold(0, |bits, (axis, lane)| bits | u8::from(of(lane)) << axis)
}

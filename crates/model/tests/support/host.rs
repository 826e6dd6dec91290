//! A host that writes random segments, starts, seeks, arms the latch, takes snapshots, stops, clears
//! and resets, and presses switches.

use super::random::Random;
use carrystep_core::engine::{COMMIT, EngineInputs, EngineOutputs, Put, SWITCH_ROWS, SeekSource};
use carrystep_core::{EngineBuild, Segment};
use carrystep_model::Engine;
use std::collections::VecDeque;

/// The inputs and outputs of an engine in one cycle.
pub type Cycle = (EngineInputs, EngineOutputs);

/// The words of a segment and its commit, for this axis.
pub fn words(axis: u8, segment: Segment) -> impl Iterator<Item = Put> {
    let Segment { ticks, v, a, j, last } = segment;
    let halves = |long: i64| [long as u32, (long >> 32) as u32];
    let [v, a, j] = [v, a, j].map(halves);
    let words = [ticks - 1, v[0], v[1], a[0], a[1], j[0], j[1], last.into()];
    (0..=COMMIT).zip(words).map(move |(word, data)| Put { axis, word, data })
}

/// What the host does at the moment, and for how many more clocks.
pub struct Host {
    random: Random,
    axes: u8,
    /// Levels, and requests that are held.
    inputs: EngineInputs,
    words: VecDeque<Put>,
    /// Clocks until the next action.
    rests: u64,
    /// Clocks for which the pulsed inputs are held.
    pulse: u64,
    /// The levels of switches that are not pressed.
    rests_at: EngineInputs,
    /// The host is alive: it kicks the watchdog in every clock.
    kicks: bool,
    /// The host does nothing that stops the axes.
    is_calm: bool,
}

impl Host {
    pub fn new(build: &EngineBuild, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let pins = EngineInputs::default().levels(&build.guard);
        Self {
            is_calm: random.once_in(3),
            random,
            axes: build.axes() as u8,
            inputs: EngineInputs { enable: true, ..pins },
            rests_at: pins,
            kicks: true,
            words: VecDeque::new(),
            rests: 0,
            pulse: 0,
        }
    }

    /// The inputs in the next cycle.
    pub fn inputs(&mut self, engine: &Engine) -> EngineInputs {
        if self.rests == 0 {
            self.act(engine);
            self.rests = self.random.one_of(&[1, 30, 300, 3000]);
            self.rests = 1 + self.random.below(self.rests);
        }
        self.rests -= 1;
        if self.words.is_empty() && self.random.once_in(100) {
            let waiting = waiting(engine, self.axes);
            self.inputs.start = self.inputs.start.or((waiting != 0).then_some(waiting));
        }
        let put = self.words.front().copied();
        EngineInputs { put, ..self.inputs }
    }

    /// Advances after a cycle with these inputs and outputs.
    pub fn clock(&mut self, inputs: &EngineInputs, outputs: &EngineOutputs) {
        if outputs.put_ready && inputs.put.is_some() {
            self.words.pop_front();
        }
        if outputs.fault.is_some() {
            self.words.clear();
        }
        if outputs.start_ready || outputs.fault.is_some() {
            self.inputs.start = None;
        }
        if outputs.fault.is_none() {
            self.inputs.clear = false;
        }
        self.pulse = self.pulse.saturating_sub(1);
        if self.pulse == 0 {
            let Self { inputs, .. } = self;
            (inputs.stop, inputs.broken, inputs.reset, inputs.snapshot) =
                (false, false, false, false);
            (inputs.seek, inputs.seek_source, inputs.latch_arm) = (None, None, 0);
            inputs.kick = self.kicks;
        }
    }

    fn act(&mut self, engine: &Engine) {
        let Self { random, inputs, axes, .. } = self;
        let all = ((1_u16 << *axes) - 1) as u8;
        let mask = (random.next() & random.next()) as u8 & all;
        let waiting = waiting(engine, *axes);
        self.pulse = 1;
        if engine.motion().fault().is_some() && !random.once_in(4) {
            (inputs.clear, inputs.estop) = (true, self.rests_at.estop);
            if random.once_in(2) {
                inputs.inputs = self.rests_at.inputs;
            }
            return;
        }
        if !inputs.enable && random.once_in(2) {
            inputs.enable = true;
        }
        match random.below(if self.is_calm { 80 } else { 100 }) {
            0..45 if self.words.is_empty() => {
                let movers = if random.once_in(2) { u8::MAX } else { mask };
                let count = 1 + random.below(4);
                for left in (0..count).rev() {
                    for axis in (0..*axes).filter(|axis| movers >> axis & 1 == 1) {
                        let last = if left == 0 { !random.once_in(8) } else { random.once_in(8) };
                        self.words.extend(words(axis, Segment { last, ..segment(random) }));
                    }
                }
            }
            0..50 if waiting != 0 => inputs.start = Some(waiting),
            0..58 => inputs.snapshot = true,
            58 => (inputs.snapshot, self.pulse) = (true, 1 + random.below(400)),
            59..62 => {
                inputs.seek_source = Some(source(random, *axes));
                inputs.seek = random.one_of(&[None, Some(mask), Some(all), Some(all)]);
                inputs.latch_arm = random.once_in(3).into();
            }
            62 => inputs.seek = random.one_of(&[Some(0), Some(mask), Some(all)]),
            63 => inputs.latch_arm = 1,
            64..72 => {
                // The latch is often connected to a switch.
                inputs.latch ^= u8::from(random.once_in(2));
                match random.below(8) {
                    0..3 => inputs.limit_min ^= mask | 1,
                    3..6 => inputs.limit_max ^= mask | 1,
                    6 => inputs.inputs[0] ^= mask | 1,
                    _ => inputs.inputs[1] ^= mask,
                }
            }
            72..74 => {
                (inputs.latch, inputs.latch_arm) = (inputs.latch ^ 1, random.once_in(4).into());
            }
            74 if random.once_in(4) => inputs.inputs[1] ^= 1,
            74..76 => (inputs.kick, inputs.clear) = (true, true),
            80..82 => inputs.stop = true,
            82..84 => inputs.estop = !inputs.estop,
            76..80 => self.kicks = !self.kicks,
            84 => inputs.broken = random.once_in(3),
            85 => (inputs.reset, self.pulse) = (true, 1 + random.below(300)),
            86 => inputs.enable = !inputs.enable,
            87 if random.once_in(3) => inputs.start = Some(mask),
            88 => inputs.room_of = random.below(8) as u8,
            89..92 => self.pulse = self.rests,
            _ => inputs.clear = true,
        }
    }
}

/// The axes whose queues hold the beginning of a move, one bit each.
fn waiting(engine: &Engine, axes: u8) -> u8 {
    let waiting = (0..axes).filter(|axis| engine.motion().waiting((*axis).into()) > 0);
    waiting.fold(0, |mask, axis| mask | 1 << axis) & !engine.motion().in_a_move()
}

/// Any source, now and then one that does not exist.
fn source(random: &mut Random, axes: u8) -> SeekSource {
    let axes = u64::from(axes).max(random.one_of(&[1, 1, 8]));
    SeekSource {
        axis: random.below(axes) as u8,
        row: random.below(SWITCH_ROWS.into()) as u8,
        own: random.below(2) == 0,
        level: !random.once_in(3),
    }
}

/// A segment of up to 100 ticks, fast enough for steps more often than not.
fn segment(random: &mut Random) -> Segment {
    let v = random.next().cast_signed() >> (1 + random.below(3));
    let (a, j) = (random.signed(56), random.signed(50));
    let ticks = 1 + random.below(100) as u32;
    Segment { ticks, v, a, j, last: false }
}

/// What the host does with its latch, done with all latches of a build with several. All pins have
/// one level, and the cycle decides which latches are armed.
fn of_all_latches(build: &EngineBuild, inputs: EngineInputs, cycle: usize) -> EngineInputs {
    if !build.has_several_latches() {
        return inputs;
    }
    let all = (1 << build.guard.latches.len()) - 1;
    let armed = if cycle.is_multiple_of(2) { all } else { 1 + cycle as u8 / 2 % all };
    EngineInputs { latch: (inputs.latch & 1) * all, latch_arm: inputs.latch_arm * armed, ..inputs }
}

/// Runs an engine under a random host.
pub fn run(build: &EngineBuild, seed: u64, cycles: usize) -> Vec<Cycle> {
    let mut engine = Engine::new(build);
    let mut host = Host::new(build, seed);
    let mut all = Vec::with_capacity(cycles);
    for _ in 0..cycles {
        let inputs = of_all_latches(build, host.inputs(&engine), all.len());
        let outputs = engine.outputs(&inputs);
        engine.clock(&inputs);
        host.clock(&inputs, &outputs);
        all.push((inputs, outputs));
    }
    all
}

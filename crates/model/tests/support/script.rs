//! A host that executes a script: words of segments one after the other, and changes of the inputs
//! in given cycles.

use super::host::{Cycle, words};
use super::words::{AxisWords, of_tick};
use carrystep_core::engine::{EngineInputs, Put, SeekSource, StatePage};
use carrystep_core::{EngineBuild, Segment};
use carrystep_model::Engine;
use std::collections::VecDeque;

/// One line of a script.
#[derive(Debug, Clone)]
pub enum Act {
    /// Segments for an axis, behind all words that are not taken yet.
    Segments(u8, Vec<Segment>),
    /// A start, offered until it is taken.
    Start(u8),
    Source(SeekSource),
    Seek(u8),
    Arm,
    Snapshot,
    /// Switches of a row that are active from now on.
    Switches(u8, u8),
    Latch(bool),
    /// The level of `clear` from now on.
    Clear(bool),
}

/// What an engine has done under a script.
pub struct Run {
    pub cycles: Vec<Cycle>,
    pub engine: Engine,
    per_tick: usize,
}

/// Runs a script, whose lines are in the order of their cycles.
pub fn run(build: &EngineBuild, script: &[(usize, Act)], ticks: usize) -> Run {
    let per_tick = build.timebase.clocks_per_tick() as usize;
    let mut engine = Engine::new(build);
    let mut run = Run { cycles: Vec::new(), engine: engine.clone(), per_tick };
    let mut held = EngineInputs { enable: true, ..EngineInputs::default() };
    let mut puts: VecDeque<Put> = VecDeque::new();
    let mut lines = script.iter().peekable();
    for cycle in 0..ticks * per_tick {
        let mut inputs = EngineInputs { put: puts.front().copied(), ..held };
        while let Some((_, act)) = lines.next_if(|(at, _)| *at <= cycle) {
            match act {
                Act::Segments(axis, segments) => {
                    puts.extend(segments.iter().flat_map(|segment| words(*axis, *segment)));
                }
                Act::Start(mask) => held.start = Some(*mask),
                Act::Source(source) => inputs.seek_source = Some(*source),
                Act::Seek(mask) => inputs.seek = Some(*mask),
                Act::Arm => inputs.latch_arm = 1,
                Act::Snapshot => inputs.snapshot = true,
                Act::Switches(0, active) => held.limit_min = *active,
                Act::Switches(1, active) => held.limit_max = *active,
                Act::Switches(row, active) => held.inputs[usize::from(*row) - 2] = *active,
                Act::Latch(active) => held.latch = u8::from(*active),
                Act::Clear(level) => held.clear = *level,
            }
        }
        let EngineInputs { limit_min, limit_max, latch, clear, .. } = held;
        let inputs =
            EngineInputs { limit_min, limit_max, inputs: held.inputs, latch, clear, ..inputs };
        // A start waits until all words before it are taken.
        let inputs = EngineInputs { start: held.start.filter(|_| puts.is_empty()), ..inputs };
        let inputs = inputs.levels(&build.guard);
        let outputs = engine.outputs(&inputs);
        if outputs.put_ready && inputs.put.is_some() {
            puts.pop_front();
        }
        if (outputs.start_ready && inputs.start.is_some()) || outputs.fault.is_some() {
            held.start = None;
        }
        if outputs.fault.is_some() {
            puts.clear();
        }
        engine.clock(&inputs);
        run.cycles.push((inputs, outputs));
    }
    run.engine = engine;
    run
}

impl Run {
    /// The words of a tick.
    pub fn words(&self, tick: usize) -> Vec<AxisWords> {
        let from = tick * self.per_tick;
        let axes = self.engine.motion().build().axes();
        of_tick(&self.cycles[from..from + self.per_tick], axes)
    }

    /// Number of whole ticks.
    pub fn ticks(&self) -> usize {
        self.cycles.len() / self.per_tick
    }

    /// The ticks in which an axis has words on this page.
    pub fn ticks_on(&self, page: StatePage, axis: usize) -> Vec<usize> {
        (1..self.ticks()).filter(|tick| self.words(*tick)[axis].page == page).collect()
    }

    /// The cycles in which STEP of an axis rises or DIR changes.
    pub fn edges(&self, axis: usize) -> Vec<(usize, bool, bool)> {
        let pins =
            |(_, outputs): &Cycle| (outputs.step >> axis & 1 == 1, outputs.dir >> axis & 1 == 1);
        let pairs = self.cycles.windows(2).enumerate();
        pairs
            .filter(|(_, pair)| pins(&pair[0]) != pins(&pair[1]))
            .map(|(cycle, pair)| (cycle + 1, pins(&pair[1]).0, pins(&pair[1]).1))
            .collect()
    }

    /// True if no stop was triggered.
    pub fn is_free(&self) -> bool {
        self.cycles.iter().all(|(_, outputs)| outputs.fault.is_none())
    }

    /// The position with all carries, exact in 2^-64 step, after the last tick.
    pub fn place(&self, axis: usize) -> i128 {
        let position = i128::from(self.engine.shaper(axis).position);
        (position << 64) + i128::from(self.engine.fraction(axis))
    }
}

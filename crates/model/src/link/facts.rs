//! What can be read: the build's facts, and what the engine has last said of each axis. All items are asked for in turn,
//! one a turn of the engine.

use carrystep_core::EngineBuild;
use carrystep_core::link::machine::SCAN;
use carrystep_core::link::registers as map;
use carrystep_core::link::{self, BuildId, LinkInputs};

/// Words of the memory.
const WORDS: usize = 128;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Facts {
    words: [u32; WORDS],
    /// What the memory gives.
    read: u32,
    /// Axis 3 | item 2.
    asked: u8,
}

impl Facts {
    pub(super) fn new(build: &EngineBuild, id: BuildId) -> Self {
        let mut words = [0; WORDS];
        for (address, word) in link::facts(build, id) {
            words[usize::from(address)] = word;
        }
        Self { words, read: 0, asked: 0 }
    }

    /// The axis and the item that are asked for.
    pub(super) const fn asks(&self) -> (u8, u8) {
        (self.asked >> 2, self.asked & 3)
    }

    /// The last item of the last axis is said.
    pub(super) fn scanned(&self, inputs: &LinkInputs) -> bool {
        inputs.get_valid && u32::from(self.asked) == SCAN - 1
    }

    /// What was read.
    pub(super) const fn data(&self) -> u32 {
        self.read
    }

    pub(super) fn clock(&mut self, address: u8, inputs: &LinkInputs) {
        self.read = self.words[usize::from(address) % WORDS];
        if let Some(axis) = inputs.engine.latch {
            self.latch(axis, inputs.get_data);
        } else if inputs.get_valid {
            self.keep(inputs.get_data);
        }
        if inputs.get_valid {
            self.asked = (self.asked + 1) % SCAN as u8;
        }
    }

    fn keep(&mut self, word: u32) {
        let (axis, item) = self.asks();
        self.words[usize::from(map::of_axis(map::AXES_AT + item, axis)) % WORDS] = word;
    }

    /// The position of an axis that waits for its limit.
    pub(super) fn latch(&mut self, axis: u8, position: u32) {
        self.words[usize::from(map::of_axis(map::LATCHED, axis & 7)) % WORDS] = position;
    }

    /// So many turns have passed: what was asked for in them is what is said now.
    pub(super) fn pass(&mut self, turns: u64, said: impl Fn(u8, u8) -> u32) {
        let last = turns.min(u64::from(SCAN));
        self.asked = ((u64::from(self.asked) + turns - last) % u64::from(SCAN)) as u8;
        for _ in 0..last {
            let (axis, item) = self.asks();
            self.keep(said(axis, item));
            self.asked = (self.asked + 1) % SCAN as u8;
        }
    }
}

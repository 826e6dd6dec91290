//! The memory of all words that the host can read: the constants of the build, and the engine's
//! last answers for each axis. The link requests all items cyclically, one per time slot of the
//! engine.

use carrystep_core::EngineBuild;
use carrystep_core::link::processor::SCAN;
use carrystep_core::link::registers as map;
use carrystep_core::link::{self, BuildId, LinkInputs};

/// Number of words in the memory.
const WORDS: usize = 128;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct RegisterMirror {
    words: [u32; WORDS],
    /// The word that the memory outputs.
    read: u32,
    /// The item that is being requested: the axis in bits 4 to 2, the item in bits 1 and 0.
    asked: u8,
}

impl RegisterMirror {
    pub(super) fn new(build: &EngineBuild, id: BuildId) -> Self {
        let mut words = [0; WORDS];
        for (address, word) in link::facts(build, id) {
            words[usize::from(address)] = word;
        }
        Self { words, read: 0, asked: 0 }
    }

    /// The axis and the item that are being requested.
    pub(super) const fn asks(&self) -> (u8, u8) {
        (self.asked >> 2, self.asked & 3)
    }

    /// True if the engine answers the last item of the last axis in this clock.
    pub(super) fn scanned(&self, inputs: &LinkInputs) -> bool {
        inputs.get_valid && u32::from(self.asked) == SCAN - 1
    }

    /// The word that was read.
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

    /// Stores the position (in steps) of an axis that waits for its limit.
    pub(super) fn latch(&mut self, axis: u8, position: u32) {
        self.words[usize::from(map::of_axis(map::LATCHED, axis & 7)) % WORDS] = position;
    }

    /// Accounts for `time_slots` skipped time slots. Every item requested in them gets its current
    /// value.
    pub(super) fn pass(&mut self, time_slots: u64, said: impl Fn(u8, u8) -> u32) {
        let last = time_slots.min(u64::from(SCAN));
        self.asked = ((u64::from(self.asked) + time_slots - last) % u64::from(SCAN)) as u8;
        for _ in 0..last {
            let (axis, item) = self.asks();
            self.keep(said(axis, item));
            self.asked = (self.asked + 1) % SCAN as u8;
        }
    }
}

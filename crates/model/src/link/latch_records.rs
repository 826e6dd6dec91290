//! The records of several latches, and the state of all latches in one word. It must stay equal to
//! "Several latches" in docs/link.md.

use carrystep_core::EngineBuild;
use carrystep_core::engine::{
    EngineOutputs, MAX_LATCHES, STATUS_BITS, StateItem, StatePage, StateWord,
};
use carrystep_core::link::registers::LATCHES;

/// Number of words in the memory: 64 for each record.
const WORDS: usize = 256;

/// What the address of the clock before has selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Selected {
    /// A word that belongs to no latch.
    Other,
    /// The state of all latches.
    State,
    /// A word of the record that the chosen latch holds.
    Record,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct LatchRecords {
    /// The latches of the build, one bit each.
    exist: u8,
    words: [u32; WORDS],
    /// The latch whose record is read.
    chosen: u8,
    /// The word that the memory outputs.
    read: u32,
    selected: Selected,
}

impl LatchRecords {
    pub(super) fn new(build: &EngineBuild) -> Self {
        let exist = (1 << build.guard.latches.len().min(MAX_LATCHES)) - 1;
        Self { exist, words: [0; WORDS], chosen: 0, read: 0, selected: Selected::Other }
    }

    /// The word that was read, if it belongs to the latches.
    pub(super) fn data(&self, engine: &EngineOutputs) -> Option<u32> {
        match self.selected {
            Selected::Other => None,
            Selected::Record => Some(self.read),
            Selected::State => {
                let packed = |numbers: [u8; MAX_LATCHES], bits: u32| {
                    numbers.iter().rev().fold(0, |all, &number| all << bits | u32::from(number))
                };
                Some(
                    u32::from(engine.latch_armed)
                        | u32::from(self.exist) << 4
                        | packed(engine.latch_records, 2) << 8
                        | packed(engine.latch_edges, 4) << 16,
                )
            }
        }
    }

    /// Reads the word at this address, and then stores the word that the engine outputs. `written`
    /// is the byte of the host that arms and chooses latches.
    pub(super) fn clock(&mut self, address: u8, written: Option<u8>, engine: &EngineOutputs) {
        let record = engine.latch_records[usize::from(self.chosen)];
        self.read = self.words[usize::from(record << 6 | address & 0x3f)];
        self.selected = if address == LATCHES {
            Selected::State
        } else if address >> 6 == StatePage::Latch as u8 && !is_of_switch(address >> 3 & 7) {
            Selected::Record
        } else {
            Selected::Other
        };
        if let Some(byte) = written {
            self.chosen = byte >> 4 & 3;
        }
        engine.state.into_iter().for_each(|word| self.store(word));
    }

    /// Stores a word of state if it belongs to a record. Of a status, only the bits that have a
    /// meaning are stored.
    pub(super) fn store(&mut self, state: StateWord) {
        if state.page == StatePage::Latch && !is_of_switch(state.item as u8) {
            let mask = match state.item {
                StateItem::Status => (1 << STATUS_BITS) - 1,
                _ => u32::MAX,
            };
            let place = state.record << 6 | state.address() & 0x3f;
            self.words[usize::from(place)] = state.word & mask;
        }
    }
}

/// The words of switches have the row in place of the page.
const fn is_of_switch(item: u8) -> bool {
    item == StateItem::Switch as u8
}

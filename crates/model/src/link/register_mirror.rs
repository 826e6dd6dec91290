//! The memory of all words that the host can read: the facts of the build, and of each word of
//! state that the engine outputs the last value.

use carrystep_core::EngineBuild;
use carrystep_core::engine::{STATUS_BITS, StateItem, StateWord, StateWords};
use carrystep_core::link::{self, BuildId};

/// Number of words in the memory.
const WORDS: usize = 256;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct RegisterMirror {
    words: [u32; WORDS],
    /// The word that the memory outputs.
    read: u32,
}

impl RegisterMirror {
    pub(super) fn new(build: &EngineBuild, id: BuildId) -> Self {
        let mut words = [0; WORDS];
        for (address, word) in link::facts(build, id) {
            words[usize::from(address)] = word;
        }
        Self { words, read: 0 }
    }

    /// The word that was read.
    pub(super) const fn data(&self) -> u32 {
        self.read
    }

    /// The word at an address.
    pub(super) fn word(&self, address: u8) -> u32 {
        self.words[usize::from(address)]
    }

    /// Reads the word at this address, and then stores the word that the engine outputs.
    pub(super) fn clock(&mut self, address: u8, states: StateWords) {
        self.read = self.word(address);
        for state in states {
            self.store(state);
        }
    }

    /// Stores a word of state. Of a status, only the bits that have a meaning are stored.
    pub(super) fn store(&mut self, state: StateWord) {
        let mask = match state.item {
            StateItem::Status => (1 << STATUS_BITS) - 1,
            _ => u32::MAX,
        };
        self.words[usize::from(state.address())] = state.word & mask;
    }
}

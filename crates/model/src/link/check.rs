//! The CRC's register: a bit a clock, eight clocks a byte.

use carrystep_core::link::CRC_POLYNOMIAL;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Check {
    sum: u32,
    count: u8,
}

/// What it is told in a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Told {
    Nothing,
    /// To begin with this.
    Begin(u32),
    /// A bit further, with one of this byte fed to it.
    Feed(u8),
    /// A bit further, with one of this byte shifted in above it.
    Shift(u8),
}

impl Check {
    /// The eighth of eight clocks.
    pub(super) const fn over(self) -> bool {
        self.count == 7
    }

    /// All of it.
    pub(super) const fn word(self) -> u32 {
        self.sum
    }

    pub(super) fn clock(&mut self, told: Told) {
        let bit = |byte: u8| u32::from(byte >> self.count & 1);
        let above = match told {
            Told::Nothing => return,
            Told::Begin(word) => {
                self.sum = word;
                return;
            }
            Told::Feed(byte) => (self.sum & 1 ^ bit(byte)) * CRC_POLYNOMIAL,
            Told::Shift(byte) => bit(byte) << 31,
        };
        self.sum = self.sum >> 1 ^ above;
        self.count = (self.count + 1) & 7;
    }
}

//! The CRC register of the link: one bit per clock, eight clocks per byte. It also assembles words
//! from bytes.

use carrystep_core::link::CRC_POLYNOMIAL;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct CrcUnit {
    sum: u32,
    count: u8,
}

/// The operation of the register in one clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Told {
    Nothing,
    /// Loads this word.
    Begin(u32),
    /// Shifts by one bit and feeds one bit of this byte to the CRC.
    Feed(u8),
    /// Shifts by one bit and shifts one bit of this byte in at the top.
    Shift(u8),
}

impl CrcUnit {
    /// True in the eighth clock of a byte.
    pub(super) const fn over(self) -> bool {
        self.count == 7
    }

    /// The number of clocks until the eighth bit of the byte is shifted.
    pub(super) fn left(self) -> u64 {
        (7 - self.count).into()
    }

    /// The whole register.
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

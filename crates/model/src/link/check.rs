//! The CRC's register: a bit a clock, eight clocks a byte.

use carrystep_spec::link::CRC_POLYNOMIAL;

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
    /// A bit further; the byte that is fed to it, if one is.
    Step(Option<u8>),
}

impl Check {
    /// The eighth of eight clocks.
    pub(super) const fn over(self) -> bool {
        self.count == 7
    }

    /// Its low byte.
    pub(super) const fn low(self) -> u8 {
        self.sum as u8
    }

    pub(super) fn clock(&mut self, told: Told) {
        match told {
            Told::Nothing => {}
            Told::Begin(word) => self.sum = word,
            Told::Step(fed) => {
                let feedback = fed.is_some_and(|byte| (self.sum ^ u32::from(byte >> self.count)) & 1 == 1);
                self.sum = self.sum >> 1 ^ if feedback { CRC_POLYNOMIAL } else { 0 };
                self.count = (self.count + 1) & 7;
            }
        }
    }
}

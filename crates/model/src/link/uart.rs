//! The receiver and the transmitter of the UART: eight data bits, least significant bit first, no
//! parity, one stop bit. The length of a bit is given in clocks.

/// A marker bit above the bits that are still to be received or sent.
const MARK: u16 = 0x100;

/// The receiver. It samples the line in the middle of each bit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Receiver {
    bit_clocks: u32,
    /// The line one clock ago (`sync`) and two clocks ago (`now`).
    sync: bool,
    now: bool,
    /// Clocks to the next sample, and the received bits below a marker bit; `None` while no byte is
    /// being received.
    byte: Option<(u32, u16)>,
}

impl Receiver {
    pub(crate) const fn new(bit_clocks: u32) -> Self {
        Self { bit_clocks, sync: true, now: true, byte: None }
    }

    /// The byte whose stop bit is sampled in this clock, if the stop bit is 1.
    pub(crate) fn byte(&self) -> Option<u8> {
        match self.byte {
            Some((0, bits)) if bits & 1 == 1 && self.now => Some((bits >> 1) as u8),
            _ => None,
        }
    }

    pub(crate) fn clock(&mut self, rx: bool) {
        self.byte = match self.byte {
            None if self.now => None,
            None => Some((self.bit_clocks + self.bit_clocks / 2 - 1, MARK)),
            Some((0, bits)) if bits & 1 == 1 => None,
            Some((0, bits)) => {
                Some((self.bit_clocks - 1, bits >> 1 | if self.now { MARK } else { 0 }))
            }
            Some((left, bits)) => Some((left - 1, bits)),
        };
        self.now = self.sync;
        self.sync = rx;
    }

    /// The number of clocks in which the receiver only counts, provided that the line stays at
    /// `rx`.
    pub(crate) fn quiet(&self, rx: bool) -> u64 {
        match self.byte {
            Some((left, _)) => left.into(),
            None if self.now && self.sync && rx => u64::MAX,
            None => 0,
        }
    }

    pub(crate) fn pass(&mut self, clocks: u64, rx: bool) {
        if let Some((left, _)) = &mut self.byte {
            *left -= clocks as u32;
        }
        match clocks {
            0 => {}
            1 => (self.now, self.sync) = (self.sync, rx),
            _ => (self.now, self.sync) = (rx, rx),
        }
    }
}

/// The transmitter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Transmitter {
    bit_clocks: u32,
    line: bool,
    /// Clocks to the next bit.
    left: u32,
    /// Bits that are still to be sent, with the stop bit on top.
    bits: u16,
}

impl Transmitter {
    pub(crate) const fn new(bit_clocks: u32) -> Self {
        Self { bit_clocks, line: true, left: 0, bits: 0 }
    }

    pub(crate) const fn line(&self) -> bool {
        self.line
    }

    /// True if an offered byte is accepted in this clock.
    pub(crate) const fn takes(&self, offered: bool) -> bool {
        offered && self.left == 0 && self.bits == 0
    }

    pub(crate) fn clock(&mut self, taken: Option<u8>) {
        if let Some(byte) = taken {
            *self = Self {
                line: false,
                left: self.bit_clocks - 1,
                bits: MARK | u16::from(byte),
                ..*self
            };
        } else if self.left > 0 {
            self.left -= 1;
        } else if self.bits != 0 {
            let bits = self.bits;
            *self =
                Self { line: bits & 1 == 1, left: self.bit_clocks - 1, bits: bits >> 1, ..*self };
        }
    }

    /// The number of clocks in which the transmitter only counts, provided that `offered` stays the
    /// same.
    pub(crate) fn quiet(&self, offered: bool) -> u64 {
        if self.bits == 0 && !offered { u64::MAX } else { self.left.into() }
    }

    pub(crate) fn pass(&mut self, clocks: u64) {
        self.left = u64::from(self.left).saturating_sub(clocks) as u32;
    }
}

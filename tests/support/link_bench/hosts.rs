//! The host's end of a UART and of an SPI, clock by clock.

use carrystep_core::link::END;
use std::collections::VecDeque;

/// The host's transmitter.
pub(crate) struct Sender {
    bit_clocks: u32,
    /// Bits of the present byte, least significant first: start bit, eight data bits, stop bit.
    bits: u32,
    /// Clocks that they still take.
    pub(crate) left: u32,
}

impl Sender {
    pub(crate) fn new(bit_clocks: u32) -> Self {
        Self { bit_clocks, bits: 0, left: 0 }
    }

    /// The level of the line in this cycle.
    pub(crate) fn clock(&mut self, bytes: &mut VecDeque<u8>) -> bool {
        if self.left == 0 {
            let Some(byte) = bytes.pop_front() else { return true };
            self.bits = 1 << 9 | u32::from(byte) << 1;
            self.left = 10 * self.bit_clocks;
        }
        let line = self.bits & 1 == 1;
        self.left -= 1;
        if self.left.is_multiple_of(self.bit_clocks) {
            self.bits >>= 1;
        }
        line
    }
}

/// The host's receiver, which samples the middle of each bit.
pub(crate) struct Receiver {
    bit_clocks: u32,
    /// Clocks since the beginning of the start bit.
    since: Option<u32>,
    bits: u32,
}

impl Receiver {
    pub(crate) fn new(bit_clocks: u32) -> Self {
        Self { bit_clocks, since: None, bits: 0 }
    }

    /// Samples one cycle of the line and returns the byte that is complete with it.
    pub(crate) fn clock(&mut self, line: bool) -> Option<u8> {
        let since = match self.since {
            None if line => return None,
            None => 0,
            Some(since) => since + 1,
        };
        self.since = Some(since);
        if since % self.bit_clocks == self.bit_clocks / 2 {
            self.bits = self.bits >> 1 | u32::from(line) << 9;
            if since / self.bit_clocks == 9 {
                self.since = None;
                assert!(line, "no stop bit");
                return Some((self.bits >> 1) as u8);
            }
        }
        None
    }
}

/// A host that uses SPI mode 0 without pause and sends END while it has no data. It deasserts
/// select after every seventh byte.
pub(super) struct SpiHost {
    /// Half a period of SCK, and the time to its next edge, both in tenths of a clock.
    half: u32,
    due: u32,
    pub(super) sends: Option<u8>,
    bit: u32,
    bytes: u32,
    rest: u32,
    sck: bool,
    rises: bool,
    comes: u8,
}

impl SpiHost {
    pub(super) fn new(half: u32) -> Self {
        Self {
            half,
            due: 0,
            sends: None,
            bit: 0,
            bytes: 0,
            rest: 0,
            sck: false,
            rises: false,
            comes: 0,
        }
    }

    /// SCK, select (active low) and MOSI.
    pub(super) fn pins(&self) -> [bool; 3] {
        let mosi = self.sends.is_some_and(|byte| byte << self.bit >> 7 == 1);
        [self.sck, self.sends.is_none(), mosi]
    }

    /// Updates the pins for this cycle.
    pub(super) fn clock(&mut self, bytes: &mut VecDeque<u8>) {
        self.rises = false;
        if self.rest > 0 {
            self.rest -= 1;
            return;
        }
        if self.sends.is_none() {
            self.sends = Some(bytes.pop_front().unwrap_or(END));
            (self.bit, self.due) = (0, self.half);
            return;
        }
        if self.due >= 10 {
            self.due -= 10;
            return;
        }
        self.due += self.half - 10;
        self.sck = !self.sck;
        self.rises = self.sck;
        if !self.sck {
            self.bit += 1;
        }
        if self.bit == 8 {
            self.bit = 0;
            self.bytes += 1;
            self.sends = if self.bytes.is_multiple_of(7) {
                None
            } else {
                Some(bytes.pop_front().unwrap_or(END))
            };
            self.rest = if self.sends.is_none() { 9 } else { 0 };
        }
    }

    /// Samples MISO at the rising edge of SCK and returns the byte that is complete with it.
    pub(super) fn look(&mut self, miso: bool) -> Option<u8> {
        if !self.rises {
            return None;
        }
        self.comes = self.comes << 1 | u8::from(miso);
        (self.bit == 7).then_some(self.comes)
    }
}

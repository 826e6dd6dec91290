//! The host's end of an SPI, mode 0. The host selects the gateware as long as it has bytes to send.
//!
//! ```text
//! select_n  ^^\______________________________________/^^^
//! sck       ________/^^\__/^^\__ ... __/^^\______________
//! mosi      --< bit 7 >< bit 6 > ...  < bit 0 >----------
//! ```
//!
//! The chip select is asserted half a period before the first edge of SCK, and deasserted half a
//! period after the last one. MISO is sampled at the rising edges of SCK.

use std::collections::VecDeque;

/// Edges of SCK per byte.
const EDGES: u8 = 16;

/// The SPI controller. Its clock period need not be a whole number of gateware clocks.
#[derive(Debug, Clone)]
pub(crate) struct Master {
    /// Time units per clock.
    parts: u128,
    /// Time units per half period of SCK.
    half: u128,
    /// Time when the current levels may change.
    ends: u128,
    queue: VecDeque<u8>,
    /// The byte being sent; the current bit is the highest.
    byte: u8,
    /// Number of edges of SCK that are left of this byte.
    left: u8,
    selected: bool,
    sck: bool,
    /// Clocks in which MISO will be sampled.
    looks: VecDeque<u64>,
    /// Current level of MISO.
    miso: bool,
    /// The bits sampled so far, below a marker bit.
    comes: u16,
    heard: VecDeque<u8>,
}

impl Master {
    /// An idle controller, with this rate of SCK, Hz.
    pub(crate) fn new(clock_hz: u64, sck_hz: u64) -> Self {
        Self {
            parts: u128::from(2 * sck_hz),
            half: clock_hz.into(),
            ends: 0,
            queue: VecDeque::new(),
            byte: 0,
            left: 0,
            selected: false,
            sck: false,
            looks: VecDeque::new(),
            miso: true,
            comes: 1,
            heard: VecDeque::new(),
        }
    }

    /// Queues a byte for transmission; each byte sent also receives one.
    pub(crate) fn say(&mut self, byte: u8) {
        self.queue.push_back(byte);
    }

    /// Number of bytes that are not sent completely. It is 1 until the chip select is deasserted.
    pub(crate) fn unsaid(&self) -> usize {
        self.queue.len() + usize::from(self.selected)
    }

    /// The next byte received.
    pub(crate) fn next_byte(&mut self) -> Option<u8> {
        self.heard.pop_front()
    }

    /// Levels of SCK, of the active-low chip select and of MOSI in a clock. Calls must not go back
    /// in time.
    pub(crate) fn pins(&mut self, cycle: u64) -> [bool; 3] {
        while self.changes() <= cycle && self.unsaid() > 0 {
            self.ends = if self.selected {
                self.ends
            } else {
                self.ends.max(u128::from(cycle) * self.parts)
            };
            self.go_on();
            self.ends += self.half;
        }
        [self.sck, !self.selected, self.byte & 0x80 != 0]
    }

    /// Advances by half a period.
    fn go_on(&mut self) {
        match (self.left, self.sck) {
            (0, _) if self.selected => self.selected = false,
            (0, _) => {
                self.selected = true;
                self.next();
            }
            (_, false) => {
                self.sck = true;
                self.left -= 1;
                self.looks.push_back(self.changes());
            }
            (_, true) => {
                self.sck = false;
                self.left -= 1;
                self.byte <<= 1;
                if self.left == 0 {
                    self.next();
                }
            }
        }
    }

    /// Begins the next byte, if there is one.
    fn next(&mut self) {
        if let Some(byte) = self.queue.pop_front() {
            (self.byte, self.left) = (byte, EDGES);
        }
    }

    /// The first clock at or after the end of the current levels.
    fn changes(&self) -> u64 {
        self.ends.div_ceil(self.parts) as u64
    }

    /// Number of clocks, this one included, for which the pins stay. It may be larger if nothing is
    /// sent.
    pub(crate) fn stays(&self, cycle: u64) -> u64 {
        if self.unsaid() == 0 { u64::MAX } else { self.changes().saturating_sub(cycle) }
    }

    /// MISO had its previous level up to this clock, and has this level from here on.
    pub(crate) fn hear(&mut self, cycle: u64, level: bool) {
        while self.looks.front().is_some_and(|look| *look < cycle) {
            self.looks.pop_front();
            self.comes = self.comes << 1 | u16::from(self.miso);
            if self.comes & 0x100 != 0 {
                self.heard.push_back(self.comes as u8);
                self.comes = 1;
            }
        }
        self.miso = level;
    }

    /// MISO had its level up to this clock, and keeps it.
    pub(crate) fn reach(&mut self, cycle: u64) {
        self.hear(cycle, self.miso);
    }
}

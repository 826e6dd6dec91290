//! The host's end of a UART, at the host's own baud rate. A bit need not be a whole number of
//! clocks.

use carrystep_core::link::Uart;
use std::collections::VecDeque;

/// Bits per byte: a start bit, eight data bits, a stop bit.
const BITS: u32 = 10;

/// The unit of time: a fraction of a clock, chosen so that a clock and a bit are whole numbers of
/// it.
#[derive(Debug, Clone, Copy)]
struct Bits {
    /// Units per clock.
    parts: u128,
    /// Units per bit.
    bit: u128,
}

impl Bits {
    fn new(clock_hz: u64, uart: Uart) -> Self {
        Self { parts: uart.baud().into(), bit: clock_hz.into() }
    }

    /// The first clock that begins at or after this time.
    fn clock(self, time: u128) -> u64 {
        time.div_ceil(self.parts) as u64
    }
}

/// The transmitter: sends bytes to the gateware.
#[derive(Debug, Clone)]
pub struct LineSender {
    bits: Bits,
    queue: VecDeque<u8>,
    /// The bits being sent; the current one is the lowest.
    word: u16,
    /// Number of these bits that are left; 0 when idle.
    left: u32,
    /// End of the current bit.
    ends: u128,
}

impl LineSender {
    /// A transmitter with an idle line.
    pub fn new(clock_hz: u64, uart: Uart) -> Self {
        Self { bits: Bits::new(clock_hz, uart), queue: VecDeque::new(), word: 1, left: 0, ends: 0 }
    }

    /// Queues a byte behind all others.
    pub fn say(&mut self, byte: u8) {
        self.queue.push_back(byte);
    }

    /// Number of bytes that are not sent completely.
    pub fn unsaid(&self) -> usize {
        self.queue.len() + usize::from(self.left > 0)
    }

    /// The level in a clock. Calls must not go back in time.
    pub fn level(&mut self, cycle: u64) -> bool {
        while self.bits.clock(self.ends) <= cycle {
            if self.left > 1 {
                self.word >>= 1;
                self.left -= 1;
            } else if let Some(byte) = self.queue.pop_front() {
                // The next byte begins right behind the one before, or now.
                if self.left == 0 {
                    self.ends = self.ends.max(u128::from(cycle) * self.bits.parts);
                }
                self.word = u16::from(byte) << 1 | 1 << 9;
                self.left = BITS;
            } else {
                (self.word, self.left) = (1, 0);
                return true;
            }
            self.ends += self.bits.bit;
        }
        self.word & 1 == 1
    }

    /// Number of clocks, this one included, for which the level stays. It may be larger if nothing
    /// is sent.
    pub fn stays(&self, cycle: u64) -> u64 {
        if self.left == 0 && self.queue.is_empty() {
            u64::MAX
        } else {
            self.bits.clock(self.ends).saturating_sub(cycle)
        }
    }
}

/// The receiver: collects bytes from the gateware.
#[derive(Debug, Clone)]
pub struct LineReceiver {
    bits: Bits,
    level: bool,
    /// Time of the next sample, and the bits sampled so far below a marker bit; `None` when idle.
    byte: Option<(u128, u16)>,
    heard: VecDeque<u8>,
}

impl LineReceiver {
    /// A receiver with an idle line.
    pub fn new(clock_hz: u64, uart: Uart) -> Self {
        Self { bits: Bits::new(clock_hz, uart), level: true, byte: None, heard: VecDeque::new() }
    }

    /// The line had its previous level up to this clock, and has this level from here on.
    pub fn hear(&mut self, cycle: u64, level: bool) {
        while let Some((look, bits)) = self.byte.filter(|(look, _)| self.bits.clock(*look) < cycle)
        {
            self.byte = if bits & 1 == 1 {
                // The sample of the stop bit: if it is low, no byte was received.
                self.heard.extend(self.level.then_some((bits >> 1) as u8));
                None
            } else {
                Some((look + self.bits.bit, bits >> 1 | u16::from(self.level) << 8))
            };
        }
        if self.byte.is_none() && self.level && !level {
            self.byte = Some((u128::from(cycle) * self.bits.parts + self.bits.bit * 3 / 2, 0x100));
        }
        self.level = level;
    }

    /// The line had its level up to this clock, and keeps it.
    pub fn reach(&mut self, cycle: u64) {
        self.hear(cycle, self.level);
    }

    /// The next byte received.
    pub fn next_byte(&mut self) -> Option<u8> {
        self.heard.pop_front()
    }

    /// Whether the receiver is within a byte.
    pub fn is_hearing(&self) -> bool {
        self.byte.is_some()
    }

    /// Whether the line is idle and all bytes were taken.
    pub fn is_idle(&self) -> bool {
        self.byte.is_none() && self.heard.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_arrive_at_any_baud_rate_and_clock() {
        for (clock_hz, baud) in
            [(48_000_000, 3_000_000), (48_000_000, 921_600), (12_000_000, 115_200)]
        {
            let uart = Uart::new(clock_hz, baud).unwrap();
            let (mut line_sender, mut line_receiver) =
                (LineSender::new(clock_hz, uart), LineReceiver::new(clock_hz, uart));
            let bytes = [0, 0xff, 0x55, 0xc0, 0xdb, 1, 0x80];
            bytes.iter().for_each(|&byte| line_sender.say(byte));
            let mut cycle = 17;
            while line_sender.unsaid() > 0 || line_receiver.byte.is_some() {
                let level = line_sender.level(cycle);
                line_receiver.hear(cycle, level);
                cycle += line_sender.stays(cycle).min(1000);
            }
            assert_eq!(std::iter::from_fn(|| line_receiver.next_byte()).collect::<Vec<_>>(), bytes);
            // A byte takes ten bits, without a clock in between.
            let exact = 10 * bytes.len() as u64 * clock_hz / u64::from(baud);
            assert!((17 + exact..17 + exact + 2002).contains(&cycle), "{cycle} {exact}");
        }
    }
}

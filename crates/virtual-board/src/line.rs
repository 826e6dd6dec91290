//! The host's end of a UART, at the host's own baud rate: bits and clocks need not divide.

use carrystep_core::link::Uart;
use std::collections::VecDeque;

/// Bits of a byte: start, eight, stop.
const BITS: u32 = 10;

/// A time in parts of a clock, so many that a bit is a whole number of them.
#[derive(Debug, Clone, Copy)]
struct Bits {
    /// Parts of a clock.
    parts: u128,
    /// Parts of a bit.
    bit: u128,
}

impl Bits {
    fn new(clock_hz: u64, uart: Uart) -> Self {
        Self { parts: uart.baud().into(), bit: clock_hz.into() }
    }

    /// The first clock that does not begin before this time.
    fn clock(self, time: u128) -> u64 {
        time.div_ceil(self.parts) as u64
    }
}

/// Bytes to the gateware.
#[derive(Debug, Clone)]
pub struct Speaker {
    bits: Bits,
    queue: VecDeque<u8>,
    /// What is being said, the present bit lowest, and how many bits of it are left; 0 at rest.
    word: u16,
    left: u32,
    /// When the present bit ends.
    ends: u128,
}

impl Speaker {
    /// A line at rest.
    pub fn new(clock_hz: u64, uart: Uart) -> Self {
        Self { bits: Bits::new(clock_hz, uart), queue: VecDeque::new(), word: 1, left: 0, ends: 0 }
    }

    /// Says a byte after all others.
    pub fn say(&mut self, byte: u8) {
        self.queue.push_back(byte);
    }

    /// Bytes that are not said yet, the present one included.
    pub fn unsaid(&self) -> usize {
        self.queue.len() + usize::from(self.left > 0)
    }

    /// The level in a clock, which is never before the last one that was asked about.
    pub fn level(&mut self, cycle: u64) -> bool {
        while self.bits.clock(self.ends) <= cycle {
            if self.left > 1 {
                self.word >>= 1;
                self.left -= 1;
            } else if let Some(byte) = self.queue.pop_front() {
                // Behind the byte before, or now.
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

    /// Clocks for which the level of this clock stays, this one included; more where nothing is said.
    pub fn stays(&self, cycle: u64) -> u64 {
        if self.left == 0 && self.queue.is_empty() {
            u64::MAX
        } else {
            self.bits.clock(self.ends).saturating_sub(cycle)
        }
    }
}

/// Bytes from the gateware.
#[derive(Debug, Clone)]
pub struct Ear {
    bits: Bits,
    level: bool,
    /// When the line is looked at next, and what has been heard under a mark; at rest, nothing.
    byte: Option<(u128, u16)>,
    heard: VecDeque<u8>,
}

impl Ear {
    /// A line at rest.
    pub fn new(clock_hz: u64, uart: Uart) -> Self {
        Self { bits: Bits::new(clock_hz, uart), level: true, byte: None, heard: VecDeque::new() }
    }

    /// The line has had its level up to this clock, and has this one from here on.
    pub fn hear(&mut self, cycle: u64, level: bool) {
        while let Some((look, bits)) = self.byte.filter(|(look, _)| self.bits.clock(*look) < cycle) {
            self.byte = if bits & 1 == 1 {
                // The stop bit; where it is low, that was no byte.
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

    /// The line has had its level up to this clock, and keeps it.
    pub fn reach(&mut self, cycle: u64) {
        self.hear(cycle, self.level);
    }

    /// The next byte that was heard.
    pub fn next_byte(&mut self) -> Option<u8> {
        self.heard.pop_front()
    }

    /// A byte has begun and is not over.
    pub fn is_hearing(&self) -> bool {
        self.byte.is_some()
    }

    /// The line is at rest, and everything was taken.
    pub fn is_idle(&self) -> bool {
        self.byte.is_none() && self.heard.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_is_heard_at_any_rate() {
        for (clock_hz, baud) in [(48_000_000, 3_000_000), (48_000_000, 921_600), (12_000_000, 115_200)] {
            let uart = Uart::new(clock_hz, baud).unwrap();
            let (mut speaker, mut ear) = (Speaker::new(clock_hz, uart), Ear::new(clock_hz, uart));
            let bytes = [0, 0xff, 0x55, 0xc0, 0xdb, 1, 0x80];
            bytes.iter().for_each(|&byte| speaker.say(byte));
            let mut cycle = 17;
            while speaker.unsaid() > 0 || ear.byte.is_some() {
                let level = speaker.level(cycle);
                ear.hear(cycle, level);
                cycle += speaker.stays(cycle).min(1000);
            }
            assert_eq!(std::iter::from_fn(|| ear.next_byte()).collect::<Vec<_>>(), bytes);
            // Ten bits a byte, and not a clock more than that.
            let exact = 10 * bytes.len() as u64 * clock_hz / u64::from(baud);
            assert!((17 + exact..17 + exact + 2002).contains(&cycle), "{cycle} {exact}");
        }
    }
}

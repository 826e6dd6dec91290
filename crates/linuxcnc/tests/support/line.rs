//! The lines between the component and a board in simulated time: a UART, and an SPI behind a
//! stand-in for spidev.

use super::world::{CLOCK_HZ, MS, World};
use carrystep_virtual_board::SimulatedBoard;
use std::fmt::Write as _;

/// The line between both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    /// A UART whose rate suits the segments.
    Uart,
    /// An SPI, by the stand-in for spidev of `bench/spi_bench.c`.
    Spi,
}

/// Rate of the SPI, Hz.
pub const SCK_HZ: u64 = 4_000_000;

/// Writes that may be unacknowledged over SPI (docs/protocol.md).
pub const WINDOW: usize = 6;

impl<B: SimulatedBoard> World<B> {
    /// A round of the thread at a serial port.
    pub(super) fn serial(&mut self) {
        let heard: Vec<u8> = std::iter::from_fn(|| self.board.next_byte()).collect();
        let heard = if self.cable { hex(&heard) } else { String::new() };
        let sent = self.bench.say(&format!("line {} {heard}-", self.now));
        let sent = bytes(sent.trim_end_matches('-'));
        if self.cable {
            sent.into_iter().for_each(|byte| self.board.say(byte));
        }
    }

    /// A round of the thread at an SPI.
    pub(super) fn transfers(&mut self) {
        let mut said = self.bench.say(&format!("spi {}", self.now));
        while let Some(out) = said.strip_prefix("x ") {
            let heard =
                if self.device { hex(&self.transfer(&bytes(out))) } else { "gone".to_owned() };
            said = self.bench.say(&format!("{heard} {}", self.now));
        }
        assert_eq!(said, "end");
    }

    /// A transfer over the bus. Without a cable, MISO is pulled up.
    fn transfer(&mut self, out: &[u8]) -> Vec<u8> {
        // No answer can come in the meantime.
        assert!(writes(out) <= WINDOW, "{out:x?}");
        // What another program has sent comes first, and its answers are not ours.
        while self.board.unsaid() > 0 {
            self.reach(self.board.cycle() + MS / 1000);
        }
        while self.board.next_byte().is_some() {}
        let mut heard = vec![0xff; out.len()];
        let begun = self.board.cycle();
        if self.cable {
            out.iter().for_each(|&byte| self.board.say(byte));
            while self.board.unsaid() > 0 {
                self.reach(self.board.cycle() + MS / 1000);
            }
            heard.fill_with(|| self.board.next_byte().unwrap());
            assert_eq!(self.board.next_byte(), None);
        } else {
            self.reach(begun + out.len() as u64 * 8 * CLOCK_HZ / SCK_HZ);
        }
        self.now = self.now.max(self.board.cycle() * 1000 / MS);
        heard
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        write!(text, "{byte:02x}").unwrap();
        text
    })
}

fn bytes(hex: &str) -> Vec<u8> {
    let byte = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    hex.as_bytes().chunks(2).map(byte).collect()
}

/// Number of writes among the requests of a transfer (docs/protocol.md): frames of 12 bytes or more.
/// OPEN and STOP have no place in their order.
fn writes(out: &[u8]) -> usize {
    let frames = out.split(|&byte| byte == 0xc0);
    let plain = |frame: &[u8]| {
        // An escape of two bytes stands for one.
        let bytes: Vec<u8> = frame.iter().copied().filter(|&byte| byte != 0xdb).collect();
        (bytes.len() >= 12).then(|| bytes[1])
    };
    frames.filter_map(plain).filter(|address| ![0xa5, 0xa6].contains(address)).count()
}

//! Rounds of the component's thread in simulated time: at a serial port, and at an SPI behind a
//! stand-in for spidev.

use super::line::{SCK_HZ, WINDOW, bytes, hex, writes};
use super::world::{CLOCK_HZ, MS, World};
use carrystep_virtual_board::SimulatedBoard;

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
        // Where this side has nothing to say, it sends END.
        assert!(out.ends_with(&[0xc0]), "{out:x?}");
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

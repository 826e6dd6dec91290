//! One direction of a line that flips, drops, repeats, cuts and delays bytes. Their order is kept.

use super::random::Random;
use std::collections::VecDeque;

/// Probabilities in millionths: `flip`, `drop` and `double` for each byte, the others for each
/// piece that is sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Faults {
    pub flip: u32,
    pub drop: u32,
    pub double: u32,
    /// The whole piece is repeated.
    pub again: u32,
    /// The rest of the piece is lost.
    pub cut: u32,
    /// The piece is delayed by some milliseconds.
    pub delay: u32,
}

impl Faults {
    /// A very bad line: every twentieth frame is damaged.
    pub const BAD: Self =
        Self { flip: 800, drop: 400, double: 400, again: 5000, cut: 10_000, delay: 20_000 };
}

#[derive(Debug)]
pub struct Wire {
    faults: Faults,
    random: Random,
    bytes: VecDeque<(u32, u8)>,
    due: u32,
    /// Number of bytes or pieces that were changed in any way other than a delay.
    pub harmed: u64,
}

impl Wire {
    pub fn new(faults: Faults, seed: u64) -> Self {
        Self { faults, random: Random::new(seed), bytes: VecDeque::new(), due: 0, harmed: 0 }
    }

    pub fn send(&mut self, now: u32, piece: &[u8]) {
        let Faults { flip, drop, double, again, cut, delay } = self.faults;
        let late = if self.random.happens(delay) { 1 + self.random.below(25) as u32 } else { 0 };
        self.due = self.due.max(now + late);
        let end = if self.random.happens(cut) {
            self.random.below(piece.len() as u64 + 1) as usize
        } else {
            piece.len()
        };
        self.harmed += u64::from(end < piece.len());
        let twice = self.random.happens(again);
        self.harmed += u64::from(twice);
        for &byte in [&piece[..end]].repeat(1 + usize::from(twice)).into_iter().flatten() {
            let flipped = self.random.happens(flip);
            let byte = if flipped { byte ^ 1 << self.random.below(8) } else { byte };
            let times = if self.random.happens(drop) {
                0
            } else {
                1 + usize::from(self.random.happens(double))
            };
            self.harmed += u64::from(flipped || times != 1);
            self.bytes.extend([(self.due, byte)].repeat(times));
        }
    }

    pub fn receive(&mut self, now: u32) -> Vec<u8> {
        let come = self.bytes.iter().take_while(|(due, _)| *due <= now).count();
        self.bytes.drain(..come).map(|(_, byte)| byte).collect()
    }
}

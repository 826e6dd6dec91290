//! A host that sends one request at a time, over a perfect line.

use super::link::device::on_the_line;
use super::{CLOCK_HZ, Kind, Seen};
use carrystep_core::link::{END, Uart};
use carrystep_link::registers::{CONTROL, OPEN, POSITION, SEGMENT, WRITE};
use carrystep_link::{Answer, frame};

/// Time limit for an answer, clocks.
const PATIENCE: u64 = 30_000;

/// The session of the host.
pub const SESSION: u16 = 0xdbc0;

/// The bytes of a write of this session, without its CRC.
pub fn write(sequence: u8, address: u8, session: u16, words: &[u32]) -> Vec<u8> {
    let head = [sequence, address].into_iter().chain(session.to_le_bytes());
    head.chain(words.iter().flat_map(|word| word.to_le_bytes())).collect()
}

/// A host that sends one request at a time.
pub struct Talk<B> {
    pub board: B,
    /// The sequence number of the next write.
    pub next: u8,
    /// The edges on the pins so far.
    pub edges: Seen,
}

impl<B: Kind> Talk<B> {
    /// A host that has opened a session.
    pub fn new() -> Self {
        Self::with(B::new(Uart::new(CLOCK_HZ, 3_000_000).unwrap()))
    }

    /// The same on this board.
    pub fn with(board: B) -> Self {
        let mut talk = Self { board, next: 0, edges: Seen::default() };
        let answer = talk.ask(&write(0x5a, WRITE | OPEN, SESSION, &[0]));
        assert_eq!((answer.next, answer.refusal), (0, None), "{answer:?}");
        talk
    }

    pub fn powered() -> Self {
        Self::new().power()
    }

    /// This host, once the drivers have power.
    pub fn power(mut self) -> Self {
        self.write(CONTROL, 1);
        while !self.read(POSITION).ready {}
        self
    }

    pub fn rest(&mut self, clocks: u64) {
        self.board.reach(self.board.cycle() + clocks, &mut self.edges);
    }

    pub fn send(&mut self, content: &[u8]) {
        on_the_line(content).iter().for_each(|&byte| self.board.say(byte));
    }

    /// The next answer, if one arrives.
    pub fn answer(&mut self) -> Option<Answer> {
        let end = self.board.cycle() + PATIENCE;
        let mut line = Vec::new();
        while self.board.cycle() < end {
            match self.board.next_byte() {
                None => self.rest(200),
                Some(END) if line.is_empty() => {}
                Some(END) => return Some(Answer::from_bytes(&super::unescaped(&line)).unwrap()),
                Some(byte) => line.push(byte),
            }
        }
        None
    }

    pub fn ask(&mut self, content: &[u8]) -> Answer {
        self.send(content);
        self.answer().unwrap_or_else(|| panic!("no answer to {content:02x?}"))
    }

    pub fn read(&mut self, address: u8) -> Answer {
        self.ask(&[0, address])
    }

    pub fn write(&mut self, address: u8, word: u32) -> Answer {
        self.words(WRITE | address, &[word])
    }

    pub fn segment(&mut self, axis: u8, words: [u32; 8]) -> Answer {
        self.words(WRITE | frame::of_axis(SEGMENT, axis), &words)
    }

    /// The bytes of a write of the owner, without its CRC.
    pub fn content(&self, sequence: u8, address: u8, words: &[u32]) -> Vec<u8> {
        write(sequence, address, SESSION, words)
    }

    /// A read of the owner, which restarts the watchdog.
    pub fn own_read(&mut self, address: u8) -> Answer {
        self.ask(&write(0, address, SESSION, &[]))
    }

    pub fn words(&mut self, address: u8, words: &[u32]) -> Answer {
        let answer = self.ask(&self.content(self.next, address, words));
        self.next = self.next.wrapping_add(1);
        assert_eq!(answer.next, self.next, "{answer:?}");
        answer
    }
}

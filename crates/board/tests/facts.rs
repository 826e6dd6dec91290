//! What docs/protocol.md says of rare requests and of the watchdog, from a board of models and from the exported Verilog.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_board::{Board, VerilatedBoard};
use carrystep_link::registers::{
    AXIS_COUNT, BUILD_HIGH, CLEAR, CONTROL, DISCARDED, HOME, IDENTITY, LATCHED, P_HIGH, P_LOW, POSITION, SEGMENT,
    START, WATCHDOG_TICKS, WRITE,
};
use carrystep_link::{Answer, frame};
use carrystep_spec::engine::Cause;
use carrystep_spec::link::{END, Uart};
use support::link::device::on_the_line;
use support::{CLOCK_HZ, Kind, MS};

/// An answer comes within so many clocks.
const PATIENCE: u64 = 30_000;

/// A host that has one request on its way.
struct Talk<B> {
    board: B,
    next: u8,
}

impl<B: Kind> Talk<B> {
    fn new() -> Self {
        Self { board: B::new(Uart::new(CLOCK_HZ, 3_000_000).unwrap()), next: 0 }
    }

    fn powered() -> Self {
        let mut talk = Self::new();
        talk.write(CONTROL, 1);
        while !talk.read(POSITION).ready {}
        talk
    }

    fn rest(&mut self, clocks: u64) {
        self.board.reach(self.board.cycle() + clocks, &mut ());
    }

    fn send(&mut self, content: &[u8]) {
        on_the_line(content).iter().for_each(|&byte| self.board.say(byte));
    }

    /// The next answer, if one comes.
    fn answer(&mut self) -> Option<Answer> {
        let end = self.board.cycle() + PATIENCE;
        let mut line = Vec::new();
        while self.board.cycle() < end {
            match self.board.next_byte() {
                None => self.rest(200),
                Some(END) if line.is_empty() => {}
                Some(END) => return Some(Answer::from_bytes(&unescaped(&line)).unwrap()),
                Some(byte) => line.push(byte),
            }
        }
        None
    }

    fn ask(&mut self, content: &[u8]) -> Answer {
        self.send(content);
        self.answer().unwrap_or_else(|| panic!("no answer to {content:02x?}"))
    }

    fn read(&mut self, address: u8) -> Answer {
        self.ask(&[0, address])
    }

    fn write(&mut self, address: u8, word: u32) -> Answer {
        self.words(WRITE | address, &[word])
    }

    fn segment(&mut self, axis: u8, words: [u32; 8]) -> Answer {
        self.words(WRITE | frame::of_axis(SEGMENT, axis), &words)
    }

    fn words(&mut self, address: u8, words: &[u32]) -> Answer {
        let head = [self.next, address];
        let content: Vec<u8> = head.into_iter().chain(words.iter().flat_map(|word| word.to_le_bytes())).collect();
        let answer = self.ask(&content);
        self.next = self.next.wrapping_add(1);
        assert_eq!(answer.next, self.next, "{answer:?}");
        answer
    }
}

/// A frame without its escapes.
fn unescaped(line: &[u8]) -> Vec<u8> {
    let mut bytes = line.iter();
    let mut frame = Vec::new();
    while let Some(&byte) = bytes.next() {
        frame.push(if byte == 0xdb { if bytes.next() == Some(&0xdc) { 0xc0 } else { 0xdb } } else { byte });
    }
    frame
}

/// V = a quarter of a step per tick.
const fn cruise(ticks_less_one: u32, last: bool) -> [u32; 8] {
    [ticks_less_one, 0, 0x4000_0000, 0, 0, 0, 0, last as u32]
}

fn explore<B: Kind>() {
    let mut talk = Talk::<B>::powered();
    for axis in 0..6 {
        for _ in 0..axis {
            talk.segment(axis, cruise(99, true));
        }
    }
    for address in 0..0x80_u8 {
        let a = talk.read(address);
        println!("read {address:02x}: free {} data {:08x} fault {} refused {}", a.free, a.data, a.fault, a.refused);
    }
    for address in (0x80..=0xff_u8).filter(|a| *a != 0xa1 && *a != 0xa2 && *a != 0xa0) {
        let mut fresh = Talk::<B>::powered();
        for axis in 0..6 {
            for _ in 0..axis {
                fresh.segment(axis, cruise(99, true));
            }
        }
        fresh.send(&[&[fresh.next, address][..], &[0; 4]].concat());
        let one = fresh.answer();
        fresh.send(&[&[fresh.next, address][..], &[0; 32]].concat());
        let eight = fresh.answer();
        println!(
            "write {address:02x}: one {:?}\n   eight {:?}",
            one.map(|a| (a.next, a.free, a.data, a.fault, a.cause, a.refused)),
            eight.map(|a| (a.next, a.free, a.data, a.fault, a.cause, a.refused))
        );
    }
    for mask in [0_u32, 0x40, 0x80, 0xffff_ff00, 0x100] {
        let mut fresh = Talk::<B>::powered();
        let a = fresh.write(START, mask);
        fresh.rest(20_000);
        println!("start {mask:x}: {a:?}\n   then {:?}", fresh.read(POSITION));
    }
    let mut fresh = Talk::<B>::powered();
    println!("longest: {:?}", fresh.segment(0, cruise(0xffff_fffe, true)));
    println!("none: {:?}", fresh.segment(0, cruise(0xffff_ffff, true)));
    // Watchdog
    let mut fresh = Talk::<B>::powered();
    fresh.segment(0, cruise(99, true));
    fresh.rest(250 * MS);
    println!("segment at rest: {:?}", fresh.read(POSITION));
    let mut fresh = Talk::<B>::powered();
    fresh.rest(250 * MS);
    println!("nothing at all: {:?}", fresh.read(POSITION));
    let mut fresh = Talk::<B>::new();
    fresh.segment(0, cruise(99, true));
    fresh.write(START, 1);
    fresh.rest(250 * MS);
    println!("armed no power: {:?}", fresh.read(POSITION));
}

#[test]
fn explore_models() {
    explore::<Board>();
}

#[test]
fn explore_verilog() {
    explore::<VerilatedBoard>();
}

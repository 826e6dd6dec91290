//! The example frames of docs/protocol.md, byte for byte, with a board of models and with the
//! exported Verilog.

use crate::support::link::device::on_the_line;
use crate::support::link::{hex, unhex};
use crate::support::requests::write;
use crate::support::{CLOCK_HZ, Kind};
use carrystep_core::link::Uart;
use carrystep_link::registers::{CONTROL, END, OPEN, POSITION, SEGMENT, START, WRITE};
use carrystep_link::{Answer, frame};
use carrystep_virtual_board::{ModelBoard, VerilatedBoard};

/// Time limit for an answer, clocks.
const PATIENCE: u64 = 30_000;

struct Talk<B> {
    board: B,
    next: u8,
}

impl<B: Kind> Talk<B> {
    /// The state that the page's host finds: axis 1 at -250, no power.
    fn new() -> Self {
        let mut talk = Self { board: B::new(Uart::new(CLOCK_HZ, 3_000_000).unwrap()), next: 0 };
        talk.send(&on_the_line(&write(0, WRITE | OPEN, 7, &[0])));
        assert_eq!(talk.answer()[2], 0);
        talk.write(CONTROL, &[1]);
        while !talk.state().ready {}
        talk.write(frame::of_axis(SEGMENT, 1), &[999, 0, 0xc000_0000, 0, 0, 0, 0, 1]);
        talk.write(START, &[2]);
        while !talk.state().idle {}
        talk.write(CONTROL, &[0]);
        talk
    }

    fn write(&mut self, address: u8, words: &[u32]) {
        self.send(&on_the_line(&write(self.next, WRITE | address, 7, words)));
        self.next = self.next.wrapping_add(1);
        assert_eq!(self.answer()[2], self.next);
    }

    fn state(&mut self) -> Answer {
        self.send(&on_the_line(&[0, POSITION]));
        Answer::from_bytes(&self.answer()).unwrap()
    }

    fn send(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.board.say(byte));
    }

    fn rest(&mut self, clocks: u64) {
        self.board.reach(self.board.cycle() + clocks, &mut ());
    }

    /// The bytes of the next answer between its ENDs.
    fn answer(&mut self) -> Vec<u8> {
        let end = self.board.cycle() + PATIENCE;
        let mut line = Vec::new();
        while self.board.cycle() < end {
            match self.board.next_byte() {
                None => self.rest(200),
                Some(END) if line.is_empty() => {}
                Some(END) => return line,
                Some(byte) => line.push(byte),
            }
        }
        panic!("no answer")
    }
}

/// The page's block of frames, and the same block with the answers of such a board.
fn replayed<B: Kind>() -> (&'static str, String) {
    let page = include_str!("../../../docs/protocol.md");
    let (_, rest) = page.split_once("```frames\n").unwrap();
    let (block, _) = rest.split_once("```").unwrap();
    let mut talk = Talk::<B>::new();
    let mut said = String::new();
    for line in block.lines() {
        let (kind, bytes) = line.split_once(' ').unwrap();
        let mut shown = bytes.to_owned();
        match kind {
            "#" => talk.rest(9000),
            ">" => talk.send(&unhex(bytes)),
            // A request that is lost on the line.
            ">x" => {}
            "<" | "<x" => shown = format!("c0 {} c0", hex(&talk.answer())),
            _ => panic!("{line}"),
        }
        said += &format!("{kind} {shown}\n");
    }
    (block, said)
}

#[test]
fn example_frames_equal_the_answers_of_the_models() {
    let (block, said) = replayed::<ModelBoard>();
    assert_eq!(said, block);
}

#[test]
fn example_frames_equal_the_answers_of_the_verilog() {
    let (block, said) = replayed::<VerilatedBoard>();
    assert_eq!(said, block);
}

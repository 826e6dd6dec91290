//! A talk with a board, told and shown on its pins: Rust-HDL's modules of line, link and engine say what every later stage must show.

use crate::link_bench::{BoardPins, LinkBench, Said, frame, on_the_line, unframe};
use carrystep_boards::Board;
use carrystep_core::AXES;
use carrystep_core::engine::Cause;
use carrystep_core::link::registers::{CLEAR, CONTROL, POSITION, SEGMENT, START, of_axis};
use carrystep_files::Source;
use carrystep_simulators::vectors::Vectors;
use carrystep_verilog::{Gateware, shipped_machine};

/// A board's gateware, and what its pins do in a talk.
pub struct Session {
    /// The shipped machine's, with nothing that takes milliseconds, and a line as fast as the clock makes it.
    pub gateware: Gateware<'static>,
    vectors: Vectors,
    /// All its Verilog.
    pub verilog: String,
}

impl Session {
    /// Power, a move of two axes, an e-stop, and on again.
    ///
    /// # Panics
    /// Where the modules do not talk as they should.
    pub fn of(board: &'static Board) -> Self {
        Self::with(board, talk)
    }

    /// Power, a move that meets its limit, the ramp to rest, and on again: some times as long.
    ///
    /// # Panics
    /// As [`Session::of`].
    pub fn with_a_limit(board: &'static Board) -> Self {
        Self::with(board, meet_a_limit)
    }

    fn with(board: &'static Board, talk: impl Fn(&mut LinkBench)) -> Self {
        // A level shifter in the line is none of the gateware's. A few boards are kept for as long as a test runs.
        let board: &'static Board = Box::leak(Box::new(Board { max_baud: None, ..board.clone() }));
        let text = shipped_machine(board, &board.clocks[0]).expect("a machine");
        let quick = "[machine.guard]\nenable_ms = 0\ndebounce_us = 0\nwatchdog_ms = 0\n";
        let text = text.replace("[machine.guard]\n", quick);
        let source = Source { path: "machine.toml".into(), text: text.into() };
        let gateware = Gateware::new(board, &board.parts[0], source).expect("gateware");
        assert_eq!(gateware.build().axes(), AXES);
        let mut bench = LinkBench::uart(gateware.build(), gateware.uart().expect("a UART"));
        bench.board = Some(BoardPins::new(board));
        talk(&mut bench);
        let vectors = bench.board.expect("what was kept").vectors;
        let verilog = gateware.verilog().expect("its Verilog").into_iter().map(|file| file.text).collect();
        Self { gateware, vectors, verilog }
    }

    /// The first cycle in which a pin of this Verilog, all cells of which have models, is another.
    ///
    /// # Panics
    /// Where Icarus is missing or refuses it.
    pub fn difference(&self, verilog: &str) -> Option<String> {
        self.vectors.difference(&self.gateware.top(), verilog).expect("Icarus")
    }

    /// Cycles of the talk.
    pub fn cycles(&self) -> u64 {
        self.vectors.cycles()
    }

    /// Constraints of the pins and so on, by the end of the file's name.
    ///
    /// # Panics
    /// Where there is no such file.
    pub fn file(&self, end: &str) -> String {
        let files = self.gateware.files().expect("its files");
        files.into_iter().find(|file| file.name.ends_with(end)).expect("a file").text
    }

    /// The Verilog with wires crossed on the way to the pins.
    pub fn crossed(&self) -> impl Iterator<Item = (&'static str, String)> {
        let crosses = [(".dir(dir)", ".dir(step)"), ("enable_n = !enabled", "enable_n = enabled")];
        crosses.into_iter().map(|(wire, other)| {
            let crossed = self.verilog.replace(wire, other);
            assert_ne!(crossed, self.verilog, "{wire} is not there");
            (other, crossed)
        })
    }
}

/// Sends a request and takes its answer.
fn ask(bench: &mut LinkBench, sequence: u8, address: u8, words: &[u32]) -> Said {
    bench.send(&on_the_line(&frame(sequence, address, words)));
    let answer = bench.answer(60_000).expect("an answer");
    Said::of(&unframe(&answer).expect("a frame"))
}

/// Words that are written one after the other, each executed.
fn writer() -> impl FnMut(&mut LinkBench, u8, &[u32]) {
    let mut next = 0;
    move |bench, address, words| {
        let said = ask(bench, next, 0x80 | address, words);
        next += 1;
        assert_eq!(said.next, next, "{said:?}");
    }
}

fn talk(bench: &mut LinkBench) {
    let mut write = writer();
    write(bench, CONTROL, &[1]);
    let cruise = |v: i64| [149, v as u32, (v >> 32) as u32, 0, 0x0020_0000, 0xdbc0, 0, 1];
    write(bench, of_axis(SEGMENT, 0), &cruise(1 << 60));
    write(bench, of_axis(SEGMENT, 5), &cruise(-(1 << 60)));
    write(bench, START, &[0b10_0001]);
    bench.rest(9_000);
    // A freeze is over at once, where a ramp takes a hundred thousand cycles.
    bench.pins.estop = true;
    bench.rest(3_000);
    let said = ask(bench, 9, of_axis(POSITION, 5), &[]);
    assert_eq!(said.fault, Some(Cause::EStop), "{said:?}");
    assert!(said.halted, "{said:?}");
    bench.pins.estop = false;
    bench.rest(3_000);
    write(bench, CLEAR, &[0]);
    assert_eq!(ask(bench, 9, POSITION, &[]).fault, None);
    assert!(bench.steps > 5, "{} steps", bench.steps);
}

fn meet_a_limit(bench: &mut LinkBench) {
    let mut write = writer();
    write(bench, CONTROL, &[1]);
    let v: i64 = -(1 << 56);
    write(bench, of_axis(SEGMENT, 5), &[1 << 20, v as u32, (v >> 32) as u32, 0, 0, 0, 0, 1]);
    write(bench, START, &[0b10_0000]);
    bench.rest(30_000);
    bench.pins.limit_min = 1 << 5;
    let polls = (0..100).map(|_| {
        bench.rest(10_000);
        ask(bench, 9, of_axis(POSITION, 5), &[])
    });
    let said = polls.into_iter().find(|said| said.halted).expect("the ramp is over");
    assert_eq!((said.fault, said.culprits), (Some(Cause::Limit), 1 << 5), "{said:?}");
    bench.pins.limit_min = 0;
    bench.rest(3_000);
    write(bench, CLEAR, &[0]);
    // Without a fault, nothing is left of its cause.
    let said = ask(bench, 9, of_axis(POSITION, 5), &[]);
    assert_eq!((said.fault, said.culprits), (None, 0), "{said:?}");
    assert!(said.data.cast_signed() < -3, "{said:?}");
}

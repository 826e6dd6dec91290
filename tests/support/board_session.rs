//! Records a session between a host and a board, in Rust-HDL's modules of line, link and engine.
//! The recording of the pins is the reference for every later stage.

use crate::link_bench::{BoardPins, Host, LinkBench, wide};
use carrystep_boards::Board;
use carrystep_core::AXES;
use carrystep_core::engine::Cause;
use carrystep_core::link::registers::{
    CLEAR, CONTROL, POSITION, SEGMENT, SEGMENTS, START, of_axis,
};
use carrystep_files::SourceText;
use carrystep_simulators::timed::TimedRun;
use carrystep_simulators::vectors::Vectors;
use carrystep_verilog::{Gateware, shipped_machine};

/// A board's gateware, and the levels of its pins during a session.
pub struct Session {
    /// The gateware of the shipped machine without the functions that take milliseconds, on a line
    /// at the highest baud rate that the clock allows.
    pub gateware: Gateware<'static>,
    vectors: Vectors,
    /// The Verilog of the whole board.
    pub verilog: String,
}

impl Session {
    /// A session: switch the drivers on, move two axes, press the e-stop, resume.
    ///
    /// # Panics If the modules do not answer as they should.
    pub fn of(board: &'static Board) -> Self {
        Self::with(board, talk)
    }

    /// A session: switch the drivers on, move into a limit, ramp down, resume. It takes several
    /// times as long as [`Session::of`].
    ///
    /// # Panics As [`Session::of`].
    pub fn with_a_limit(board: &'static Board) -> Self {
        Self::with(board, meet_a_limit)
    }

    /// A session with the gateware as it ships, on its own line: switch the drivers on, wait until
    /// starts are accepted, and move all axes, each in both directions. Both ends are models.
    ///
    /// # Panics As [`Session::of`].
    pub fn as_shipped(board: &'static Board) -> Self {
        let gateware = Gateware::shipped(board, &board.parts[0]).expect("gateware");
        let bench = LinkBench::models(gateware.build(), gateware.uart().expect("a UART"));
        Self::recorded(board, gateware, bench, move_all_axes)
    }

    fn with(board: &'static Board, talk: impl Fn(&mut LinkBench)) -> Self {
        // A level shifter in the line is not part of the gateware. The few leaked boards live until
        // the test ends.
        let board: &'static Board = Box::leak(Box::new(Board { max_baud: None, ..board.clone() }));
        let text = shipped_machine(board, &board.clocks[0]).expect("a machine");
        let quick = "[machine.guard]\nenable_ms = 0\ndebounce_us = 0\nwatchdog_ms = 0\n";
        let text = text.replace("[machine.guard]\n", quick);
        let source = SourceText { path: "machine.toml".into(), text: text.into() };
        let gateware = Gateware::new(board, &board.parts[0], source).expect("gateware");
        assert_eq!(gateware.build().axes(), AXES);
        let bench = LinkBench::rust_hdl(gateware.build(), gateware.uart().expect("a UART"));
        Self::recorded(board, gateware, bench, talk)
    }

    fn recorded(
        board: &'static Board,
        gateware: Gateware<'static>,
        mut bench: LinkBench,
        talk: impl Fn(&mut LinkBench),
    ) -> Self {
        bench.board = Some(BoardPins::new(board));
        talk(&mut bench);
        let vectors = bench.board.expect("what was kept").vectors;
        let verilog =
            gateware.verilog().expect("its Verilog").into_iter().map(|file| file.text).collect();
        Self { gateware, vectors, verilog }
    }

    /// Replays at most `cycles` cycles of the recording on Verilog with delays; see
    /// [`Vectors::timed`].
    ///
    /// # Panics If Icarus is missing or rejects the Verilog.
    pub fn timed(&self, verilog: &str, half_ps: u64, cycles: u64) -> TimedRun {
        self.vectors.timed(&self.gateware.top(), verilog, half_ps, cycles).expect("Icarus")
    }

    /// The first cycle in which a pin of this Verilog differs from the recording. Every cell in the
    /// Verilog must have a model.
    ///
    /// # Panics If Icarus is missing or rejects the Verilog.
    pub fn difference(&self, verilog: &str) -> Option<String> {
        self.vectors.difference(&self.gateware.top(), verilog).expect("Icarus")
    }

    /// Number of cycles in the session.
    pub fn cycles(&self) -> u64 {
        self.vectors.cycles()
    }

    /// The generated file whose name ends with `end`, for example the pin constraints.
    ///
    /// # Panics If there is no such file.
    pub fn file(&self, end: &str) -> String {
        let files = self.gateware.files().expect("its files");
        files.into_iter().find(|file| file.name.ends_with(end)).expect("a file").text
    }

    /// Versions of the Verilog in which wires to the pins are crossed.
    pub fn crossed(&self) -> impl Iterator<Item = (&'static str, String)> {
        let crosses = [(".dir(dir)", ".dir(step)"), ("enable_n = !enabled", "enable_n = enabled")];
        crosses.into_iter().map(|(wire, other)| {
            let crossed = self.verilog.replace(wire, other);
            assert_ne!(crossed, self.verilog, "{wire} is not there");
            (other, crossed)
        })
    }
}

fn talk(bench: &mut LinkBench) {
    let mut host = Host::open(bench, 1);
    host.write(bench, CONTROL, &[1]);
    let cruise = |v: i64| [149, v as u32, (v >> 32) as u32, 0, 0x0020_0000, 0xdbc0, 0, 1];
    host.write(bench, of_axis(SEGMENT, 0), &cruise(1 << 60));
    host.write(bench, of_axis(SEGMENT, 5), &cruise(-(1 << 60)));
    host.write(bench, START, &[0b10_0001]);
    bench.rest(9_000);
    // A freeze ends at once, whereas a ramp would take a hundred thousand cycles.
    bench.pins.estop = true;
    bench.rest(3_000);
    let said = bench.read(of_axis(POSITION, 5));
    assert_eq!(said.fault, Some(Cause::EStop), "{said:?}");
    assert!(said.halted, "{said:?}");
    bench.pins.estop = false;
    bench.rest(3_000);
    host.write(bench, CLEAR, &[0]);
    assert_eq!(bench.read(POSITION).fault, None);
    assert!(bench.steps > 5, "{} steps", bench.steps);
}

fn move_all_axes(bench: &mut LinkBench) {
    let mut host = Host::powered(bench);
    // Up to one step in eight ticks, and back at half of that.
    let there = [60, 59, 58, 57, 61, 59].map(|log| [1_i64 << log, 1 << 49, 0]);
    let back = there.map(|[v, a, j]| [-v / 2, a, j]);
    for (axes, last) in [(there, false), (back, true)] {
        let axes =
            [0, 1, 2, 3, 4, 5].map(|axis| axes[axis].map(|number| number * [1, -1][axis % 2]));
        host.write(bench, SEGMENTS, &wide(0b11_1111, 250, &axes, last));
    }
    host.run(bench, 0b11_1111);
    let said = bench.status();
    assert_eq!(said.fault, None, "{said:?}");
    assert!(bench.steps > 60, "{} steps", bench.steps);
}

fn meet_a_limit(bench: &mut LinkBench) {
    let mut host = Host::open(bench, 1);
    host.write(bench, CONTROL, &[1]);
    let v: i64 = -(1 << 56);
    host.write(bench, of_axis(SEGMENT, 5), &[1 << 20, v as u32, (v >> 32) as u32, 0, 0, 0, 0, 1]);
    host.write(bench, START, &[0b10_0000]);
    bench.rest(30_000);
    bench.pins.limit_min = 1 << 5;
    let polls = (0..100).map(|_| {
        bench.rest(10_000);
        bench.read(of_axis(POSITION, 5))
    });
    let said = polls.into_iter().find(|said| said.halted).expect("the ramp is over");
    assert_eq!((said.fault, said.culprits), (Some(Cause::Limit), 1 << 5), "{said:?}");
    bench.pins.limit_min = 0;
    bench.rest(3_000);
    host.write(bench, CLEAR, &[0]);
    // Without a fault, no cause is reported.
    let said = bench.read(of_axis(POSITION, 5));
    assert_eq!((said.fault, said.culprits), (None, 0), "{said:?}");
    assert!(said.data.cast_signed() < -3, "{said:?}");
}

//! A program that runs for hours on a board of models: every pulse has the tick that the plan gives
//! it, so that nothing drifts, neither steps nor time.
//!
//! The reference adds up the segments of the plan tick by tick and knows neither the model nor the
//! driver. It is fed with the rows as they are read, and compared with the pins each millisecond, so
//! that memory does not grow with the length of the run.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::support::wire::Faults;
use crate::support::{End, SESSION, asked};
use carrystep_core::Segment;
use carrystep_core::link::Uart;
use carrystep_files::{Machine, SourceText};
use carrystep_job::{Hold, Pace};
use carrystep_link::{Ended, Patience, Progress, Wish};
use carrystep_model::fast::{Change, Edge};
use carrystep_program::{ProgramFile, Rows, Settings};
use carrystep_runner::Stretches;
use carrystep_virtual_board::ModelBoard;
use std::cell::RefCell;
use std::collections::VecDeque;

/// A slow clock, because the model of the link takes time for each of its clocks. The 32 bits of
/// TICKS overflow after 7.2 hours.
const CLOCK_HZ: u64 = 6_000_000;
const BAUD: u32 = 750_000;
/// The host asks the board so often.
const EXCHANGE_MS: usize = 10;

const MACHINE: &str = "[machine]\nclock_hz = 6_000_000\ntick_ns = 6000\nphases = 4\nqueue_depth = 31\n\
    [machine.link]\nbaud = 750_000\n\
    [[machine.axis]]\nname = \"x\"\nsteps_per_unit = 80\nspeed_limit = 100\naccel_limit = 1000\n\
    driver = \"tmc2209\"\n\
    [[machine.axis]]\nname = \"y\"\nsteps_per_unit = 81\nspeed_limit = 100\naccel_limit = 1000\n\
    driver = \"tmc2209\"\n";

/// A loop of some 10 s, with places that are no whole steps, and its way back: the 10 000th one
/// ends where the first one does.
const LOOP: &str = "G1 X33.3333 Y-7.7777 F2400\nG3 X30 Y10 R9.5\nG1 X10.0001 Y20.0003\n\
    G2 X-3.3 Y3.7 R40 F1700\nG4 P0.05\nG0 X7 Y7\nG91\nG1 X-1.7 Y2.2 F3000\n\
    X0.9 Y0.1\nX0.1 Y-1.3\nG90\nG0 X0 Y0\n";

/// An axis as the reference has it: P, V and A of the running segment.
#[derive(Default)]
struct Sums {
    waiting: VecDeque<Segment>,
    p: u64,
    /// The ticks with pulses that have not come yet, and their directions.
    due: VecDeque<(u64, bool)>,
    tick: u64,
}

impl Sums {
    /// Adds up the next segment.
    fn add_up(&mut self) -> bool {
        let Some(segment) = self.waiting.pop_front() else { return false };
        let (mut v, mut a) = (segment.v, segment.a);
        for _ in 0..segment.ticks {
            let (sum, carry) = self.p.overflowing_add(v.cast_unsigned());
            if carry != (v < 0) {
                self.due.push_back((self.tick, v < 0));
            }
            (self.p, v, a) = (sum, v.wrapping_add(a), a.wrapping_add(segment.j));
            self.tick += 1;
        }
        true
    }

    /// The next pulse.
    fn next(&mut self) -> Option<(u64, bool)> {
        while self.due.is_empty() && self.add_up() {}
        self.due.pop_front()
    }
}

/// All axes, and where the pins begin.
#[derive(Default)]
struct Reference {
    axes: [Sums; 2],
    pulses: u64,
    most_waiting: usize,
}

impl Reference {
    fn compare(&mut self, edge: Edge, origin: u64, clocks_per_tick: u64) {
        if edge.change != Change::Rise {
            return;
        }
        let tick = (edge.clock - origin) / clocks_per_tick;
        let due = self.axes[usize::from(edge.axis)].next();
        assert_eq!(due, Some((tick, edge.backward)), "pulse {} on {edge:?}", self.pulses);
        self.pulses += 1;
    }
}

#[test]
fn program_of_hours_does_not_drift() {
    let seconds = asked("CARRYSTEP_HOURS", 30);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hours.ngc");
    let text = SourceText { path: "machine.toml".into(), text: MACHINE.into() };
    let machine = Machine::from_source(&text).unwrap();
    let planned = |loops: u64| {
        let program = format!("G21 G90 G64 P0.02\no1 repeat [{loops}]\n{LOOP}o1 endrepeat\nM2\n");
        std::fs::write(&path, program).unwrap();
        ProgramFile::open(&path, machine.clone(), &text.path, Settings::default()).unwrap()
    };
    let time = machine.timebase;
    let ticks_of = |loops| -> u64 {
        Rows::new(&planned(loops)).unwrap().map(|row| u64::from(row.unwrap().ticks)).sum()
    };
    // A loop between two others is a little shorter than one that begins and ends at rest.
    let ticks_of_one = ticks_of(3) - ticks_of(2);
    let wanted = (seconds * 1_000_000_000).div_ceil(time.tick_ns());
    let file = planned(wanted.div_ceil(ticks_of_one));

    let reference = RefCell::new(Reference::default());
    reference.borrow_mut().axes.iter_mut().for_each(|axis| axis.p = 1 << 63);
    let ticks = RefCell::new(0);
    let rows = Rows::new(&file).unwrap().map(Result::unwrap).inspect(|row| {
        *ticks.borrow_mut() += u64::from(row.ticks);
        let axes = &mut reference.borrow_mut().axes;
        axes.iter_mut().zip(&row.segments).for_each(|(axis, one)| axis.waiting.push_back(*one));
    });
    let (engine, uart) = (machine.engine(), Uart::new(CLOCK_HZ, BAUD).unwrap());
    let (start, hold) = (file.start_steps(), Hold::new(&machine).unwrap());
    let pace = Pace::new(&machine, &start).unwrap();
    let stretches = RefCell::new(Stretches::new(rows, &start, hold, pace, machine.queue));
    let end = End::of(ModelBoard::new(&engine, uart), uart, Faults::default(), 1)
        .clocked(CLOCK_HZ, EXCHANGE_MS);
    let mut host = end.connect_to(uart.build_id(&engine), Patience::default()).unwrap();
    host.open(SESSION).unwrap();
    host.enable().unwrap();
    let clocks_per_tick = u64::from(time.clocks_per_tick());
    let compare = || {
        let mut world = end.0.borrow_mut();
        let origin = world.board.loads().first().copied().unwrap_or(0) + time.latency_clocks();
        let mut reference = reference.borrow_mut();
        for edge in world.take_edges() {
            reference.compare(edge, origin, clocks_per_tick);
        }
        let waiting = reference.axes.iter().map(|axis| axis.waiting.len()).max().unwrap_or(0);
        reference.most_waiting = reference.most_waiting.max(waiting);
    };
    assert_eq!(stretches.borrow_mut().begin(), Some(Vec::new()));
    let ended = host.stream(&stretches, |_: &Progress<'_>| {
        compare();
        Wish::GoOn
    });
    assert_eq!(ended, Ok(Ended::Done));
    compare();
    assert_eq!(stretches.borrow_mut().begin(), None);
    assert_eq!(host.status().positions[..2], [0, 0]);
    let mut reference = reference.into_inner();
    for axis in &mut reference.axes {
        assert_eq!((axis.next(), axis.p), (None, 1 << 63), "P is back at its start value");
    }
    // What is kept does not depend on the length: a queue, what is on the line, and what is read
    // ahead.
    assert!(reference.most_waiting < 2000, "{}", reference.most_waiting);
    let ran = *ticks.borrow() * time.tick_ns() / 1_000_000_000;
    assert!(ran >= seconds && reference.pulses > 1000 * seconds, "{ran} s");
    eprintln!(
        "FIGURES {ran} s of the board's time, {} pulses, each in its tick; drift 0 steps",
        reference.pulses
    );
}

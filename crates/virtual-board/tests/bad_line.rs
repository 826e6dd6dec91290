//! A board on a line that flips, drops, repeats, cuts and delays bytes. Its pulses must be those of
//! a clean line, or it must have stopped with a cause. The environment variable `CARRYSTEP_FRAMES`
//! sets the total number of frames.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::support::random::Random;
use crate::support::wire::Faults;
use crate::support::{BoardHost, CLOCK_HZ, End, Kind, asked, waves};
use carrystep_core::AXES;
use carrystep_core::engine::Cause;
use carrystep_core::link::Uart;
use carrystep_link::{Command, Ended, HostError, Program, Wish};
use carrystep_model::fast::Edge;
use carrystep_virtual_board::{ModelBoard, VerilatedBoard};

/// Segments of an axis in a move, and ticks of each. The queues then hold a seventh of a second.
const SEGMENTS: u32 = 40;
const TICKS: u32 = 10_000;

fn uart() -> Uart {
    Uart::new(CLOCK_HZ, 3_000_000).unwrap()
}

/// Result of a move: its edges from its load on, and the stop that ended it.
struct Went {
    edges: Vec<Edge>,
    /// Cycles since the load, and the cause.
    stop: Option<(u64, Cause)>,
}

/// Executes a move, and clears the stop that may have ended it.
fn make<B: Kind>(end: &End<B>, host: &mut BoardHost<B>, commands: &[Command]) -> Went {
    let (loads, stops) = (end.0.borrow().board.loads().len(), end.0.borrow().board.stops().len());
    let ended = host.stream(Program::new(commands, AXES as u8).unwrap(), |_| Wish::GoOn);
    let positions = host.status().positions;
    let went = {
        let world = end.0.borrow();
        let load = world.board.loads().get(loads).copied().unwrap_or(u64::MAX);
        assert!(world.board.loads().len() <= loads + 1, "a move was started twice");
        for axis in 0..AXES as u8 {
            assert_eq!(
                positions[usize::from(axis)],
                world.travelled(axis),
                "the position of axis {axis} is not true"
            );
        }
        let stop = world
            .board
            .stops()
            .get(stops)
            .map(|&(cycle, cause)| (cycle.saturating_sub(load), cause));
        Went { edges: world.edges_since(load), stop }
    };
    match (ended, went.stop) {
        (Ok(Ended::Done), None) => {}
        (Err(HostError::Fault { cause, .. }), Some((_, called))) => {
            assert_eq!(cause, called as u8, "the stop has another name");
            host.clear().unwrap();
        }
        other => panic!("{other:?}"),
    }
    went
}

/// Runs a move with a new board on a line with these faults. Also returns how often the line did
/// damage.
fn on_a_line<B: Kind>(faults: Faults, seed: u64, commands: &[Command]) -> (Went, u64) {
    let end = End::<B>::new(uart(), faults, seed);
    let mut host = end.connect(uart());
    host.enable().unwrap();
    let went = make(&end, &mut host, commands);
    let harmed = end.0.borrow().harmed();
    (went, harmed)
}

/// The edges must be equal; after a stop they must be a prefix.
fn compare(went: &Went, clean: &[Edge]) {
    let until = went.stop.map_or(u64::MAX, |(cycle, _)| cycle);
    let before = |edges: &[Edge]| {
        edges.iter().take_while(|edge| edge.clock < until).copied().collect::<Vec<_>>()
    };
    let (found, expected) = (before(&went.edges), before(clean));
    if let Some(place) = found.iter().zip(&expected).position(|(one, other)| one != other) {
        panic!("edge {place} is {:?}, on a clean line {:?}", found[place], expected[place]);
    }
    assert_eq!(found.len(), expected.len(), "edges, stop {:?}", went.stop);
}

#[test]
fn pulses_on_a_bad_line_equal_those_on_a_clean_line() {
    let frames = asked("CARRYSTEP_FRAMES", 3000);
    let mut random = Random::new(11);
    let (mut sent, mut moves, mut stops, mut edges, mut harmed) = (0, 0_u64, 0_u64, 0, 0);
    while sent < frames {
        let commands = waves(&mut random, SEGMENTS, TICKS);
        let (clean, _) = on_a_line::<ModelBoard>(Faults::default(), 0, &commands);
        assert_eq!(clean.stop, None);
        let (went, harms) = on_a_line::<ModelBoard>(Faults::BAD, random.next(), &commands);
        compare(&went, &clean.edges);
        if let Some((_, cause)) = went.stop {
            // A damaged frame can only have been missing or late, so no other cause is possible.
            assert!(matches!(cause, Cause::Underrun | Cause::Watchdog), "{cause:?}");
            stops += 1;
        }
        edges += went.edges.len();
        sent += commands.len() as u64;
        moves += 1;
        harmed += harms;
    }
    eprintln!(
        "FIGURES {sent} frames in {moves} moves, the line harmed {harmed} times, {stops} moves stopped, {edges} edges as on a clean line"
    );
    assert!(harmed > sent / 50, "the line is too good: {harmed}");
    assert!(stops * 2 < moves, "too few moves are made: {stops} of {moves} stopped");
}

/// The exported Verilog on the same line; its pulses must equal those of the models on a clean
/// line. Which bytes are harmed depends on the build id too, so a move may be stopped: then another
/// one is made, up to four.
#[test]
fn pulses_of_the_verilog_on_a_bad_line_equal_those_of_models_on_a_clean_line() {
    let commands = waves(&mut Random::new(12), 9, 3000);
    let (clean, _) = on_a_line::<ModelBoard>(Faults::default(), 0, &commands);
    let is_whole = (5..9).any(|seed| {
        let (went, harms) = on_a_line::<VerilatedBoard>(Faults::BAD, seed, &commands);
        compare(&went, &clean.edges);
        eprintln!(
            "FIGURES the line harmed {harms} times, {} edges, stop {:?}",
            went.edges.len(),
            went.stop
        );
        assert!(harms > 1, "the line is too good");
        if let Some((_, cause)) = went.stop {
            assert!(matches!(cause, Cause::Underrun | Cause::Watchdog), "{cause:?}");
        }
        went.stop.is_none()
    });
    assert!(is_whole, "too little is made");
}

/// `CARRYSTEP_GARBAGE` sets the length of the test in ms.
#[test]
fn garbage_hangs_nothing() {
    hears_garbage::<ModelBoard>(asked("CARRYSTEP_GARBAGE", 2000));
}

/// `CARRYSTEP_VERILOG_MS` sets the length of the test in ms.
#[test]
fn garbage_does_not_hang_the_verilog_at_921_600_baud() {
    hears_garbage::<VerilatedBoard>(asked("CARRYSTEP_VERILOG_MS", 50));
}

fn hears_garbage<B: Kind>(milliseconds: u64) {
    // At the full rate of the line.
    let uart = Uart::new(CLOCK_HZ, 921_600).unwrap();
    let end = End::<B>::new(uart, Faults::default(), 3);
    let mut random = Random::new(9);
    let mut bytes = 0_u64;
    for _ in 0..milliseconds {
        let mut world = end.0.borrow_mut();
        while world.board.unsaid() < 92 {
            let any = random.next() as u8;
            world.board.say(if random.below(5) == 0 {
                [0xc0, 0xdb, 0xdc, 0xdd][usize::from(any & 3)]
            } else {
                any
            });
            bytes += 1;
        }
        drop(world);
        end.wait(1);
    }
    assert_eq!(end.0.borrow().board.stops(), []);
    let mut host = end.connect(uart);
    assert_eq!(host.status().answer.next, 0, "garbage was executed");
    host.enable().unwrap();
    let went = make(&end, &mut host, &waves(&mut random, 3, 3000));
    assert_eq!(went.stop, None);
    eprintln!(
        "FIGURES {bytes} bytes of garbage in {} s of the line's time, nothing executed, then a move",
        milliseconds as f64 / 1000.0
    );
}

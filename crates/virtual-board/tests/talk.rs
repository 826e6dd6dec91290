//! A host and a board in one process, in simulated time: connecting, a move, a stop.

use crate::support::{CLOCK_HZ, Kind, build};
use carrystep_core::link::Uart;
use carrystep_link::{
    Clock, Command, Ended, Exchanged, Host, HostError, Line, Patience, Program, Segment, Wish,
};
use carrystep_model::fast::Edge;
use carrystep_virtual_board::{ModelBoard, Switches, VerilatedBoard};
use std::cell::RefCell;
use std::convert::Infallible;
use std::num::NonZeroU16;
use std::rc::Rc;

/// The session of the host.
const SESSION: NonZeroU16 = NonZeroU16::new(1).unwrap();

/// The host's end. Each exchange lasts half a millisecond of the board's time.
struct End<B>(Rc<RefCell<(B, Vec<Edge>)>>);

impl<B> Clone for End<B> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<B: Kind> End<B> {
    fn new(uart: Uart) -> Self {
        Self(Rc::new(RefCell::new((B::new(uart), Vec::new()))))
    }
}

impl<B: Kind> Clock for End<B> {
    fn milliseconds(&mut self) -> u32 {
        (self.0.borrow().0.cycle() / (CLOCK_HZ / 1000)) as u32
    }
}

impl<B: Kind> Line for End<B> {
    type Error = Infallible;

    fn exchange(&mut self, out: &[u8], into: &mut [u8]) -> Result<Exchanged, Infallible> {
        let (board, edges) = &mut *self.0.borrow_mut();
        out.iter().for_each(|&byte| board.say(byte));
        let end = board.cycle() + CLOCK_HZ / 2000;
        board.reach(end, edges);
        let mut received = 0;
        for place in into {
            let Some(byte) = board.next_byte() else { break };
            *place = byte;
            received += 1;
        }
        Ok(Exchanged { sent: out.len(), received })
    }
}

fn connected<B: Kind>(baud: u32) -> (End<B>, Host<End<B>, End<B>>) {
    let uart = Uart::new(CLOCK_HZ, baud).unwrap();
    let end = End::new(uart);
    let id = uart.build_id(&build());
    let host = Host::connect(
        end.clone(),
        end.clone(),
        Some(id.0),
        Patience { change: 50, ..Patience::default() },
    )
    .unwrap();
    (end, host)
}

/// A program of a hundred steps forward and as many backward, in `pieces` segments, on two axes.
fn commands(pieces: u32) -> Vec<Command> {
    let v = i64::MAX / 100;
    let mut commands = Vec::new();
    for piece in 0..pieces {
        for axis in [0, 3] {
            let v = if piece % 2 == 0 { v } else { -v };
            let segment = Segment { ticks: 1000, v, a: 0, j: 0, last: piece + 1 == pieces };
            commands.push(Command::Segment { axis, segment });
        }
    }
    commands.push(Command::Start { mask: 0b1001 });
    commands
}

/// The edges of a move from its load on.
fn moves<B: Kind>(baud: u32) -> Vec<Edge> {
    let (end, mut host) = connected::<B>(baud);
    assert_eq!(
        (host.facts().axes, host.facts().tick_ns, host.facts().watchdog_ticks),
        (6, 2000, 50_176)
    );
    host.open(SESSION).unwrap();
    host.enable().unwrap();
    let commands = commands(41);
    let ended = host.stream(Program::new(&commands, 6).unwrap(), |_| Wish::GoOn).unwrap();
    assert_eq!(ended, Ended::Done);
    // The fraction of the position is half a step at the start.
    assert_eq!(host.status().positions[..6], [5, 0, 0, 5, 0, 0], "{:?}", host.status());
    let (board, edges) = &*end.0.borrow();
    assert_eq!(board.position(3), 5);
    let load = board.loads()[0];
    edges.iter().map(|edge| Edge { clock: edge.clock - load, ..*edge }).collect()
}

fn stops<B: Kind>() {
    let (end, mut host) = connected::<B>(921_600);
    host.open(SESSION).unwrap();
    host.enable().unwrap();
    let commands = commands(401);
    let program = || Program::new(&commands, 6).unwrap();
    let mut looks = 0;
    let ended = host.stream(program(), |_| {
        looks += 1;
        if looks == 100 { Wish::Stop } else { Wish::GoOn }
    });
    assert_eq!(ended, Ok(Ended::Stopped));
    let true_position = end.0.borrow().0.position(0);
    assert_eq!(host.status().positions[0], true_position);
    host.clear().unwrap();

    let pressed = end.clone();
    let mut looks = 0;
    let error = host.stream(program(), |_| {
        looks += 1;
        if looks == 60 {
            pressed.0.borrow_mut().0.press(Switches { estop: true, ..Switches::default() });
        }
        Wish::GoOn
    });
    assert_eq!(error, Err(HostError::Fault { cause: 0, culprits: 0 }));
    assert_eq!(host.clear(), Err(HostError::StillPressed));
    end.0.borrow_mut().0.press(Switches::default());
    host.clear().unwrap();
}

#[test]
fn board_reports_its_facts_and_moves() {
    for baud in [921_600, 3_000_000] {
        moves::<ModelBoard>(baud);
    }
}

#[test]
fn board_stops_on_request_and_at_a_switch() {
    stops::<ModelBoard>();
}

#[test]
fn verilog_makes_the_same_pulses_in_the_same_clocks() {
    let baud = 3_000_000;
    let edges = moves::<VerilatedBoard>(baud);
    assert!(edges.len() > 400, "{} edges are no move", edges.len());
    assert_eq!(edges, moves::<ModelBoard>(baud));
}

#[test]
fn verilog_stops_on_request_and_at_a_switch() {
    stops::<VerilatedBoard>();
}

/// The answers of a board to some requests in the middle of a move, and its final state. It runs
/// `at_once` clocks per call.
fn said(at_once: u64) -> (Vec<u8>, String) {
    let (end, mut host) = connected::<ModelBoard>(3_000_000);
    host.open(SESSION).unwrap();
    host.enable().unwrap();
    let commands = commands(41);
    let mut looks = 0;
    let stopped = host.stream(Program::new(&commands, 6).unwrap(), |_| {
        looks += 1;
        if looks == 50 { Wish::Stop } else { Wish::GoOn }
    });
    assert_eq!(stopped, Ok(Ended::Stopped));
    let mut board = end.0.borrow().0.clone();
    let mut said = Vec::new();
    let identity = [0xc0, 0x00, 0x00, 0xff, 0x12, 0xd9, 0x41, 0xc0];
    let position = [0xc0, 0x02, 0x71, 0xd7, 0x31, 0xed, 0x54, 0xc0];
    for request in [identity, position] {
        request.iter().for_each(|&byte| board.say(byte));
        let until = board.cycle() + 10_000;
        while board.cycle() < until {
            board.run((board.cycle() + at_once).min(until), &mut ());
        }
        said.extend(std::iter::from_fn(|| board.next_byte()));
    }
    (said, format!("{board:?}"))
}

#[test]
fn result_does_not_depend_on_the_clocks_per_call() {
    let slowly = said(1);
    assert!(slowly.0.len() >= 36, "{slowly:?}");
    for at_once in [7, 96, 1000, 10_000] {
        assert!(said(at_once) == slowly, "{at_once} at once");
    }
}

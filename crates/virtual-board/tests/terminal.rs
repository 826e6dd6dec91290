//! Hosts in Rust and in C that open the pseudo-terminal of a board as their serial port. The pulses
//! must equal those of a board in simulated time.
#![cfg(unix)]

use crate::support::link::c_library::CClient;
use crate::support::random::Random;
use crate::support::wire::Faults;
use crate::support::words::WordHost;
use crate::support::{self, CLOCK_HZ, End, Kind, MS, Seen, build, waves};
use carrystep_core::AXES;
use carrystep_core::link::Uart;
use carrystep_link::host::SystemClock;
use carrystep_link::line::serial::SerialLine;
use carrystep_link::{Command, Ended, Host, Patience, Program, Wish};
use carrystep_model::fast::Edge;
use carrystep_virtual_board::{ModelBoard, Pace, RealTimeBoard, Terminal, VerilatedBoard};
use std::sync::atomic::{AtomicBool, Ordering};

fn uart() -> Uart {
    Uart::new(CLOCK_HZ, 3_000_000).unwrap()
}

/// A program that fits into the queues completely: the Verilog cannot report how far its queues
/// reach, and its host may be delayed.
fn commands() -> Vec<Command> {
    waves(&mut Random::new(8), 7, 2000)
}

/// How far a board runs ahead of its host, clocks: a quarter of the watchdog's time.
const AHEAD: u64 = 25 * MS;

/// The edges from the first load on of a board whose host executes `host` with the name of its
/// port. Behind the last byte on the line the board runs for so many clocks.
fn served<B: Kind>(ahead: u64, host: impl FnOnce(&str)) -> Vec<Edge> {
    let terminal = Terminal::new().unwrap();
    let port = terminal.name().to_owned();
    let is_over = &AtomicBool::new(false);
    std::thread::scope(|scope| {
        let board = scope.spawn(move || {
            let pace = Pace::fast(CLOCK_HZ, ahead);
            let mut real_time = RealTimeBoard::new(B::new(uart()), terminal, pace, CLOCK_HZ);
            let mut seen = Seen::default();
            while !is_over.load(Ordering::Relaxed) {
                real_time.step(&mut seen).unwrap();
            }
            seen.since(real_time.board.loads()[0])
        });
        // The board's thread ends even if its host fails.
        let _over = Over(is_over);
        host(&port);
        drop(_over);
        board.join().unwrap()
    })
}

/// Sets the flag when it is dropped.
struct Over<'a>(&'a AtomicBool);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

fn in_rust(port: &str) {
    let line = SerialLine::open(port, uart().baud()).unwrap();
    // A simulated board may be slow.
    let patience =
        Patience { silence: 60_000, lost: 60_000, change: 60_000, ..Patience::default() };
    let id = uart().build_id(&build()).0;
    let mut host: Host<_, _> =
        Host::connect(line, SystemClock::default(), Some(id), patience).unwrap();
    host.open(support::SESSION).unwrap();
    host.enable().unwrap();
    let commands = commands();
    assert_eq!(
        host.stream(Program::new(&commands, AXES as u8).unwrap(), |_| Wish::GoOn).unwrap(),
        Ended::Done
    );
}

fn in_c(port: &str) {
    let line = SerialLine::open(port, uart().baud()).unwrap();
    let mut client = CClient::shared();
    let id = uart().build_id(&build()).0;
    let mut host = WordHost::connect(&mut client, line, SystemClock::default(), 40, id).unwrap();
    host.enable();
    assert_eq!(host.stream(&commands(), || false), None);
}

#[test]
fn pulses_through_a_terminal_equal_those_in_simulated_time() {
    let end = End::<ModelBoard>::new(uart(), Faults::default(), 0);
    let mut host = end.connect(uart());
    host.enable().unwrap();
    host.stream(Program::new(&commands(), AXES as u8).unwrap(), |_| Wish::GoOn).unwrap();
    let world = end.0.borrow();
    let expected = world.edges_since(world.board.loads()[0]);
    assert!(expected.len() > 100, "{} edges are no move", expected.len());
    assert!(served::<ModelBoard>(AHEAD, in_rust) == expected, "models, a host in Rust");
    assert!(served::<ModelBoard>(AHEAD, in_c) == expected, "models, a host in C");
    // A board answers a request that takes longer on the line than the board runs ahead.
    assert!(served::<ModelBoard>(100, in_rust) == expected, "models that stay near their host");
    assert!(served::<VerilatedBoard>(AHEAD, in_rust) == expected, "the Verilog, a host in Rust");
    assert!(served::<VerilatedBoard>(AHEAD, in_c) == expected, "the Verilog, a host in C");
}

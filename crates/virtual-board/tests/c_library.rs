//! The C library as the host of a board, of models and of exported Verilog. The pulses must equal
//! those of the driver in Rust, on a clean and on a bad line, over UART and SPI. Another build must
//! be refused.

use crate::support::bus::Bus;
use crate::support::link::c_library::CClient;
use crate::support::link::client::{Client, RustClient};
use crate::support::random::Random;
use crate::support::wire::Faults;
use crate::support::words::{Refused, WordHost};
use crate::support::{CLOCK_HZ, End, Kind, MS, build, waves};
use carrystep_core::AXES;
use carrystep_core::engine::Cause;
use carrystep_core::link::{LineKind, Uart};
use carrystep_link::line::spi::SpiLine;
use carrystep_link::{Command, Patience, Program, Wish};
use carrystep_model::fast::Edge;
use carrystep_virtual_board::{ModelBoard, VerilatedBoard};

fn uart() -> Uart {
    Uart::new(CLOCK_HZ, 3_000_000).unwrap()
}

/// A move with segments of this number of ticks.
fn commands(ticks: u32) -> Vec<Command> {
    waves(&mut Random::new(12), 9, ticks)
}

fn connect<'a, B: Kind>(client: &'a mut dyn Client, end: &End<B>) -> WordHost<'a, End<B>, End<B>> {
    WordHost::connect(client, end.clone(), end.clone(), 12, uart().build_id(&build()).0).unwrap()
}

/// The edges that the driver in Rust makes with a board of models on a clean line.
fn clean(commands: &[Command]) -> Vec<Edge> {
    let end = End::<ModelBoard>::new(uart(), Faults::default(), 0);
    let mut host = end.connect(uart());
    host.enable().unwrap();
    host.stream(Program::new(commands, AXES as u8).unwrap(), |_| Wish::GoOn).unwrap();
    let world = end.0.borrow();
    world.edges_since(world.board.loads()[0])
}

/// The edges that a client makes, and how often the line did damage.
fn moves<B: Kind>(
    client: &mut dyn Client,
    commands: &[Command],
    faults: Faults,
    seed: u64,
) -> (Vec<Edge>, u64) {
    let end = End::<B>::new(uart(), faults, seed);
    let mut host = connect(client, &end);
    host.enable();
    assert_eq!(host.stream(commands, || false), None);
    for axis in 0..AXES as u8 {
        assert_eq!(
            host.position(axis),
            end.0.borrow().travelled(axis),
            "the position of axis {axis}"
        );
    }
    let world = end.0.borrow();
    (world.edges_since(world.board.loads()[0]), world.harmed())
}

#[test]
fn c_client_makes_the_pulses_of_the_rust_driver() {
    // The segments are so long that the queues do not run empty while the line repeats frames.
    let commands = commands(12_000);
    let clean = clean(&commands);
    assert!(clean.len() > 500, "{} edges are no move", clean.len());
    for seed in 0..4 {
        let mut c = CClient::shared();
        assert!(
            moves::<ModelBoard>(&mut c, &commands, Faults::default(), seed).0 == clean,
            "on a clean line"
        );
        let (edges, harmed) = moves::<ModelBoard>(&mut c, &commands, Faults::BAD, seed);
        assert!(edges == clean && harmed > 0, "on a bad line, {seed}");
        let rust = moves::<ModelBoard>(&mut RustClient::default(), &commands, Faults::BAD, seed);
        assert!(rust == (edges, harmed), "the client in Rust says something else, {seed}");
    }
}

#[test]
fn c_client_with_verilog_on_a_bad_line_makes_the_pulses_of_the_rust_driver() {
    let commands = commands(5000);
    let (edges, harmed) =
        moves::<VerilatedBoard>(&mut CClient::shared(), &commands, Faults::BAD, 5);
    assert!(edges == clean(&commands) && harmed > 0);
}

/// The move after a stop begins where the stop left the axes.
fn stops<B: Kind>() {
    let end = End::<B>::new(uart(), Faults::default(), 3);
    let mut client = CClient::shared();
    let mut host = connect(&mut client, &end);
    host.enable();
    let commands = commands(3000);
    let moves = || {
        let world = end.0.borrow();
        world.board.loads().first().is_some_and(|load| world.board.cycle() > load + 20 * MS)
    };
    let stopped = host.stream(&commands, moves);
    assert_eq!(stopped, Some(Cause::Stop as u8));
    assert!(end.0.borrow().board.rests() && end.0.borrow().last_edge().is_some());
    host.clear();
    assert_eq!(host.stream(&commands, || false), None);
    for axis in 0..AXES as u8 {
        assert_eq!(
            host.position(axis),
            end.0.borrow().travelled(axis),
            "the position of axis {axis}"
        );
    }
}

#[test]
fn c_client_stops_and_resumes() {
    stops::<ModelBoard>();
    stops::<VerilatedBoard>();
}

#[test]
fn c_client_works_over_spi() {
    // At most six unacknowledged segments over SPI (docs/protocol.md).
    let mut client =
        CClient::with(&["-UCARRYSTEP_SLOTS", "-DCARRYSTEP_SLOTS=6"], |_, text| text.to_owned());
    let clean = clean(&commands(3000));
    assert!(over_bus::<ModelBoard>(&mut client) == clean, "models");
    assert!(over_bus::<VerilatedBoard>(&mut client) == clean, "the Verilog");
}

fn over_bus<B: Kind>(client: &mut dyn Client) -> Vec<Edge> {
    let bus = Bus::<B>::new(9_600_000);
    let id = LineKind::Spi.build_id(&build()).0;
    let mut host =
        WordHost::connect(client, SpiLine::new(bus.clone()), bus.clone(), 12, id).unwrap();
    host.enable();
    assert_eq!(host.stream(&commands(3000), || false), None);
    let wired = bus.0.borrow();
    wired.edges_since(wired.board.loads()[0])
}

#[test]
fn another_build_is_refused_and_named() {
    refused::<ModelBoard>();
    refused::<VerilatedBoard>();
}

/// The same engine with an SPI is another build.
fn refused<B: Kind>() {
    let end = End::<B>::new(uart(), Faults::default(), 1);
    let other = LineKind::Spi.build_id(&build());
    let mut client = CClient::shared();
    let refused = WordHost::connect(&mut client, end.clone(), end.clone(), 12, other.0).err();
    assert_eq!(
        refused,
        Some(Refused { verdict: "build".to_owned(), build: uart().build_id(&build()).0 })
    );
    let host = end.connect_to(uart().build_id(&build()), Patience::default()).unwrap();
    assert_eq!(host.status().answer.next, 0, "something was written");
}

//! The number of segments per second that a line delivers to a board without an empty queue.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::support::bus::Bus;
use crate::support::random::Random;
use crate::support::wire::Faults;
use crate::support::{CLOCK_HZ, End, Kind, TICK_NS, asked, waves};
use carrystep_core::link::Uart;
use carrystep_link::{Ended, Program, Wish};
use carrystep_virtual_board::{ModelBoard, VerilatedBoard};
use std::num::NonZeroU16;

/// The number of waiting segments where nothing shows it: at the pins of the Verilog.
const UNSEEN: usize = usize::MAX;

/// The session of the host.
const SESSION: NonZeroU16 = NonZeroU16::new(0xdbc0).unwrap();

/// The number of segments that always wait over SPI.
const OVER_SPI: usize = 6;

/// Streams `per_second` segments per second to each of six axes for some milliseconds. At least
/// `waiting` segments always wait in each queue, and at some time no more do.
#[track_caller]
fn carries<B: Kind>(baud: u32, per_second: u32, milliseconds: u32, waiting: usize) {
    let uart = Uart::new(CLOCK_HZ, baud).unwrap();
    let end = End::<B>::new(uart, Faults::default(), 1);
    let mut host = end.connect(uart);
    host.open(SESSION).unwrap();
    host.enable().unwrap();
    let ticks = (1_000_000_000 / TICK_NS) as u32 / per_second;
    let commands = waves(&mut Random::new(7), per_second * milliseconds / 1000, ticks);
    let begun = end.0.borrow().board.cycle();
    let ended = host.stream(Program::new(&commands, 6).unwrap(), |progress| {
        end.0.borrow_mut().handed_over = progress.handed_over;
        Wish::GoOn
    });
    let world = end.0.borrow();
    let took = (world.board.cycle() - begun) as f64 / CLOCK_HZ as f64;
    let shown = match world.least_waiting {
        UNSEEN => String::new(),
        least => format!(", at least {least} waiting"),
    };
    assert_eq!(ended, Ok(Ended::Done));
    eprintln!(
        "FIGURES {baud} baud: 6 x {per_second} segments/s, {} segments in {took:.3} s{shown}, no queue dry",
        commands.len() - 1,
    );
    assert_eq!(world.least_waiting, waiting, "segments in the emptiest queue");
}

/// The same over SPI with the embedded-hal driver and at most six unacknowledged segments
/// (docs/protocol.md).
#[test]
fn spi_carries_1000_segments_per_second_for_six_axes() {
    let bus = Bus::<ModelBoard>::new(9_600_000);
    let mut host = bus.connect();
    host.open(SESSION).unwrap();
    host.enable().unwrap();
    let per_second = 1000;
    let commands = waves(
        &mut Random::new(7),
        per_second * 3 / 2,
        (1_000_000_000 / TICK_NS) as u32 / per_second,
    );
    let begun = bus.0.borrow().board.cycle();
    let ended = host.stream(Program::new(&commands, 6).unwrap(), |progress| {
        bus.0.borrow_mut().handed_over = progress.handed_over;
        Wish::GoOn
    });
    let world = bus.0.borrow();
    let took = (world.board.cycle() - begun) as f64 / CLOCK_HZ as f64;
    assert_eq!(ended, Ok(Ended::Done));
    eprintln!(
        "FIGURES SPI at 9.6 MHz: 6 x {per_second} segments/s, {} segments in {took:.3} s, at least {} waiting",
        commands.len() - 1,
        world.least_waiting,
    );
    assert_eq!(world.least_waiting, OVER_SPI, "segments in the emptiest queue");
}

#[test]
fn uart_at_3_megabaud_carries_1000_segments_per_second_for_six_axes() {
    carries::<ModelBoard>(3_000_000, 1000, 1500, 4);
}

/// The number of queued segments is not visible at the Verilog's pins, but an empty queue is a
/// fault. `CARRYSTEP_VERILOG_MS` sets the length of the test in ms.
#[test]
fn verilog_at_3_megabaud_carries_1000_segments_per_second_for_six_axes() {
    carries::<VerilatedBoard>(3_000_000, 1000, asked("CARRYSTEP_VERILOG_MS", 100) as u32, UNSEEN);
}

/// The slowest line with which a program of six axes is planned (`least_baud` in
/// `crates/job/src/rhythm.rs`), and segments of almost 16 ms.
#[test]
fn uart_at_210_000_baud_carries_63_segments_per_second_for_six_axes() {
    carries::<ModelBoard>(210_000, 63, 1500, 5);
}

#[test]
fn uart_at_921_600_baud_carries_200_segments_per_second_for_six_axes() {
    carries::<ModelBoard>(921_600, 200, 1500, 6);
}

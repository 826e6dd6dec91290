//! What the component sends reaches the exported Verilog byte by byte: a run on a board of models is
//! recorded, with motion, an e-stop and a servo thread that is too late, and replayed. All pins and
//! all answers are the same in every clock, over a UART and over an SPI.
#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "clippy.toml's allowance reaches unit tests only"
)]

#[path = "../../virtual-board/tests/support/recorder.rs"]
#[allow(dead_code, reason = "the tests of other crates use the rest")]
mod recorder;
mod support;

use carrystep_core::link::Uart;
use carrystep_virtual_board::{ModelBoard, SimulatedBoard as _, Switches, VerilatedBoard};
use recorder::{Recorder, Recording};
use support::world::{CLOCK_HZ, Line, SCK_HZ, World, build, fault, wave};

/// Rate of the UART, bit/s.
const BAUD: u32 = 921_600;

/// Bits of a byte on it.
const BITS: u64 = 10;

fn uart() -> Uart {
    Uart::new(CLOCK_HZ, BAUD).unwrap()
}

fn model(line: Line) -> ModelBoard {
    match line {
        Line::Uart => ModelBoard::new(&build(), uart()),
        Line::Spi => ModelBoard::on_spi(&build(), SCK_HZ),
    }
}

fn verilog(line: Line) -> VerilatedBoard {
    match line {
        Line::Uart => VerilatedBoard::new(&build(), uart()).unwrap(),
        Line::Spi => VerilatedBoard::on_spi(&build(), SCK_HZ).unwrap(),
    }
}

/// Moves, stops by the e-stop in motion, moves again, and stops by an empty queue.
fn recorded(line: Line) -> Recording {
    let board = Recorder::new(model(line));
    let mut world = World::of(board, line, 4, 0, "0 0 255 255").made_ready();
    let curve = |time: f64| {
        let way = wave(time / 2.0);
        [way, way / 3.0, -way]
    };
    world.follow(100, curve);
    world.rest();
    let from = world.command;
    let on = |time: f64| from.map(|from| from + 25.0 * time * time / 0.2);
    world.follow(80, on);
    world.board.press(Switches { estop: true, ..Switches::default() });
    world.fails(fault::ESTOP, 20);
    world.board.press(Switches::default());
    world.until(1500, |world| {
        world.command = world.says.feedback;
        !world.servo(false).disabled
    });
    let from = world.command;
    world.follow(80, |time| from.map(|from| from - 25.0 * time * time / 0.2));
    (0..80).for_each(|_| world.pass());
    world.fails(fault::UNDERRUN, 1);
    world.off(40);
    assert_eq!(world.board.stops().len(), 3, "{:?}", world.board.stops());
    let World { bench, board, .. } = world;
    bench.end();
    board.finish()
}

#[test]
fn run_of_the_component_replayed_on_the_verilog_is_the_same_in_every_clock() {
    for line in [Line::Uart, Line::Spi] {
        let recording = recorded(line);
        let pins = recording.pins(model(line));
        assert_eq!(recording.difference(verilog(line), &pins), None, "{line:?}");
        let (bytes, edges) = (recording.events.len(), recording.edges.len());
        eprintln!(
            "{line:?}: {} clocks, {bytes} bytes and switches to the board, {edges} edges, {} changes \
             of pins: no difference",
            recording.clocks,
            pins.len()
        );
        assert!(edges > 500, "{edges} edges");
        let wrong = recording.with_a_wrong_bit().difference(verilog(line), &pins);
        assert!(wrong.is_some(), "{line:?}: a wrong bit");
        if line == Line::Uart {
            let (late, clocks) = recording.with_a_late_byte(BITS * CLOCK_HZ / u64::from(BAUD));
            let found = late.difference(verilog(line), &pins);
            assert!(found.is_some(), "a byte that is {clocks} clocks late");
        }
    }
}

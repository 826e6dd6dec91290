//! The embedded-hal SPI driver, with a board of models and with the exported Verilog on the bus.

use crate::support::bus::Bus;
use crate::support::random::Random;
use crate::support::{Kind, waves};
use carrystep_core::AXES;
use carrystep_link::{Ended, Program, Wish};
use carrystep_model::fast::Edge;
use carrystep_virtual_board::{ModelBoard, VerilatedBoard};

/// Number of flipped bits per million bytes.
const BAD: u32 = 1500;

/// The edges of a short move from its load on, and how often the bus did damage.
fn moves<B: Kind>(sck_hz: u64, flip: u32) -> (Vec<Edge>, u64) {
    let bus = Bus::<B>::bad(sck_hz, flip, 4);
    let mut host = bus.connect();
    assert_eq!((host.facts().axes, host.facts().tick_ns), (6, 2000));
    host.enable().unwrap();
    let commands = waves(&mut Random::new(3), 9, 3000);
    let ended = host.stream(Program::new(&commands, AXES as u8).unwrap(), |_| Wish::GoOn);
    assert_eq!(ended, Ok(Ended::Done));
    let wired = bus.0.borrow();
    for axis in 0..AXES {
        assert_eq!(
            host.status().positions[axis],
            wired.board.position(axis),
            "the position of axis {axis}"
        );
    }
    (wired.edges_since(wired.board.loads()[0]), wired.harmed())
}

#[test]
fn pulses_on_a_bad_bus_equal_those_of_models_on_a_clean_bus() {
    let (clean, _) = moves::<ModelBoard>(9_600_000, 0);
    assert!(clean.len() > 500, "{} edges are no move", clean.len());
    for (name, (edges, harmed)) in [
        ("models at an odd rate", moves::<ModelBoard>(3_456_789, 0)),
        ("models on a bad bus", moves::<ModelBoard>(9_600_000, BAD)),
        ("the Verilog", moves::<VerilatedBoard>(9_600_000, 0)),
        ("the Verilog on a bad bus", moves::<VerilatedBoard>(6_500_000, BAD)),
    ] {
        assert_eq!(edges, clean, "{name}");
        assert_eq!(harmed > 0, name.ends_with("bad bus"), "{name}");
    }
}

//! An e-stop in the middle of a move, over a bad line. After the freeze there must be no new edge
//! (promise 5). Every carry must be a pulse or be counted as discarded (promise 6), and the host
//! must receive both numbers.

use crate::support::random::Random;
use crate::support::wire::Faults;
use crate::support::{CLOCK_HZ, End, Kind, MS, TICK, waves};
use carrystep_core::AXES;
use carrystep_core::engine::Cause;
use carrystep_core::link::Uart;
use carrystep_core::link::registers::{DISCARDED, POSITION, of_axis};
use carrystep_link::{Command, HostError, Program, Segment, Wish};
use carrystep_model::fast::{Change, Edge};
use carrystep_virtual_board::{ModelBoard, Switches, VerilatedBoard};
use std::ops::Range;

fn rises(edges: &[Edge], axis: u8, before: u64) -> u32 {
    let counts =
        |edge: &&Edge| edge.axis == axis && edge.change == Change::Rise && edge.clock < before;
    edges.iter().filter(counts).count() as u32
}

#[test]
fn freeze_counts_every_discarded_step() {
    let (_, discarded) = freezes::<ModelBoard>(0..12, 100, Faults::BAD);
    assert!(discarded > 0, "nothing was ever discarded");
}

#[test]
fn freeze_of_the_verilog_counts_every_discarded_step() {
    let (freezes, _) = freezes::<VerilatedBoard>(0..1, 20, Faults::default());
    assert_eq!(freezes, 1);
}

/// Presses the e-stop within `within` + 20 ms of the move of each seed. Returns how many e-stops
/// were the first stop cause of their move, and how many steps were discarded.
fn freezes<B: Kind>(seeds: Range<u64>, within: u64, faults: Faults) -> (u32, u32) {
    let uart = Uart::new(CLOCK_HZ, 3_000_000).unwrap();
    let mut random = Random::new(5);
    let (mut freezes, mut discarded) = (0, 0);
    for seed in seeds {
        // A carry about every fourth tick, so that one may be between the engine and the pin when
        // the freeze comes.
        let faster = |command| match command {
            Command::Segment { axis, segment: Segment { ticks, v, a, j, last } } => {
                Command::Segment { axis, segment: Segment { ticks, v: 16 * v, a: 16 * a, j, last } }
            }
            other => other,
        };
        let commands: Vec<_> = waves(&mut random, 10, 8000).into_iter().map(faster).collect();
        let program = || Program::new(&commands, AXES as u8).unwrap();
        let clean = End::<ModelBoard>::new(uart, Faults::default(), 0);
        let mut host = clean.connect(uart);
        host.enable().unwrap();
        host.stream(program(), |_| Wish::GoOn).unwrap();
        let load = clean.0.borrow().board.loads()[0];
        let clean = clean.0.borrow().edges_since(load);

        let end = End::<B>::new(uart, faults, seed);
        let mut host = end.connect(uart);
        host.enable().unwrap();
        let after = (20 + random.below(within)) * MS + random.below(MS);
        let ended = host.stream(program(), |_| {
            let mut world = end.0.borrow_mut();
            let due =
                world.board.loads().first().is_some_and(|load| world.board.cycle() > load + after);
            if due {
                world.board.press(Switches { estop: true, ..Switches::default() });
            }
            Wish::GoOn
        });
        let Err(HostError::Fault { cause, .. }) = ended else { panic!("{ended:?}") };
        end.wait(20);
        let (load, (stop, called)) =
            (end.0.borrow().board.loads()[0], end.0.borrow().board.stops()[0]);
        assert_eq!(cause, called as u8);
        if called != Cause::EStop {
            continue;
        }
        freezes += 1;
        let found = end.0.borrow().edges_since(load);
        let stop = stop - load;
        for axis in 0..AXES as u8 {
            let pulses = rises(&found, axis, u64::MAX);
            assert_eq!(pulses, rises(&found, axis, stop + TICK), "an edge behind the freeze");
            let lost = host.register(of_axis(DISCARDED, axis)).unwrap();
            // Three ticks are in progress at the freeze: the one at the pins, the one that waits
            // for the pins, and the one that is being computed. On a clean line their carries are
            // the pulses of the next three ticks.
            let carried = rises(&clean, axis, stop + 3 * TICK);
            assert_eq!(pulses + lost, carried, "axis {axis}: {lost} discarded, {pulses} pulses");
            discarded += lost;
            let position = host.register(of_axis(POSITION, axis)).unwrap().cast_signed();
            assert_eq!(position, end.0.borrow().travelled(axis), "the position of axis {axis}");
        }
        assert_eq!(end.0.borrow().board.step(), 0, "a pin is left high");
    }
    (freezes, discarded)
}

//! The driver and several latches at the pins of limits and of their own, with a board of models
//! and with the exported Verilog.

use crate::support::wire::Faults;
use crate::support::{BoardHost, CLOCK_HZ, End, Kind, SESSION, build};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{Latch, LatchSource};
use carrystep_core::link::Uart;
use carrystep_link::{HostError, Patience};
use carrystep_virtual_board::{ModelBoard, Switches, VerilatedBoard};

fn uart() -> Uart {
    Uart::new(CLOCK_HZ, 3_000_000).unwrap()
}

/// Two latches at the limits of axis 2, and one with a pin of its own, which nothing drives.
fn with_latches() -> EngineBuild {
    let at = |row| Latch { source: LatchSource::Switch { row, axis: 2 }, low: false, looks: 1 };
    let mut build = build();
    build.guard.latches = vec![at(0), at(1), Latch::of_pin(false, 4)];
    build.check().unwrap();
    build
}

fn ready<B: Kind>(board: B, build: &EngineBuild) -> (End<B>, BoardHost<B>) {
    let end = End::of(board, uart(), Faults::default(), 5);
    let mut host = end.connect_to(uart().build_id(build), Patience::default()).unwrap();
    host.open(SESSION).unwrap();
    (end, host)
}

/// Closes these limits of axis 2 for a millisecond.
fn edge<B: Kind>(end: &End<B>, min: bool, max: bool) {
    let limits = |closed| if closed { 1 << 2 } else { 0 };
    let closed = Switches { limit_min: limits(min), limit_max: limits(max), ..Switches::default() };
    for switches in [closed, Switches::default()] {
        end.0.borrow_mut().board.press(switches);
        end.wait(1);
    }
}

fn each_latch_is_read<B: Kind>(board: B) {
    let (end, mut host) = ready(board, &with_latches());
    assert_eq!(host.latches().unwrap().built, 0b111);
    assert!(matches!(host.arm_latches(0b1010), Err(HostError::NoLatch { latch: 3 })));
    host.arm_latches(0b011).unwrap();
    edge(&end, true, true);
    let latches = host.latches().unwrap();
    assert_eq!((latches.armed, latches.edges), (0, [0; 4]));
    let (first, second) = (host.latched(0).unwrap(), host.latched(1).unwrap());
    assert!(first == second && first.tick > 0, "{first:?}, {second:?}");
    host.arm_latches(0b010).unwrap();
    edge(&end, true, true);
    edge(&end, true, false);
    assert_eq!(host.latches().unwrap().edges, [2, 0, 0, 0]);
    let later = host.latched(1).unwrap();
    assert!(later.tick > first.tick, "{later:?} after {first:?}");
    assert_eq!(host.latched(0).unwrap(), first);
    assert!(matches!(host.latched(4), Err(HostError::NoLatch { latch: 4 })));
}

#[test]
fn each_latch_is_read_with_a_board_of_models() {
    each_latch_is_read(ModelBoard::new(&with_latches(), uart()));
}

#[test]
fn each_latch_is_read_with_the_verilog() {
    each_latch_is_read(VerilatedBoard::new(&with_latches(), uart()).unwrap());
}

#[test]
fn the_only_latch_is_read_without_being_armed_again() {
    let mut build = with_latches();
    build.guard.latches.truncate(1);
    let (end, mut host) = ready(ModelBoard::new(&build, uart()), &build);
    host.arm_latches(1).unwrap();
    assert_eq!(host.latches().unwrap().armed, 1);
    edge(&end, true, false);
    edge(&end, true, false);
    let found = host.latched(0).unwrap();
    let latches = host.latches().unwrap();
    assert_eq!((latches.armed, latches.edges), (0, [1, 0, 0, 0]));
    assert_eq!(host.latched(0).unwrap(), found);
    assert!(matches!(host.arm_latches(2), Err(HostError::NoLatch { latch: 1 })));
}

//! Sessions as docs/protocol.md specifies them: who may write, what restarts the watchdog, when a
//! session can be opened, and a stop of anyone. Model and Rust-HDL of the link are compared in every
//! clock.

use carrystep_core::engine::Cause;
use carrystep_core::link::Uart;
use carrystep_core::link::registers::{
    CLEAR, CONTROL, OPEN, POSITION, SEEK, SEGMENT, SEGMENTS, SNAPSHOT, START, STOP, of_axis,
};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_tests::link_bench::{Host, LinkBench, Said, owners_read, read, wide, write};

/// The reasons of a refusal, as the page numbers them.
const SEQUENCE: u8 = 1;
const BUSY: u8 = 2;
const SESSION: u8 = 3;

/// Clocks per tick.
const TICK: u64 = 96;
/// The time of the watchdog, ticks.
const WATCHDOG: u64 = 512;

fn build(watchdog: bool) -> EngineBuild {
    let timebase = Timebase::new(48_000_000, 2000, 16).expect("a timebase");
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, 1 << 54);
    build.guard.round = 32;
    build.guard.watchdog = if watchdog { (WATCHDOG / 32) as u32 } else { 0 };
    build
}

fn bench(watchdog: bool) -> LinkBench {
    LinkBench::uart(&build(watchdog), Uart::new(48_000_000, 3_000_000).expect("a UART"))
}

/// The words of a segment with constant V.
fn cruise(ticks: u32, v: i64) -> [u32; 8] {
    [ticks - 1, v as u32, (v >> 32) as u32, 0, 0, 0, 0, 1]
}

const QUARTER: i64 = 1 << 62;
/// Session numbers that no test opens: nobody's, one byte off, the two bytes of 0xc0db exchanged.
const OTHERS: [u16; 4] = [0, 0xc0da, 0xc1db, 0xdbc0];

#[test]
fn requests_of_other_sessions_change_nothing() {
    let mut bench = bench(false);
    let mut host = Host::powered(&mut bench);
    host.write(&mut bench, of_axis(SEGMENT, 0), &cruise(50, QUARTER));
    let before = bench.status();
    let wide = wide(0b11, 50, &[[QUARTER, 0, 0]; 2], true);
    for session in OTHERS {
        for (register, words) in [
            (CONTROL, &[0][..]),
            (START, &[1]),
            (CLEAR, &[0]),
            (SEEK, &[1]),
            (SNAPSHOT, &[0]),
            (of_axis(SEGMENT, 0), &cruise(50, QUARTER)),
            (SEGMENTS, &wide),
        ] {
            let said = bench.ask(&write(host.next, register, session, words));
            let Said { next, reason, written, free, .. } = said;
            assert_eq!((next, reason, written), (host.next, SESSION, true), "{said:?}");
            assert_eq!((free, said.fault, said.seeking), (6, None, 0), "{said:?}");
        }
        let said = bench.ask(&owners_read(9, POSITION, session));
        assert_eq!((said.reason, said.data, said.written), (SESSION, before.data, false));
        assert_eq!(bench.status(), before);
    }
    assert_eq!(bench.ask(&owners_read(9, POSITION, host.session)).reason, 0);
    host.run(&mut bench, 1);
    assert_eq!(bench.steps, 13, "a quarter of 50 ticks, from half a step");
}

/// Nobody owns the gateware at first, and session 0 never does.
#[test]
fn nothing_is_written_before_a_session_is_open() {
    let mut bench = bench(false);
    for session in [0, 1, 0xffff] {
        let said = bench.ask(&write(0, CONTROL, session, &[1]));
        assert_eq!((said.reason, said.next), (SESSION, 0));
        assert_eq!(bench.ask(&owners_read(0, 0, session)).reason, SESSION);
    }
    let said = bench.ask(&write(0, OPEN, 0, &[0]));
    assert_eq!((said.reason, said.next), (SESSION, 0));
    assert_eq!(bench.ask(&write(0, CONTROL, 0, &[1])).reason, SESSION);
    assert!(!bench.outputs.enabled);
}

/// Whether a request that the host repeats restarts the watchdog while a segment waits.
fn feeds(request: impl Fn(&Host) -> Vec<u8>) -> bool {
    let mut bench = bench(true);
    let mut host = Host::powered(&mut bench);
    host.write(&mut bench, SEGMENT, &cruise(50, QUARTER));
    let end = bench.clocks + 3 * WATCHDOG * TICK;
    while bench.clocks < end && bench.outputs.fault.is_none() {
        bench.ask(&request(&host));
        bench.rest(WATCHDOG / 4 * TICK);
    }
    match bench.outputs.fault {
        Some((cause, _)) => assert_eq!(cause, Cause::Watchdog),
        None => assert!(bench.clocks >= end),
    }
    bench.outputs.fault.is_none()
}

#[test]
fn requests_of_the_owner_feed_the_watchdog() {
    assert!(feeds(|host| owners_read(3, POSITION, host.session)), "a read");
    assert!(feeds(|host| host.frame(0, SNAPSHOT, &[0])), "a write");
    assert!(feeds(|host| host.frame(255, SEGMENT, &cruise(50, QUARTER))), "a repeated write");
    assert!(feeds(|host| host.frame(5, SNAPSHOT, &[0])), "a write behind a lost one");
}

#[test]
fn requests_of_others_do_not_feed_the_watchdog() {
    assert!(!feeds(|_| read(3, POSITION)), "a read of anyone");
    assert!(!feeds(|_| owners_read(3, POSITION, 7)), "a read of another session");
    assert!(!feeds(|host| write(host.next, START, 7, &[2])), "a write of another session");
    assert!(!feeds(|_| write(0, OPEN, 7, &[0])), "an OPEN that is refused");
    assert!(!feeds(|host| write(0, OPEN, host.session, &[0])), "the owner's own");
}

#[test]
fn a_stop_of_anyone_is_executed_within_the_owners_stream() {
    let mut bench = bench(false);
    let mut host = Host::powered(&mut bench);
    host.write(&mut bench, SEGMENT, &cruise(20_000, QUARTER));
    host.write(&mut bench, START, &[1]);
    host.write(&mut bench, SEGMENT, &cruise(50, QUARTER));
    let said = bench.ask(&write(host.next.wrapping_add(77), STOP, 0, &[0]));
    assert_eq!((said.fault, said.next, said.reason), (Some(Cause::Stop), host.next, 0));
    // The stop was no write of the owner: the owner's numbers go on.
    host.write(&mut bench, SEGMENT, &cruise(50, QUARTER));
    while !bench.status().halted {}
    // A stop is triggered once: after it the clear succeeds at once.
    assert_eq!(host.write(&mut bench, CLEAR, &[0]).fault, None);
    bench.rest(10 * TICK);
    assert_eq!(bench.status().fault, None);
    assert!(bench.outputs.enabled, "a stop leaves the power on");
    let steps = bench.steps;
    host.write(&mut bench, SEGMENT, &cruise(50, QUARTER));
    host.run(&mut bench, 1);
    assert_eq!(bench.steps, steps + 13);
}

/// Sends OPEN; returns its reason.
fn open(bench: &mut LinkBench, session: u16, force: bool) -> u8 {
    let said = bench.ask(&write(0x99, OPEN, session, &[force.into()]));
    assert!(said.written);
    if said.reason == 0 {
        assert_eq!((said.next, said.seeking), (0, 0), "{said:?}");
    }
    said.reason
}

#[test]
fn open_is_busy_while_anything_moves_or_waits() {
    let mut bench = bench(false);
    let mut host = Host::powered(&mut bench);
    // Idle: granted, and the power stays.
    host.write(&mut bench, SEEK, &[3]);
    assert_eq!(open(&mut bench, 5, false), 0);
    assert!(bench.outputs.enabled);
    assert_eq!(bench.ask(&host.frame(0, SNAPSHOT, &[0])).reason, SESSION, "the owner before");
    host = Host { session: 5, next: 0 };
    // A segment waits.
    host.write(&mut bench, SEGMENT, &cruise(3000, QUARTER));
    for session in [5, 6] {
        assert_eq!(open(&mut bench, session, false), BUSY);
    }
    // An axis moves, and a start is armed behind it.
    host.write(&mut bench, START, &[1]);
    assert_eq!(open(&mut bench, 6, false), BUSY);
    host.write(&mut bench, SEGMENT, &cruise(50, QUARTER));
    assert!(host.write(&mut bench, START, &[1]).armed);
    assert_eq!(open(&mut bench, 6, false), BUSY);
    while !bench.status().idle {}
    host.write(&mut bench, SNAPSHOT, &[0]);
    assert_eq!((open(&mut bench, 6, false), bench.status().fault), (0, None));
}

#[test]
fn open_with_force_stops_and_is_granted_when_halted() {
    let mut bench = bench(false);
    let mut host = Host::powered(&mut bench);
    host.write(&mut bench, SEGMENT, &cruise(20_000, QUARTER));
    host.write(&mut bench, START, &[1]);
    // While the axis ramps down, the owner is the one before.
    assert_eq!(open(&mut bench, 6, true), BUSY);
    assert_eq!(bench.status().fault, Some(Cause::Stop));
    assert_eq!(bench.ask(&host.frame(9, SNAPSHOT, &[0])).reason, SEQUENCE);
    while open(&mut bench, 6, true) == BUSY {}
    let said = bench.status();
    assert!(said.halted && said.fault == Some(Cause::Stop), "{said:?}");
    // A repeated OPEN, whose answer was lost, is granted again.
    assert_eq!(open(&mut bench, 6, true), 0);
    host = Host { session: 6, next: 0 };
    assert_eq!(host.write(&mut bench, CLEAR, &[0]).fault, None);
    host.write(&mut bench, SEGMENT, &cruise(50, QUARTER));
    // The owner itself opens anew only when nothing waits.
    assert_eq!(open(&mut bench, 6, false), BUSY);
    host.run(&mut bench, 1);
    assert_eq!(open(&mut bench, 6, false), 0);
}

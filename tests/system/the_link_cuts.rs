//! A CUT as docs/protocol.md specifies it: which segments are dropped, when it is refused, and what
//! becomes of the writes behind it. Model and Rust-HDL of the link are compared in every clock.

use carrystep_core::engine::{Cause, QUEUE_DEPTHS};
use carrystep_core::link::Uart;
use carrystep_core::link::registers::{
    CLEAR, CUT, POSITION, QUEUE_DEPTH, SEGMENT, SEGMENTS, START, STATUS, STOP, of_axis,
};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_tests::link_bench::{Host, LinkBench, wide};

/// The reasons of a refusal, as the page numbers them.
const SEQUENCE: u8 = 1;
const REFUSED: u8 = 5;

/// V of a step in four ticks.
const QUARTER: i64 = 1 << 62;
/// Ticks and steps of a segment at this speed.
const TICKS: u32 = 600;
const STEPS: i32 = 150;
/// The bit of an axis' word that says that it takes part.
const NAMED: u32 = 1 << 24;

fn bench(queue: usize) -> LinkBench {
    of_build(|build| EngineBuild { queue, cuts: true, ..build })
}

fn of_build(change: impl Fn(EngineBuild) -> EngineBuild) -> LinkBench {
    let timebase = Timebase::new(48_000_000, 2000, 16).expect("a timebase");
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let build = change(EngineBuild::minimal(&build, 1 << 54));
    LinkBench::uart(&build, Uart::new(48_000_000, 3_000_000).expect("a UART"))
}

/// The same segment for each axis of a mask.
fn segments(mask: u8, ticks: u32, v: i64, last: bool) -> Vec<u32> {
    wide(mask, ticks, &vec![[v, 0, 0]; mask.count_ones() as usize], last)
}

/// The words of a CUT that keeps these slots.
fn slots(named: &[(usize, u8)]) -> [u32; 8] {
    let mut words = [0; 8];
    for &(axis, slot) in named {
        words[axis] = NAMED | u32::from(slot);
    }
    words
}

fn positions(bench: &mut LinkBench) -> [i32; 3] {
    [0, 1, 2].map(|axis| bench.read(of_axis(POSITION, axis)).data.cast_signed())
}

/// Waits until axis 0 runs the segment in this slot.
fn wait_for(bench: &mut LinkBench, slot: u8) {
    while bench.read(STATUS).data & 0x3f != u32::from(slot) | 1 << 5 {}
}

/// A host whose axes 0 to 2 run the first of five segments, which are not the last of their move.
/// Returns the slot of that one; it is so near the greatest slot that the others begin again at 0.
fn running(bench: &mut LinkBench, queue: usize) -> (Host, u8) {
    let mut host = Host::powered(bench);
    assert_eq!(bench.read(QUEUE_DEPTH).data as usize, queue);
    let before = queue - 2;
    for k in 1..=before {
        let said = host.write(bench, SEGMENTS, &segments(0b111, 1, 0, k == before));
        assert_eq!(usize::from(said.free), queue - k);
    }
    host.run(bench, 0b111);
    for _ in 0..5 {
        host.write(bench, SEGMENTS, &segments(0b111, TICKS, QUARTER, false));
    }
    host.write(bench, START, &[0b111]);
    let first = before as u8 + 1;
    wait_for(bench, first);
    (host, first)
}

fn modulo(slot: u8, queue: usize) -> u8 {
    slot & queue as u8
}

#[test]
fn axes_drop_what_is_behind_their_named_segments() {
    for queue in QUEUE_DEPTHS {
        let mut bench = bench(queue);
        let (mut host, first) = running(&mut bench, queue);
        let second = modulo(first + 1, queue);
        let third = modulo(first + 2, queue);
        // Axis 1 takes no part.
        let said = host.write(&mut bench, CUT, &slots(&[(0, second), (2, third)]));
        assert!(!said.cut_refused && said.fault.is_none(), "{said:?}");
        let free = [0, 1, 2].map(|axis| usize::from(bench.read(of_axis(POSITION, axis)).free));
        assert_eq!(free, [queue - 1, queue - 4, queue - 2]);
        // What follows has the slot behind the one that was kept.
        host.write(&mut bench, SEGMENTS, &segments(0b101, TICKS, -QUARTER, true));
        host.write(&mut bench, of_axis(SEGMENT, 1), &segments(1, TICKS, 0, true)[1..]);
        while !bench.status().idle {}
        assert_eq!(positions(&mut bench), [STEPS, 5 * STEPS, 2 * STEPS]);
        let stands = [0, 1, 2].map(|axis| (bench.read(of_axis(STATUS, axis)).data & 0x1f) as u8);
        let last = [3, 6, 4].map(|behind| modulo(first + behind - 1, queue));
        assert_eq!(stands, last, "of {queue}");
    }
}

#[test]
fn a_cut_behind_the_running_segment_keeps_it_whole() {
    let mut bench = bench(7);
    let (mut host, first) = running(&mut bench, 7);
    host.write(&mut bench, CUT, &slots(&[(0, first), (1, first), (2, first)]));
    host.write(&mut bench, SEGMENTS, &segments(0b111, 1, 0, true));
    while !bench.status().idle {}
    assert_eq!(positions(&mut bench), [STEPS; 3]);
}

/// One axis has ended its named segment, so the others drop nothing; and what the host has sent
/// behind the cut is not executed.
#[test]
fn a_cut_that_is_late_in_one_axis_is_refused_in_all() {
    let mut bench = bench(7);
    let (mut host, first) = running(&mut bench, 7);
    let second = modulo(first + 1, 7);
    wait_for(&mut bench, second);
    let late = slots(&[(0, modulo(first + 2, 7)), (1, first), (2, modulo(first + 3, 7))]);
    for _ in 0..2 {
        let said = bench.ask(&host.frame(0, CUT, &late));
        assert_eq!((said.reason, said.next, said.cut_refused), (REFUSED, host.next, true));
        let said = bench.ask(&host.frame(1, SEGMENTS, &segments(0b111, TICKS, QUARTER, true)));
        assert_eq!((said.reason, said.next), (SEQUENCE, host.next));
    }
    // The number of the refused cut is still free.
    host.write(&mut bench, SEGMENTS, &segments(0b111, TICKS, 0, true));
    while !bench.status().idle {}
    assert_eq!(positions(&mut bench), [5 * STEPS; 3]);
    assert!(bench.status().cut_refused, "until another cut");
}

/// A cut without a name in any axis drops nothing and is granted. At rest, the segment that ran
/// last is not there any more.
#[test]
fn cuts_at_rest_and_cuts_of_nothing() {
    let mut bench = bench(15);
    let mut host = Host::powered(&mut bench);
    assert!(!host.write(&mut bench, CUT, &[0; 8]).cut_refused);
    host.write(&mut bench, SEGMENTS, &segments(0b11, TICKS, QUARTER, true));
    host.write(&mut bench, SEGMENTS, &segments(0b11, TICKS, QUARTER, true));
    assert_eq!(bench.ask(&host.frame(0, CUT, &slots(&[(0, 0)]))).reason, REFUSED);
    assert_eq!(bench.ask(&host.frame(0, CUT, &slots(&[(0, 1), (1, 3)]))).reason, REFUSED);
    assert_eq!(host.write(&mut bench, CUT, &slots(&[(0, 1), (1, 2)])).free, 14);
    host.write(&mut bench, START, &[0b11]);
    while bench.status().armed {}
    host.run(&mut bench, 0b10);
    assert_eq!(positions(&mut bench), [STEPS, 2 * STEPS, 0]);
}

#[test]
fn a_cut_in_a_stop_is_acknowledged_and_a_repeated_one_is_executed_once() {
    let mut bench = bench(7);
    let (mut host, first) = running(&mut bench, 7);
    let third = slots(&[(0, modulo(first + 2, 7))]);
    let said = host.write(&mut bench, CUT, &third);
    host.write(&mut bench, of_axis(SEGMENT, 0), &segments(1, TICKS, 0, false)[1..]);
    // The answer to the cut was lost: executed again, it would drop the segment that has followed.
    host.next -= 2;
    let again = bench.ask(&host.frame(0, CUT, &third));
    assert_eq!((again.reason, again.next, again.free), (0, host.next + 2, said.free - 1));
    host.next += 2;
    // A STOP has no number.
    bench.ask(&host.frame(0, STOP, &[0]));
    let said = host.write(&mut bench, CUT, &slots(&[(0, 6)]));
    assert_eq!((said.fault, said.reason), (Some(Cause::Stop), 0));
    while !bench.status().halted {}
    assert_eq!(host.write(&mut bench, CLEAR, &[0]).fault, None);
}

#[test]
fn a_cut_of_an_axis_that_does_not_exist_is_a_fault() {
    let mut bench = bench(7);
    let (mut host, first) = running(&mut bench, 7);
    host.write(&mut bench, CUT, &slots(&[(0, first), (7, first)]));
    assert_eq!(bench.status().fault, Some(Cause::Protocol));
    while !bench.status().halted {}
    assert_eq!(host.write(&mut bench, CLEAR, &[0]).fault, None);
    // The names of the cut are forgotten.
    host.write(&mut bench, SEGMENTS, &segments(0b111, TICKS, QUARTER, true));
    assert!(!host.write(&mut bench, CUT, &[0; 8]).cut_refused);
    let before = positions(&mut bench);
    host.run(&mut bench, 0b111);
    assert_eq!(positions(&mut bench), before.map(|position| position + STEPS));
}

#[test]
fn a_build_without_cuts_refuses_each() {
    let mut bench = of_build(|build| build);
    let (mut host, first) = running(&mut bench, 7);
    for words in [slots(&[(0, first)]), [0; 8]] {
        let said = bench.ask(&host.frame(0, CUT, &words));
        assert_eq!((said.reason, said.next, said.cut_refused), (REFUSED, host.next, true));
    }
    host.write(&mut bench, SEGMENTS, &segments(0b111, TICKS, 0, true));
    while !bench.status().idle {}
    assert_eq!(positions(&mut bench), [5 * STEPS; 3]);
}

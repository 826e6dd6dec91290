//! Several latches, over the link as docs/protocol.md says: they are armed together or one by one,
//! each keeps the state of its own edge, and the registers show the one that was chosen. Model,
//! Rust-HDL and exported Verilog of the link are compared in every clock.

use carrystep_core::engine::{Cause, Latch};
use carrystep_core::link::Uart;
use carrystep_core::link::registers::{
    CAPTURES, CLEAR, LATCH, LATCH_POSITION, LATCH_TICKS, LATCHES, SEGMENT, START, TICKS, of_axis,
};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_tests::link_bench::{Both, Host, LinkBench};
use carrystep_tools::kept;
use carrystep_verilog::{LINK_NAME, link_verilog};

fn build(latches: usize) -> EngineBuild {
    let timebase = Timebase::new(48_000_000, 2000, 16).expect("a timebase");
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, 1 << 54);
    build.guard.latches = vec![Latch::of_pin(false, 1); latches];
    build
}

fn uart() -> Uart {
    Uart::new(48_000_000, 3_000_000).expect("a UART")
}

/// Gives an edge to the pins of these latches.
fn edge(bench: &mut LinkBench, latches: u8) {
    bench.pins.latch = latches;
    bench.rest(96 * 4);
    bench.pins.latch = 0;
    bench.rest(96 * 4);
}

/// The number of the tick, and the position of axis 1, of this latch.
fn latched(bench: &mut LinkBench, host: &mut Host, latch: u32) -> (u32, u32) {
    host.write(bench, LATCH, &[latch << 4]);
    (bench.read(LATCH_TICKS).data, bench.read(of_axis(LATCH_POSITION, 1)).data)
}

/// A session with four latches while axis 1 moves.
fn session(bench: &mut LinkBench) {
    let mut host = Host::powered(bench);
    host.write(bench, of_axis(SEGMENT, 1), &[100_000, 0, 1 << 29, 0, 0, 0, 0, 1]);
    host.write(bench, START, &[0b10]);
    assert_eq!(bench.read(LATCHES).data, 0xf0);
    host.write(bench, LATCH, &[0b0111]);
    assert_eq!(bench.read(LATCHES).data, 0xf7);
    let before = bench.read(of_axis(TICKS, 1)).data;
    edge(bench, 0b0011);
    // Latch 3 is not armed, and holds record 0.
    assert_eq!(bench.read(LATCHES).data, 0x05f4);
    let (first, second) = (latched(bench, &mut host, 0), latched(bench, &mut host, 1));
    assert_eq!(first, second);
    assert!(first.0 > before && first.1 > 0, "{first:?}");
    edge(bench, 0b0110);
    let third = latched(bench, &mut host, 2);
    assert!(third.0 > first.0 && third.1 > first.1, "{third:?} after {first:?}");
    // Latch 1 has counted a further edge. It is armed again and latches another one, while latch 0
    // keeps what it has.
    assert_eq!(bench.read(LATCHES).data, 0x0010_25f0);
    host.write(bench, LATCH, &[0b0010 | 3 << 4]);
    edge(bench, 0b0010);
    let again = latched(bench, &mut host, 1);
    assert!(again.0 > third.0, "{again:?} after {third:?}");
    assert_eq!((latched(bench, &mut host, 0), latched(bench, &mut host, 2)), (first, third));
    assert_eq!(bench.read(CAPTURES).data, 0);
}

#[test]
fn each_latch_keeps_its_state_until_it_is_armed_again() {
    session(&mut LinkBench::models(&build(4), uart()));
}

#[test]
fn model_rust_hdl_and_exported_verilog_of_the_link_are_equal() {
    let build = build(4);
    let mut bench = LinkBench::uart(&build, uart());
    bench.vectors = Some(Both::new(&build, uart().into()));
    session(&mut bench);
    let link = link_verilog(&build, uart().into(), "the test").expect("a link");
    let vectors = bench.vectors.expect("what was kept").link;
    assert_eq!(vectors.difference(LINK_NAME, &link).expect("Icarus"), None);
    // A choice that is not kept must be detected.
    let planted = link.replacen("chosen <= byte[5:4];", "chosen <= byte[4:3];", 1);
    assert_ne!(planted, link, "the choice is not in the link");
    assert!(vectors.difference(LINK_NAME, &planted).expect("Icarus").is_some());
    kept::say();
}

#[test]
fn arming_a_latch_that_is_not_there_is_a_fault_and_choosing_it_is_not() {
    let mut bench = LinkBench::models(&build(2), uart());
    let mut host = Host::powered(&mut bench);
    assert_eq!(bench.read(LATCHES).data, 0x30);
    host.write(&mut bench, LATCH, &[3 << 4]);
    assert_eq!(bench.status().fault, None);
    host.write(&mut bench, LATCH, &[0b0100]);
    bench.rest(1000);
    assert_eq!(bench.status().fault, Some(Cause::Protocol));
    host.write(&mut bench, CLEAR, &[1]);
    assert_eq!(bench.status().fault, None);
}

#[test]
fn any_word_arms_the_only_latch() {
    for word in [0, 1, 0xff] {
        let mut bench = LinkBench::models(&build(1), uart());
        let mut host = Host::powered(&mut bench);
        host.write(&mut bench, LATCH, &[word]);
        assert_eq!(bench.read(CAPTURES).data, 0x1000);
        assert_eq!(bench.read(LATCHES).data, 0);
        edge(&mut bench, 1);
        assert_eq!(bench.read(CAPTURES).data, 0);
        assert!(bench.read(LATCH_TICKS).data > 0);
    }
}

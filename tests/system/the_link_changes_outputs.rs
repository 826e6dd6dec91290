//! Outputs that change with segments, over the link as docs/protocol.md says: by the frame of an
//! axis and by the frame of several, and the faults. Model and Rust-HDL of the link are compared in
//! every clock; `rung_4_model_equals_rust_hdl` compares the clock in which outputs change.

use carrystep_core::engine::{Cause, Outputs};
use carrystep_core::link::Uart;
use carrystep_core::link::registers::{CLEAR, SEGMENT, SEGMENTS, START, of_axis};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_tests::link_bench::{Host, LinkBench, wide};

const TICKS: u32 = 100;
/// Clocks of a period of the PWM.
const PERIOD: u64 = 4096;

fn build(outputs: Outputs) -> EngineBuild {
    let timebase = Timebase::new(48_000_000, 2000, 16).expect("a timebase");
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    EngineBuild { outputs, ..EngineBuild::minimal(&build, 1 << 54) }
}

/// Four outputs and a PWM.
fn bench() -> LinkBench {
    let outputs = Outputs { exist: 0x0f, pwm_divider: 1, off_at_ramps: true };
    LinkBench::uart(&build(outputs), Uart::new(48_000_000, 3_000_000).expect("a UART"))
}

/// The last word of a segment that changes the outputs of `mask` to these levels.
fn switched(mask: u32, levels: u32, last: bool) -> u32 {
    levels << 12 | mask << 4 | u32::from(last)
}

/// The last word of a segment that changes the duty of the PWM.
fn dimmed(duty: u32, last: bool) -> u32 {
    duty << 20 | 1 << 1 | u32::from(last)
}

/// A segment at rest for each axis of a mask; the last word is given.
fn rest(mask: u8, last_word: u32) -> Vec<u32> {
    let mut words = wide(mask, TICKS, &vec![[0; 3]; mask.count_ones() as usize], false);
    *words.last_mut().expect("words") = last_word;
    words
}

/// The different levels of the outputs from now on, in order, until nothing moves.
fn levels(bench: &mut LinkBench) -> Vec<u8> {
    let mut seen = vec![bench.outputs.outputs];
    for _ in 0..96 * 12 * u64::from(TICKS) {
        bench.clock();
        if seen.last() != Some(&bench.outputs.outputs) {
            seen.push(bench.outputs.outputs);
        }
    }
    assert!(bench.outputs.idle && bench.outputs.fault.is_none());
    seen
}

#[test]
fn outputs_change_by_frames_of_one_axis_and_of_several() {
    let mut bench = bench();
    let mut host = Host::powered(&mut bench);
    host.write(&mut bench, SEGMENT, &rest(1, switched(0x3, 0x1, false))[1..]);
    host.write(&mut bench, of_axis(SEGMENT, 1), &rest(1, 0)[1..]);
    host.write(&mut bench, of_axis(SEGMENT, 2), &rest(1, 0)[1..]);
    // Levels of outputs that are not in the mask have no effect.
    host.write(&mut bench, SEGMENTS, &rest(0b111, switched(0x6, 0xd, false)));
    host.write(&mut bench, SEGMENTS, &rest(0b111, 0));
    host.write(&mut bench, SEGMENTS, &rest(0b111, switched(0xf, 0x8, true)));
    assert_eq!(bench.outputs.outputs, 0);
    host.write(&mut bench, START, &[0b111]);
    assert_eq!(levels(&mut bench), [1, 0x5, 0x8]);
}

#[test]
fn the_duty_of_the_pwm_is_that_of_the_segment() {
    let mut bench = bench();
    let mut host = Host::powered(&mut bench);
    for duty in [1, 1234, 4095, 0] {
        host.write(&mut bench, SEGMENTS, &rest(0b11, dimmed(duty, true)));
        host.run(&mut bench, 0b11);
        let high = (0..PERIOD).filter(|_| {
            bench.clock();
            bench.outputs.pwm
        });
        assert_eq!(high.count() as u32, duty);
    }
}

#[test]
fn bits_that_a_commit_must_not_have_are_a_fault() {
    for (name, register, words) in [
        ("an output of axis 1", of_axis(SEGMENT, 1), rest(1, switched(1, 1, true))[1..].to_vec()),
        ("the PWM of axis 1", of_axis(SEGMENT, 1), rest(1, dimmed(5, true))[1..].to_vec()),
        ("an output of axes 1 and 2", SEGMENTS, rest(0b110, switched(1, 0, true))),
        ("an output that is not built", SEGMENT, rest(1, switched(0x10, 0, true))[1..].to_vec()),
        ("a bit without a meaning", SEGMENTS, rest(0b11, 0x5)),
    ] {
        let mut bench = bench();
        let mut host = Host::powered(&mut bench);
        host.write(&mut bench, SEGMENTS, &rest(0b111, switched(0xf, 0xf, true)));
        host.run(&mut bench, 0b111);
        assert_eq!(bench.outputs.outputs, 0xf);
        bench.ask(&host.frame(0, register, &words));
        host.next += 1;
        let said = bench.status();
        assert_eq!((said.fault, said.next), (Some(Cause::Protocol), host.next), "{name}");
        assert_eq!(bench.outputs.outputs, 0, "a freeze switches all outputs off: {name}");
        while !bench.status().halted {}
        assert_eq!(host.write(&mut bench, CLEAR, &[0]).fault, None, "{name}");
    }
}

/// A build without outputs ignores the bits.
#[test]
fn a_build_without_outputs_has_no_such_fault() {
    let uart = Uart::new(48_000_000, 3_000_000).expect("a UART");
    let mut bench = LinkBench::uart(&build(Outputs::default()), uart);
    let mut host = Host::powered(&mut bench);
    host.write(&mut bench, SEGMENTS, &rest(0b11, switched(0xff, 0xff, true)));
    host.run(&mut bench, 0b11);
    assert_eq!((bench.outputs.outputs, bench.status().fault), (0, None));
}

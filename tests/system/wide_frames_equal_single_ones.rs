//! A frame with segments of several axes has the effect of one frame for each axis, in every clock
//! of the pins, or none at all.

use carrystep_core::engine::Cause;
use carrystep_core::link::Uart;
use carrystep_core::link::registers::{
    CLEAR, P_HIGH, P_LOW, POSITION, SEGMENT, SEGMENTS, START, STATUS, of_axis,
};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_tests::link_bench::{Host, LinkBench, on_the_line, summed, wide};

const QUARTER: i64 = 1 << 62;

fn build() -> EngineBuild {
    let timebase = Timebase::new(48_000_000, 2000, 16).expect("a timebase");
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    EngineBuild::minimal(&build, 1 << 54)
}

fn uart() -> Uart {
    Uart::new(48_000_000, 3_000_000).expect("a UART")
}

fn bench() -> LinkBench {
    LinkBench::uart(&build(), uart())
}

/// V, A, J of an axis in a segment. END and ESC occur in them.
fn numbers(axis: usize, part: usize) -> [i64; 3] {
    let axis = axis as i64;
    let part = part as i64;
    [
        (part * 2 - 1) * (QUARTER / (axis + 1)) + 0xc0db_dbc0,
        (axis - 3) * (1 << 54) + (part << 53) + 0xdb,
        -(1 << 47) + (axis << 44) + 0xc0 * part,
    ]
}

/// Levels of STEP and DIR in every clock from the beginning of the motion until nothing moves, and
/// the registers that follow from all bits of V, A and J.
fn motion(mut bench: LinkBench, mask: u8, in_one: bool) -> (Vec<(u32, u32)>, Vec<u32>) {
    const TICKS: [u32; 2] = [60, 45];
    let mut host = Host::powered(&mut bench);
    let of_mask = || (0..AXES).filter(|axis| mask >> axis & 1 == 1);
    for (part, ticks) in TICKS.into_iter().enumerate() {
        let last = part == 1;
        if in_one {
            let axes: Vec<_> = of_mask().map(|axis| numbers(axis, part)).collect();
            let said = host.write(&mut bench, SEGMENTS, &wide(mask, ticks, &axes, last));
            assert_eq!((said.free, said.fault, said.data), (6 - part as u8, None, 0));
        } else {
            for axis in of_mask() {
                let words = wide(0, ticks, &[numbers(axis, part)], last);
                let said = host.write(&mut bench, of_axis(SEGMENT, axis as u8), &words[1..]);
                assert_eq!((said.free, said.fault), (6 - part as u8, None));
            }
        }
    }
    bench.send(&on_the_line(&host.frame(0, START, &[mask.into()])));
    host.next += 1;
    while !bench.outputs.started {
        bench.clock();
    }
    // The answer to the START comes meanwhile.
    let mut pins = Vec::new();
    for _ in 0..96 * (TICKS[0] + TICKS[1] + 6) {
        bench.clock();
        pins.push((u32::from(bench.outputs.step), u32::from(bench.outputs.dir)));
    }
    assert!(bench.outputs.idle && bench.outputs.fault.is_none());
    let registers = [P_LOW, P_HIGH, POSITION, STATUS];
    (pins, host.snapshot(&mut bench, &registers, AXES as u8))
}

#[test]
fn wide_frames_for_every_mask_equal_single_ones_in_every_clock() {
    for mask in 1..1 << AXES {
        let models = || LinkBench::models(&build(), uart());
        let in_one = motion(models(), mask, true);
        assert!(in_one.0.iter().any(|(step, _)| *step == u32::from(mask)) || mask.count_ones() > 1);
        assert_eq!(in_one, motion(models(), mask, false), "{mask:06b}");
    }
}

/// The same in Rust-HDL, in lock-step with the model, for a mask with a gap and for all axes.
#[test]
fn rust_hdl_takes_wide_frames_as_the_model_does() {
    let all = (1 << AXES) - 1;
    for mask in [0b10_1101, all] {
        assert!(
            motion(bench(), mask, true) == motion(LinkBench::models(&build(), uart()), mask, true)
        );
    }
    let slow = LinkBench::spi(&build(), 25);
    assert!(motion(slow, all, true) == motion(bench(), all, false));
}

#[test]
fn a_wide_frame_that_cannot_be_taken_is_a_fault_and_commits_nothing() {
    let axes = |count| vec![[QUARTER, 0, 0]; count];
    for (name, filled, mask, ticks) in [
        ("a full axis, the first", 0, 0b00_0101, 100),
        ("a full axis, the last", 4, 0b01_0011, 100),
        ("an axis that does not exist", 9, 0b0100_0001, 100),
        ("no axis that exists", 9, 0b1100_0000, 100),
        ("no axis", 9, 0, 100),
        ("no ticks", 9, 0b11, 0),
    ] {
        let mut bench = bench();
        let mut host = Host::powered(&mut bench);
        if filled < AXES as u8 {
            for _ in 0..7 {
                host.write(&mut bench, of_axis(SEGMENT, filled), &[99, 0, 0, 0, 0, 0, 0, 1]);
            }
        }
        let free = |bench: &mut LinkBench| {
            (0..AXES as u8).map(|axis| bench.read(of_axis(POSITION, axis)).free).collect::<Vec<_>>()
        };
        let before = free(&mut bench);
        let words = wide(mask, ticks, &axes(mask.count_ones() as usize), true);
        let said = host.write(&mut bench, SEGMENTS, &words);
        assert_eq!(said.fault, Some(Cause::Protocol), "{name}: {said:?}");
        assert_eq!(free(&mut bench), before, "{name}");
        while !bench.status().halted {}
        assert_eq!(host.write(&mut bench, CLEAR, &[0]).fault, None, "{name}");
        host.write(&mut bench, SEGMENTS, &wide(0b11_1111, 50, &axes(AXES), true));
        host.run(&mut bench, 0b11_1111);
        assert_eq!(bench.steps, 13 * AXES as u64, "{name}");
    }
}

/// `free` of the answer is the least of the mask, also of a repeated frame.
#[test]
fn free_of_a_wide_frame_is_the_least_of_its_axes() {
    let mut bench = bench();
    let mut host = Host::powered(&mut bench);
    for axis in 0..AXES as u8 {
        for _ in 0..axis {
            host.write(&mut bench, of_axis(SEGMENT, axis), &[99, 0, 0, 0, 0, 0, 0, 1]);
        }
    }
    for (mask, least) in [(0b00_0001, 6), (0b00_1110, 3), (0b10_0001, 1), (0b11_0000, 0)] {
        let axes = vec![[0; 3]; u8::count_ones(mask) as usize];
        let said = host.write(&mut bench, SEGMENTS, &wide(mask, 9, &axes, true));
        assert_eq!((said.free, said.fault), (least, None), "{mask:06b}");
        host.next -= 1;
        assert_eq!(bench.ask(&host.frame(0, SEGMENTS, &wide(mask, 9, &axes, true))).free, least);
        host.next += 1;
    }
}

#[test]
fn a_wide_frame_of_another_length_is_not_answered() {
    let mut bench = bench();
    let mut host = Host::powered(&mut bench);
    let before = bench.status();
    for mask in [0_u8, 1, 0b10_1101, 0b11_1111, 0xff] {
        let count = mask.count_ones() as usize;
        let words = |axes: usize| wide(mask, 9, &vec![[QUARTER, 0, 0]; axes], true);
        let mut wrong: Vec<Vec<u32>> = [count + 1, count.wrapping_sub(1)]
            .into_iter()
            .filter(|axes| *axes <= 8)
            .map(words)
            .collect();
        wrong.push(words(count)[1..].to_vec());
        wrong.push([words(count), vec![0]].concat());
        for words in wrong.iter().filter(|words| words[0] == u32::from(mask)) {
            bench.send(&on_the_line(&host.frame(0, SEGMENTS, words)));
        }
        // An over-long frame whose beginning is a whole frame.
        let whole = host.frame(0, SEGMENTS, &words(count));
        bench.send(&on_the_line(&[&whole[..], &[0]].concat()));
        bench.send(&on_the_line(&summed(whole)));
    }
    while !bench.has_sent() {
        assert_eq!(bench.clock(), None);
    }
    bench.rest(20_000);
    assert_eq!(bench.status(), before);
    host.write(&mut bench, SEGMENTS, &wide(1, 50, &[[QUARTER, 0, 0]], true));
    host.run(&mut bench, 1);
    assert_eq!(bench.steps, 13);
}

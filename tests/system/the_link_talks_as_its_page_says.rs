//! The gateware's end of the link does what docs/protocol.md specifies: the page's example frames
//! byte by byte, and its other promises.

use carrystep_core::engine::{Cause, LimitWiring};
use carrystep_core::link::registers::{
    CLEAR, CONTROL, HOME, LIMIT_POSITION, POSITION, SEGMENT, START, of_axis,
};
use carrystep_core::link::{LineKind, Uart};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_tests::link_bench::{Both, LinkBench, Said, frame, on_the_line, unframe};
use carrystep_verilog::{LINK_NAME, line_name, line_verilog, link_verilog};

/// Number of cycles within which an answer must come.
const PATIENCE: u64 = 30_000;

fn build() -> EngineBuild {
    let timebase = Timebase::new(48_000_000, 2000, 16).expect("a timebase");
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, 1 << 54);
    build.guard.limits = LimitWiring::Pair;
    build
}

fn bench() -> LinkBench {
    LinkBench::uart(&build(), Uart::new(48_000_000, 3_000_000).expect("a UART"))
}

/// Sends a request and receives its answer.
fn ask(bench: &mut LinkBench, sequence: u8, address: u8, words: &[u32]) -> Said {
    bench.send(&on_the_line(&frame(sequence, address, words)));
    let answer = bench
        .answer(PATIENCE)
        .unwrap_or_else(|| panic!("no answer to {sequence:02x} {address:02x}"));
    let said = Said::of(&unframe(&answer).unwrap_or_else(|| panic!("{answer:02x?} is no frame")));
    assert_eq!((said.sequence, said.address), (sequence, address));
    said
}

/// Sends the next write; returns its answer.
fn write(bench: &mut LinkBench, next: &mut u8, address: u8, words: &[u32]) -> Said {
    let said = ask(bench, *next, 0x80 | address, words);
    *next = next.wrapping_add(1);
    assert_eq!(said.next, *next, "{said:?}");
    assert!(!said.refused, "{said:?}");
    said
}

fn status(bench: &mut LinkBench) -> Said {
    ask(bench, 0, POSITION, &[])
}

/// Switches the drivers on and waits until starts are accepted.
fn powered(bench: &mut LinkBench, next: &mut u8) {
    write(bench, next, CONTROL, &[1]);
    while !status(bench).ready {}
}

/// The words of a segment with constant V.
fn cruise(ticks: u32, v: i64) -> [u32; 8] {
    [ticks - 1, v as u32, (v >> 32) as u32, 0, 0, 0, 0, 1]
}

const QUARTER: i64 = 1 << 62;

#[test]
fn link_answers_the_example_frames_of_the_page() {
    let page = include_str!("../../docs/protocol.md");
    let (_, rest) = page.split_once("```frames\n").expect("a block of frames");
    let (block, _) = rest.split_once("```").expect("its end");
    let mut bench = bench();
    let mut next = 0;
    // The state that the page's host finds: axis 1 is at -250, the drivers have no power, and 42
    // writes were made.
    powered(&mut bench, &mut next);
    write(&mut bench, &mut next, of_axis(SEGMENT, 1), &cruise(1000, -QUARTER));
    write(&mut bench, &mut next, START, &[2]);
    while !status(&mut bench).idle {}
    while next < 42 {
        write(&mut bench, &mut next, CONTROL, &[0]);
    }
    let mut said = String::new();
    for line in block.lines() {
        let (kind, bytes) = line.split_once(' ').unwrap_or((line, ""));
        let mut shown = bytes.to_owned();
        match kind {
            "#" => bench.rest(9_000),
            ">" => bench.send(&unhex(bytes)),
            // The frame was lost on the line.
            ">x" => {}
            "<" | "<x" => {
                let answer =
                    bench.answer(PATIENCE).unwrap_or_else(|| panic!("no answer for {line}"));
                shown = format!("c0 {} c0", hex(&answer));
            }
            _ => panic!("{line}"),
        }
        said += &format!("{kind} {shown}\n");
    }
    assert_eq!(said, block, "docs/protocol.md should show\n{said}");
}

fn unhex(text: &str) -> Vec<u8> {
    text.split_whitespace().map(|byte| u8::from_str_radix(byte, 16).expect("hex")).collect()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().join(" ")
}

#[test]
fn a_repeated_write_is_answered_again_and_not_executed_again() {
    let mut bench = bench();
    let mut next = 0;
    powered(&mut bench, &mut next);
    let segment = cruise(100, QUARTER);
    assert_eq!(write(&mut bench, &mut next, of_axis(SEGMENT, 2), &segment).free, 6);
    for back in [1, 2] {
        let again = ask(&mut bench, next.wrapping_sub(back), 0x80 | of_axis(SEGMENT, 2), &segment);
        assert_eq!((again.next, again.free, again.refused), (next, 6, false));
    }
    // The link knows the last 127 writes: 127 back is known, 128 back is not, and neither is a
    // number that is too early.
    for (back, refused) in [(127_u8, false), (128, true), (255, true)] {
        let said = ask(&mut bench, next.wrapping_sub(back), 0x80 | of_axis(SEGMENT, 2), &segment);
        assert_eq!((said.next, said.free, said.refused), (next, 6, refused), "{back} back");
    }
}

#[test]
fn a_damaged_frame_is_not_answered_and_changes_nothing() {
    let mut bench = bench();
    let mut next = 0;
    powered(&mut bench, &mut next);
    let whole = frame(next, 0x80 | of_axis(SEGMENT, 0), &cruise(100, QUARTER));
    for bit in (0..8 * whole.len()).step_by(23) {
        let mut damaged = whole.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        bench.send(&on_the_line(&damaged));
    }
    for cut in (0..whole.len()).step_by(3) {
        bench.send(&on_the_line(&whole[..cut]));
    }
    // Frames that are too long, by one byte and by many; an ESC before an ordinary byte; an ESC
    // before the END.
    bench.send(&on_the_line(&[&whole[..], &[0]].concat()));
    bench.send(&on_the_line(&[0x55; 300]));
    bench.send(&[&[0xc0], &whole[..5], &[0xdb, 0x00], &whole[5..], &[0xc0]].concat());
    bench.send(&[&[0xc0], &whole[..], &[0xdb, 0xc0]].concat());
    while !bench.has_sent() {
        assert_eq!(bench.clock(), None);
    }
    bench.rest(PATIENCE);
    let said = status(&mut bench);
    assert_eq!((said.next, said.free, said.fault), (next, 7, None));
    assert_eq!(write(&mut bench, &mut next, of_axis(SEGMENT, 0), &cruise(100, QUARTER)).free, 6);
}

#[test]
fn a_broken_protocol_is_a_latched_fault_and_never_a_pulse() {
    let full = |bench: &mut LinkBench, next: &mut u8| {
        for free in (0..7).rev() {
            assert_eq!(write(bench, next, of_axis(SEGMENT, 3), &cruise(100, QUARTER)).free, free);
        }
        write(bench, next, of_axis(SEGMENT, 3), &cruise(100, QUARTER))
    };
    let no_ticks = |bench: &mut LinkBench, next: &mut u8| {
        write(bench, next, of_axis(SEGMENT, 3), &[u32::MAX, 0, 1 << 30, 0, 0, 0, 0, 1])
    };
    let nobody = |bench: &mut LinkBench, next: &mut u8| {
        write(bench, next, of_axis(SEGMENT, 6), &cruise(100, QUARTER))
    };
    let unfed = |bench: &mut LinkBench, next: &mut u8| {
        write(bench, next, START, &[1]);
        bench.rest(1000);
        status(bench)
    };
    type Breaks<'a> = &'a dyn Fn(&mut LinkBench, &mut u8) -> Said;
    let all: [(&str, Breaks<'_>); 4] = [
        ("a full queue", &full),
        ("no ticks", &no_ticks),
        ("no such axis", &nobody),
        ("an empty queue", &unfed),
    ];
    for (name, breaks) in all {
        let mut bench = bench();
        let mut next = 0;
        powered(&mut bench, &mut next);
        let said = breaks(&mut bench, &mut next);
        assert_eq!(said.fault, Some(Cause::Protocol), "{name}: {said:?}");
        // Before a clear nothing more is accepted; after it all queues are empty.
        write(&mut bench, &mut next, of_axis(SEGMENT, 3), &cruise(100, QUARTER));
        write(&mut bench, &mut next, START, &[1 << 3]);
        bench.rest(20_000);
        assert_eq!(status(&mut bench).fault, Some(Cause::Protocol), "{name}");
        assert_eq!(bench.steps, 0, "{name}");
        write(&mut bench, &mut next, CLEAR, &[0]);
        bench.rest(2000);
        let said = ask(&mut bench, 0, of_axis(POSITION, 3), &[]);
        assert_eq!(
            (said.fault, said.free, said.idle, said.data),
            (None, 7, true, 0),
            "{name}: {said:?}"
        );
        write(&mut bench, &mut next, of_axis(SEGMENT, 3), &cruise(100, QUARTER));
        write(&mut bench, &mut next, START, &[1 << 3]);
        while !status(&mut bench).idle {}
        assert_eq!(ask(&mut bench, 0, of_axis(POSITION, 3), &[]).data, 25, "{name}");
        assert_eq!(bench.steps, 25, "{name}");
    }
}

#[test]
fn a_second_start_is_refused_as_busy() {
    let mut bench = bench();
    let mut next = 0;
    powered(&mut bench, &mut next);
    for axis in 0..2 {
        write(&mut bench, &mut next, of_axis(SEGMENT, axis), &cruise(2000, QUARTER));
        write(&mut bench, &mut next, of_axis(SEGMENT, axis), &cruise(100, QUARTER));
    }
    write(&mut bench, &mut next, START, &[1]);
    // The start waits for axis 0.
    assert!(write(&mut bench, &mut next, START, &[3]).armed);
    let busy = ask(&mut bench, next, 0x80 | START, &[2]);
    assert_eq!((busy.next, busy.refused, busy.armed), (next, true, true));
    while status(&mut bench).armed {}
    write(&mut bench, &mut next, START, &[2]);
}

#[test]
fn a_limit_latches_the_state_of_a_homing_axis() {
    let mut bench = bench();
    let mut next = 0;
    powered(&mut bench, &mut next);
    assert_eq!(write(&mut bench, &mut next, HOME, &[0b100]).homing, 0b100);
    write(&mut bench, &mut next, of_axis(SEGMENT, 2), &cruise(100_000, -QUARTER));
    write(&mut bench, &mut next, START, &[0b100]);
    bench.rest(48 * 900);
    bench.pins.limit_min = 0b100;
    while !status(&mut bench).idle {}
    bench.rest(2000);
    let said = ask(&mut bench, 1, of_axis(POSITION, 2), &[]);
    assert_eq!((said.fault, said.homing), (None, 0), "{said:?}");
    let latched = ask(&mut bench, 1, of_axis(LIMIT_POSITION, 2), &[]).data.cast_signed();
    let rest = said.data.cast_signed();
    // The ramp goes from 2^62 down in steps of 2^54: 256 ticks of an eighth of a step on average.
    assert!((-34..=-30).contains(&(rest - latched)), "latched {latched}, at rest at {rest}");
    assert_eq!(bench.steps, u64::from(rest.unsigned_abs()));
}

/// The host sends as fast as the line allows: six queues of seven segments, and none is refused.
#[test]
fn segments_sent_back_to_back_are_all_accepted() {
    let mut bench = bench();
    let mut next = 0;
    powered(&mut bench, &mut next);
    let first = next;
    for _ in 0..7 {
        for axis in 0..AXES as u8 {
            bench.send(&on_the_line(&frame(
                next,
                0x80 | of_axis(SEGMENT, axis),
                &cruise(100, QUARTER),
            )));
            next += 1;
        }
    }
    for sequence in first..next {
        let answer = bench.answer(PATIENCE).expect("an answer");
        let said = Said::of(&unframe(&answer).expect("a frame"));
        assert_eq!((said.sequence, said.next, said.refused), (sequence, sequence + 1, false));
    }
}

/// SPI at a fifth of the clock and slower, at several ratios to it, with six requests in flight as
/// in docs/protocol.md.
#[test]
fn segments_over_spi_are_all_accepted() {
    for tenths in [25, 26, 31, 47, 80] {
        let mut bench = LinkBench::spi(&build(), tenths);
        let mut next = 0;
        powered(&mut bench, &mut next);
        for _ in 0..7 {
            let first = next;
            for axis in 0..AXES as u8 {
                // END and ESC occur as data in both directions.
                let mut words = cruise(0xc0c0_dbdb, QUARTER);
                words[6] = 0xdbc0_c0db;
                bench.send(&on_the_line(&frame(next, 0x80 | of_axis(SEGMENT, axis), &words)));
                next += 1;
            }
            for sequence in first..next {
                let answer = bench.answer(PATIENCE).expect("an answer");
                let said = Said::of(&unframe(&answer).expect("a frame"));
                assert_eq!(
                    (said.sequence, said.next, said.refused),
                    (sequence, sequence + 1, false),
                    "{tenths}"
                );
            }
        }
        assert_eq!(ask(&mut bench, 0xc0, of_axis(POSITION, 5), &[]).free, 0);
    }
}

/// Runs a session that uses every function, then replays its inputs on the exported Verilog of each
/// module and compares the outputs with Rust-HDL.
fn replayed(mut bench: LinkBench, line: LineKind) {
    bench.vectors = Some(Both::new(line));
    let mut next = 0;
    powered(&mut bench, &mut next);
    let damaged = on_the_line(&frame(next, 0x80 | of_axis(SEGMENT, 0), &cruise(100, QUARTER))[1..]);
    bench.send(&damaged);
    write(&mut bench, &mut next, HOME, &[0b100]);
    for axis in 0..AXES as u8 {
        let mut words = cruise(0xc0, -QUARTER);
        words[6] = 0xdbc0_c0db;
        write(&mut bench, &mut next, of_axis(SEGMENT, axis), &words);
    }
    write(&mut bench, &mut next, START, &[0x3f]);
    ask(&mut bench, next, 0x80 | START, &[1]);
    bench.pins.limit_min = 0b100;
    ask(&mut bench, next.wrapping_add(9), 0x80 | START, &[1]);
    write(&mut bench, &mut next, CONTROL, &[3]);
    write(&mut bench, &mut next, CONTROL, &[1]);
    write(&mut bench, &mut next, CLEAR, &[1]);
    write(&mut bench, &mut next, of_axis(SEGMENT, 7), &cruise(1, 0));
    write(&mut bench, &mut next, CLEAR, &[1]);
    for address in (0..9).chain(0x18..=0xff) {
        ask(&mut bench, address, address, &[]);
    }
    let both = bench.vectors.expect("what was kept");
    let link = link_verilog(&build(), line, "the test").expect("a link");
    assert_eq!(both.link.difference(LINK_NAME, &link).expect("Icarus"), None);
    let verilog = line_verilog(line, "the test").expect("a line");
    assert_eq!(both.line.difference(line_name(line), &verilog).expect("Icarus"), None);
    assert!(both.link.cycles() > 100_000, "{} cycles are no session", both.link.cycles());

    // A bug planted in each module must be detected.
    for (vectors, name, text, from, to) in [
        (&both.link, LINK_NAME, &link, "32'hedb88320", "32'hedb88321"),
        (&both.line, line_name(line), &verilog, "1'b1;", "1'b0;"),
    ] {
        let planted = text.replacen(from, to, 1);
        assert_ne!(&planted, text, "{from} is not in {name}");
        assert!(
            vectors.difference(name, &planted).expect("Icarus").is_some(),
            "{name}: {to} is not seen"
        );
    }
}

#[test]
fn exported_verilog_of_link_and_uart_equals_rust_hdl() {
    let uart = Uart::new(48_000_000, 3_000_000).expect("a UART");
    replayed(bench(), uart.into());
}

#[test]
fn exported_verilog_of_link_and_spi_equals_rust_hdl() {
    replayed(LinkBench::spi(&build(), 25), LineKind::Spi);
}

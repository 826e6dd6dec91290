//! The gateware's end of the link does what docs/protocol.md specifies: the page's example frames
//! byte by byte, and its other promises.

use carrystep_core::engine::{Cause, LimitWiring, SeekSource};
use carrystep_core::link::registers::{
    CLEAR, CONTROL, OPEN, POSITION, SEEK, SEEK_POSITION, SEGMENT, SEGMENTS, START, STOP, of_axis,
};
use carrystep_core::link::{LineKind, Uart};
use carrystep_core::{AXES, Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_tests::link_bench::{
    Both, Host, LinkBench, Said, on_the_line, owners_read, wide, write,
};
use carrystep_tools::kept;
use carrystep_verilog::{LINK_NAME, line_name, line_verilog, link_verilog};

/// The reasons of a refusal, as the page numbers them.
const SEQUENCE: u8 = 1;
const BUSY: u8 = 2;

fn build() -> EngineBuild {
    let timebase = Timebase::new(48_000_000, 2000, 16).expect("a timebase");
    let build = Build { timebase, phase: StartPhase::Half, pins: [PinTiming::SHORTEST; AXES] };
    let mut build = EngineBuild::minimal(&build, 1 << 54);
    build.guard.limits = LimitWiring::Pair;
    build.cuts = true;
    build
}

fn bench() -> LinkBench {
    LinkBench::uart(&build(), Uart::new(48_000_000, 3_000_000).expect("a UART"))
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
    // The state that the page's host finds: axis 1 is at -250, and the drivers have no power.
    let mut host = Host::powered(&mut bench);
    host.write(&mut bench, of_axis(SEGMENT, 1), &cruise(1000, -QUARTER));
    host.run(&mut bench, 2);
    host.write(&mut bench, CONTROL, &[0]);
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
                let answer = bench.answer(60_000).unwrap_or_else(|| panic!("no answer for {line}"));
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
    let mut host = Host::powered(&mut bench);
    let segment = cruise(100, QUARTER);
    assert_eq!(host.write(&mut bench, of_axis(SEGMENT, 2), &segment).free, 6);
    let back = |back: u8| host.frame(0_u8.wrapping_sub(back), of_axis(SEGMENT, 2), &segment);
    for known in [1, 2] {
        let again = bench.ask(&back(known));
        assert_eq!((again.next, again.free, again.reason), (host.next, 6, 0));
    }
    // The link knows the last 127 writes: 127 back is known, 128 back is not, and neither is a
    // number that is too early.
    for (number, reason) in [(127, 0), (128, SEQUENCE), (255, SEQUENCE)] {
        let said = bench.ask(&back(number));
        assert_eq!((said.next, said.free, said.reason), (host.next, 6, reason), "{number} back");
    }
}

#[test]
fn a_damaged_frame_is_not_answered_and_changes_nothing() {
    let mut bench = bench();
    let mut host = Host::powered(&mut bench);
    let whole = host.frame(0, of_axis(SEGMENT, 0), &cruise(100, QUARTER));
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
    bench.rest(30_000);
    let said = bench.status();
    assert_eq!((said.next, said.free, said.fault), (host.next, 7, None));
    assert_eq!(host.write(&mut bench, of_axis(SEGMENT, 0), &cruise(100, QUARTER)).free, 6);
}

#[test]
fn a_broken_protocol_is_a_latched_fault_and_never_a_pulse() {
    let full = |bench: &mut LinkBench, host: &mut Host| {
        for free in (0..7).rev() {
            assert_eq!(host.write(bench, of_axis(SEGMENT, 3), &cruise(100, QUARTER)).free, free);
        }
        host.write(bench, of_axis(SEGMENT, 3), &cruise(100, QUARTER))
    };
    let no_ticks = |bench: &mut LinkBench, host: &mut Host| {
        host.write(bench, of_axis(SEGMENT, 3), &[u32::MAX, 0, 1 << 30, 0, 0, 0, 0, 1])
    };
    let nobody = |bench: &mut LinkBench, host: &mut Host| {
        host.write(bench, of_axis(SEGMENT, 6), &cruise(100, QUARTER))
    };
    let unfed = |bench: &mut LinkBench, host: &mut Host| {
        host.write(bench, START, &[1]);
        bench.rest(1000);
        bench.status()
    };
    type Breaks<'a> = &'a dyn Fn(&mut LinkBench, &mut Host) -> Said;
    let all: [(&str, Breaks<'_>); 4] = [
        ("a full queue", &full),
        ("no ticks", &no_ticks),
        ("no such axis", &nobody),
        ("an empty queue", &unfed),
    ];
    for (name, breaks) in all {
        let mut bench = bench();
        let mut host = Host::powered(&mut bench);
        let said = breaks(&mut bench, &mut host);
        assert_eq!(said.fault, Some(Cause::Protocol), "{name}: {said:?}");
        // Before a clear nothing more is accepted; after it all queues are empty.
        host.write(&mut bench, of_axis(SEGMENT, 3), &cruise(100, QUARTER));
        host.write(&mut bench, START, &[1 << 3]);
        bench.rest(20_000);
        assert_eq!(bench.status().fault, Some(Cause::Protocol), "{name}");
        assert_eq!(bench.steps, 0, "{name}");
        host.write(&mut bench, CLEAR, &[0]);
        bench.rest(2000);
        let said = bench.read(of_axis(POSITION, 3));
        assert_eq!(
            (said.fault, said.free, said.idle, said.data),
            (None, 7, true, 0),
            "{name}: {said:?}"
        );
        host.write(&mut bench, of_axis(SEGMENT, 3), &cruise(100, QUARTER));
        host.write(&mut bench, START, &[1 << 3]);
        while !bench.status().idle {}
        assert_eq!(bench.read(of_axis(POSITION, 3)).data, 25, "{name}");
        assert_eq!(bench.steps, 25, "{name}");
    }
}

#[test]
fn a_second_start_is_refused_as_busy() {
    let mut bench = bench();
    let mut host = Host::powered(&mut bench);
    for axis in 0..2 {
        host.write(&mut bench, of_axis(SEGMENT, axis), &cruise(2000, QUARTER));
        host.write(&mut bench, of_axis(SEGMENT, axis), &cruise(100, QUARTER));
    }
    host.write(&mut bench, START, &[1]);
    // The start waits for axis 0.
    assert!(host.write(&mut bench, START, &[3]).armed);
    let busy = bench.ask(&host.frame(0, START, &[2]));
    assert_eq!((busy.next, busy.reason, busy.armed), (host.next, BUSY, true));
    while bench.status().armed {}
    host.write(&mut bench, START, &[2]);
}

/// The word of SEEK by which each of these axes waits for its own limit at the low end.
fn own_limits(axes: u32) -> u32 {
    let source = SeekSource { axis: 0, row: 0, own: true, level: true };
    axes | u32::from(source.byte()) << 8
}

#[test]
fn a_limit_latches_the_state_of_a_seeking_axis() {
    let mut bench = bench();
    let mut host = Host::powered(&mut bench);
    assert_eq!(host.write(&mut bench, SEEK, &[own_limits(0b100)]).seeking, 0b100);
    host.write(&mut bench, of_axis(SEGMENT, 2), &cruise(100_000, -QUARTER));
    host.write(&mut bench, START, &[0b100]);
    bench.rest(48 * 900);
    bench.pins.limit_min = 0b100;
    while !bench.status().idle {}
    bench.rest(2000);
    let said = bench.read(of_axis(POSITION, 2));
    assert_eq!((said.fault, said.seeking), (None, 0), "{said:?}");
    let latched = bench.read(of_axis(SEEK_POSITION, 2)).data.cast_signed();
    let rest = said.data.cast_signed();
    // The ramp goes from 2^62 down in steps of 2^54: 256 ticks of an eighth of a step on average.
    assert!((-34..=-30).contains(&(rest - latched)), "latched {latched}, at rest at {rest}");
    assert_eq!(bench.steps, u64::from(rest.unsigned_abs()));
}

/// The host sends as fast as the line allows: six queues of seven segments, and none is refused.
#[test]
fn segments_sent_back_to_back_are_all_accepted() {
    let mut bench = bench();
    let mut host = Host::powered(&mut bench);
    let first = host.next;
    for _ in 0..7 {
        for axis in 0..AXES as u8 {
            let register = of_axis(SEGMENT, axis);
            bench.send(&on_the_line(&host.frame(0, register, &cruise(100, QUARTER))));
            host.next += 1;
        }
    }
    accepted(&mut bench, first, 7 * AXES);
}

/// Receives the answers to segments for all axes in turn, from this sequence number on.
fn accepted(bench: &mut LinkBench, first: u8, segments: usize) {
    let axes = (0..AXES as u8).cycle();
    for (sequence, axis) in (first..).zip(axes).take(segments) {
        let said = bench.said((sequence, 0x80 | of_axis(SEGMENT, axis)));
        assert_eq!((said.next, said.reason), (sequence + 1, 0));
    }
}

/// SPI at a fifth of the clock and slower, at several ratios to it, with six requests in flight as
/// in docs/protocol.md.
#[test]
fn segments_over_spi_are_all_accepted() {
    for tenths in [25, 26, 31, 47, 80] {
        let mut bench = LinkBench::spi(&build(), tenths);
        let mut host = Host::powered(&mut bench);
        for _ in 0..7 {
            let first = host.next;
            for axis in 0..AXES as u8 {
                // END and ESC occur as data in both directions.
                let mut words = cruise(0xc0c0_dbdb, QUARTER);
                words[6] = 0xdbc0_c0db;
                bench.send(&on_the_line(&host.frame(0, of_axis(SEGMENT, axis), &words)));
                host.next += 1;
            }
            accepted(&mut bench, first, AXES);
        }
        assert_eq!(bench.read(of_axis(POSITION, 5)).free, 0);
    }
}

/// Runs a session that uses every function, then replays its inputs on the exported Verilog of each
/// module and compares the outputs with Rust-HDL.
fn replayed(mut bench: LinkBench, line: LineKind) {
    bench.vectors = Some(Both::new(&build(), line));
    let mut host = Host::powered(&mut bench);
    let damaged = &host.frame(0, of_axis(SEGMENT, 0), &cruise(100, QUARTER))[1..];
    bench.send(&on_the_line(damaged));
    host.write(&mut bench, SEEK, &[own_limits(0b100)]);
    for axis in 0..AXES as u8 {
        let mut words = cruise(0xc0, -QUARTER);
        words[6] = 0xdbc0_c0db;
        host.write(&mut bench, of_axis(SEGMENT, axis), &words);
    }
    bench.ask(&write(1, OPEN, 7, &[0]));
    host.write(&mut bench, START, &[0x3f]);
    bench.ask(&host.frame(0, START, &[1]));
    bench.pins.limit_min = 0b100;
    bench.ask(&host.frame(9, START, &[1]));
    bench.ask(&write(1, STOP, 0, &[0]));
    while !bench.status().halted {}
    host.write(&mut bench, CLEAR, &[1]);
    host.write(&mut bench, SEGMENTS, &wide(0b10_1101, 0xdb, &[[QUARTER, 0xc0, -0xdb]; 4], true));
    host.write(&mut bench, of_axis(SEGMENT, 7), &cruise(1, 0));
    while !bench.status().halted {}
    host = Host::open(&mut bench, 0x1234);
    host.write(&mut bench, CLEAR, &[1]);
    for address in (0..9).chain(0x18..=0xff) {
        bench.ask(&owners_read(address, address, host.session));
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
    kept::say();
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

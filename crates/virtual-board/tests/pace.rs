//! The time that the gateware takes for a frame is at most that of docs/protocol.md ("The time of a
//! frame").
//!
//! `CARRYSTEP_FRAMES` sets the number of builds.

use crate::support::random::Random;
use crate::support::{SESSION, asked, build};
use carrystep_core::Timebase;
use carrystep_core::link::{END, Uart};
use carrystep_link::registers::OPEN;
use carrystep_link::{Body, LinkPace, OutputChange, Request, Segment, WideSegment, slip};
use carrystep_virtual_board::ModelBoard;
use std::num::NonZeroU16;

/// A segment for so many axes; 0: a read.
fn frame(random: &mut Random, axes: u32) -> Body {
    let mut long = || random.below(u64::MAX).cast_signed();
    let (ticks, last, outputs) = (100_000, false, OutputChange::NONE);
    match axes {
        0 => Body::Read { address: 0x70 },
        1 => {
            let segment = Segment { ticks, v: long(), a: long(), j: long(), last };
            Body::Segment { axis: 0, segment, outputs }
        }
        _ => Body::Segments(WideSegment {
            mask: ((1_u16 << axes) - 1) as u8,
            ticks,
            cubics: [0; 8].map(|_| [long(), long(), long()]),
            last,
            outputs,
        }),
    }
}

/// Sends frames faster than the gateware processes them, and measures the time from answer to
/// answer.
#[test]
fn gateware_is_busy_with_a_frame_for_no_longer_than_its_page_says() {
    let mut random = Random::new(7);
    let mut closest = 0.0_f64;
    for _ in 0..asked("CARRYSTEP_FRAMES", 60) {
        // Clocks of a tick and of a bit.
        let longest = 1 << (3 + random.below(10));
        let tick = 80 + random.below(longest);
        let bit = 8 + random.below(24);
        let axes = random.below(7) as u32;
        let mut build = build();
        build.timebase = Timebase::new(1_000_000_000, tick, 1).unwrap();
        let baud = (1_000_000_000 / bit) as u32;
        let uart = Uart::new(1_000_000_000, baud).unwrap();
        assert_eq!(u64::from(uart.bit_clocks()), bit);
        let pace = LinkPace::new(1_000_000_000, tick, baud);
        let mut board = ModelBoard::new(&build, uart);
        let say = |board: &mut ModelBoard, request: Request| {
            slip::encode(request.to_bytes().as_slice()).for_each(|byte| board.say(byte));
        };
        // The ends of the answers.
        let answers = |board: &mut ModelBoard, clocks: u64| {
            let (mut ends, mut within) = (Vec::new(), false);
            let end = board.cycle() + clocks;
            while board.cycle() < end {
                board.run(board.cycle() + bit, &mut ());
                while let Some(byte) = board.next_byte() {
                    if byte == END && std::mem::take(&mut within) {
                        ends.push(board.cycle());
                    }
                    within = byte != END;
                }
            }
            ends
        };
        let session = NonZeroU16::get(SESSION);
        let open = Body::Write { address: OPEN, word: 0 };
        say(&mut board, Request { sequence: 0, session, body: open });
        assert_eq!(answers(&mut board, 3000 * bit + 4 * tick).len(), 1);
        let count = if axes == 0 { 20 } else { 2 };
        let body = frame(&mut random, axes);
        let mut bytes = 0_u64;
        for sequence in 0..count {
            bytes = slip::encode(Request { sequence, session, body }.to_bytes().as_slice()).count()
                as u64;
            say(&mut board, Request { sequence, session, body });
        }
        let most = pace.clocks(&body);
        let ends = answers(&mut board, u64::from(count) * (2 * most + 3000 * bit));
        assert_eq!(ends.len(), usize::from(count), "a tick of {tick} clocks, {axes} axes");
        let took = (ends[ends.len() - 1] - ends[0]) / u64::from(count - 1);
        // Frames that come more slowly than they are processed show nothing.
        let line = took <= 10 * bit * bytes + 2 * tick;
        assert!(took <= most + bit || line, "{took} of {most} clocks: {tick}, {bit}, {axes}");
        if !line {
            closest = closest.max(took as f64 / most as f64);
        }
    }
    assert!(closest > 0.85, "the page's bound is far from what was measured: {closest}");
}

/// The table of the page has the numbers of its formula.
#[test]
fn table_of_the_page_follows_from_its_formula() {
    let page = include_str!("../../../docs/protocol.md");
    for (mhz, baud, tick_us) in [(80, 921_600, 1), (48, 3_000_000, 2), (48, 3_000_000, 20)] {
        let pace = LinkPace::new(mhz * 1_000_000, tick_us * 1000, baud);
        let byte = 10 * ((mhz * 1_000_000 + u64::from(baud) / 2) / u64::from(baud));
        let [six, one] = [6, 1].map(|axes| {
            let frame = frame(&mut Random::new(1), axes);
            (pace.clocks(&frame), (frame.bytes() as u64 + 2) * byte)
        });
        let full = match one.0.checked_sub(one.1) {
            Some(behind) => format!("{} segments for one axis", (511 * byte).div_ceil(behind)),
            None => "never".to_owned(),
        };
        let times = [six, one].map(|(gateware, line)| format!("{gateware} and {line} clocks"));
        let end = format!("| {tick_us} us | {} | {} | {full} |", times[0], times[1]);
        let row = page.lines().find(|line| line.ends_with(&end));
        assert!(row.is_some_and(|row| row.starts_with(&format!("| {mhz} MHz |"))), "{end}");
    }
}

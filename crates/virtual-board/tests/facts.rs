//! The statements of docs/protocol.md about rare requests and about the watchdog, checked with a
//! board of models and with the exported Verilog.

use crate::support::link::device::on_the_line;
use crate::support::requests::Talk;
use crate::support::{self, Kind, MS};
use carrystep_core::engine::Cause;
use carrystep_core::link::END;
use carrystep_core::link::registers::{REGISTERS, RegisterAccess};
use carrystep_link::registers::{
    AXES_AT, AXIS_COUNT, BUILD_HIGH, CLEAR, CONTROL, MOST_AXES, OPEN, POSITION, SEEK, SEGMENT,
    SNAPSHOT, START, STOP, WRITE,
};
use carrystep_link::{Patience, Refusal, frame};
use carrystep_virtual_board::{ModelBoard, VerilatedBoard};

/// A segment with V = a quarter of a step per tick.
const fn cruise(ticks_less_one: u32, last: bool) -> [u32; 8] {
    [ticks_less_one, 0, 0x4000_0000, 0, 0, 0, 0, last as u32]
}

/// A board on which axis k has k segments in its queue, which holds 7.
fn filled<B: Kind>() -> Talk<B> {
    let mut talk = Talk::powered();
    for axis in 0..6 {
        (0..axis).for_each(|_| assert!(talk.segment(axis, cruise(99, true)).refusal.is_none()));
    }
    talk
}

/// A read of any address is answered. `free` belongs to the axis in bits 0 to 2 of the address. An
/// address without a register gives 0.
fn reads<B: Kind>() {
    let mut talk = filled::<B>();
    let next = talk.next;
    let is_register = |address: u8| {
        REGISTERS.iter().filter(|register| register.access == RegisterAccess::Read).any(
            |register| {
                let axes = if register.per_axis { 6 } else { 1 };
                (0..axes).any(|axis| register.address + axis == address)
            },
        )
    };
    for address in 0..=0xff_u8 {
        let answer = talk.read(address);
        let axis = address & (MOST_AXES - 1);
        if axis < 6 {
            assert_eq!(answer.free, 7 - axis, "{address:02x}");
        }
        assert_eq!(answer.axis(), (address >= AXES_AT).then_some(axis), "{address:02x}");
        assert_eq!(
            (answer.next, answer.fault, answer.refusal, answer.written),
            (next, false, None, false),
            "{address:02x}"
        );
        if !is_register(address) {
            assert_eq!(answer.data, 0, "{address:02x} is no register");
        }
    }
}

/// A write to an address without a register is executed and has no effect. With another length it
/// is not answered.
fn writes<B: Kind>() {
    let mut talk = filled::<B>();
    let known = [CONTROL, START, CLEAR, SEEK, SNAPSHOT, OPEN, STOP];
    for address in (0..0x40_u8).filter(|address| !known.contains(address)) {
        let answer = talk.write(address, 0xffff_ffff);
        let state = (
            answer.free,
            answer.data,
            answer.fault,
            answer.refusal,
            answer.ready,
            answer.armed,
            answer.seeking,
        );
        assert_eq!(state, (7, 0, false, None, true, false, 0), "{address:02x}");
    }
    let next = talk.next;
    talk.send(&talk.content(next, WRITE | AXIS_COUNT, &[0; 8]));
    assert_eq!(talk.answer(), None, "eight words for a register of one");
    talk.send(&talk.content(next, WRITE | frame::of_axis(SEGMENT, 0), &[0]));
    assert_eq!(talk.answer(), None, "one word for a segment");
    for axis in 0..6 {
        let answer = talk.read(frame::of_axis(POSITION, axis));
        assert_eq!((answer.next, answer.free), (next, 7 - axis));
    }
    // Words at an address that only reads have.
    talk.send(&talk.content(next, POSITION, &[0]));
    assert_eq!(talk.answer(), None, "a word for a register that is only read");
    let answer = talk.segment(1, cruise(99, true));
    assert_eq!((answer.free, answer.fault, answer.written), (5, false, true));
    // An axis that the build does not have.
    let answer = talk.segment(7, cruise(99, true));
    assert_eq!((answer.fault, answer.cause), (true, Cause::Protocol as u8));
}

/// A START of no axis is armed until the next tick and moves nothing. A START without power is
/// refused as busy until there is power.
fn starts<B: Kind>() {
    for mask in [0_u32, 0x40, 0xffff_ffc0] {
        let mut talk = filled::<B>();
        assert!(talk.write(START, mask).armed, "{mask:x}");
        talk.rest(10 * support::TICK);
        let answer = talk.read(POSITION);
        assert_eq!((answer.fault, answer.armed, answer.free), (false, false, 7), "{mask:x}");
        assert_eq!(talk.read(frame::of_axis(POSITION, 5)).free, 2, "{mask:x}");
    }
    let mut talk = Talk::<B>::new();
    talk.segment(0, cruise(99, true));
    for _ in 0..3 {
        let answer = talk.ask(&talk.content(talk.next, WRITE | START, &[1]));
        assert_eq!(
            (answer.next, answer.refusal, answer.ready, answer.armed),
            (talk.next, Some(Refusal::Busy), false, false)
        );
    }
    talk.write(CONTROL, 1);
    while !talk.read(POSITION).ready {}
    assert!(talk.write(START, 1).armed);
}

/// The longest segment has 2^32 - 1 ticks. One tick more would encode 0 ticks, which is a fault.
fn ticks<B: Kind>() {
    let mut talk = Talk::<B>::powered();
    let longest = talk.segment(0, cruise(0xffff_fffe, true));
    assert_eq!((longest.fault, longest.free), (false, 6));
    let none = talk.segment(0, cruise(0xffff_ffff, true));
    assert_eq!((none.fault, none.cause, none.free), (true, Cause::Protocol as u8, 6));
}

/// A time longer than the watchdog's of this build: 49 rounds of 1024 ticks of 2 us, 100.4 ms.
const OVER: u64 = 110 * MS;
const UNDER: u64 = 90 * MS;

/// The watchdog runs while a segment waits at rest, but not while the machine is idle. Only frames
/// of the owner restart it.
fn watchdog<B: Kind>() {
    let mut talk = Talk::<B>::powered();
    talk.rest(OVER);
    let answer = talk.read(POSITION);
    assert!(!answer.fault && answer.idle, "nothing waits: {answer:?}");
    talk.segment(0, cruise(99, true));
    for _ in 0..2 {
        talk.rest(UNDER);
        assert!(!talk.own_read(BUILD_HIGH).fault, "any read of the owner feeds it");
    }
    // Bytes without a frame, a frame with a wrong CRC, and one with a wrong length.
    let mut harmed = on_the_line(&[0, POSITION]);
    harmed[3] ^= 1;
    for noise in [vec![0x55; 20], harmed, on_the_line(&[0, POSITION, 1, 2, 3, 4]), vec![END; 20]] {
        talk.rest(OVER / 6);
        assert_eq!(talk.read(POSITION).refusal, None, "a read of anyone, which does not feed it");
        noise.iter().for_each(|&byte| talk.board.say(byte));
    }
    talk.rest(OVER / 3);
    let answer = talk.read(POSITION);
    assert_eq!((answer.fault, answer.cause), (true, Cause::Watchdog as u8), "{answer:?}");
}

/// A write of the owner that is refused or answered again restarts the watchdog, too.
fn refusals_feed<B: Kind>() {
    let mut talk = Talk::<B>::powered();
    talk.segment(0, cruise(99, true));
    for number in [talk.next.wrapping_add(5), talk.next.wrapping_sub(1)] {
        talk.rest(UNDER);
        let answer = talk.ask(&talk.content(number, WRITE | START, &[0]));
        assert_eq!((answer.next, answer.fault), (talk.next, false));
    }
    talk.rest(UNDER);
    assert!(!talk.read(POSITION).fault);
}

/// The times of the page must be those of the driver in Rust.
#[test]
fn timeouts_equal_those_of_the_page() {
    let page = include_str!("../../../docs/protocol.md");
    let Patience { timing, silence, lost, change, status_period } = Patience::default();
    for row in [
        format!("| no progress, send again from `next` on | after {} ms |", timing.resend),
        format!("| busy, try again | after {} ms |", timing.pause),
        format!(
            "| no answer at all, give up | after {silence} ms, or {lost} ms once the board has answered |"
        ),
        format!("| power, a stop by ramps, a clear | {change} ms at most |"),
        format!("| read of the state while there is nothing to send | every {status_period} ms |"),
    ] {
        assert!(page.contains(&row), "{row}");
    }
}

fn all<B: Kind>() {
    reads::<B>();
    writes::<B>();
    starts::<B>();
    ticks::<B>();
    watchdog::<B>();
    refusals_feed::<B>();
}

#[test]
fn statements_of_the_page_hold_for_the_models() {
    all::<ModelBoard>();
}

#[test]
fn statements_of_the_page_hold_for_the_verilog() {
    all::<VerilatedBoard>();
}

//! The protocol between the gateware and its hosts: constants, the register map, and the fields of
//! an answer.
//!
//! This file is generated from `crates/core/src/link` by `cargo xtask generate`: change that source
//! instead.

/// Ends a frame, and begins one.
pub const END: u8 = 0xc0;
/// Says that the next byte stands for another.
pub const ESC: u8 = 0xdb;
/// After ESC: END.
pub const ESC_END: u8 = 0xdc;
/// After ESC: ESC.
pub const ESC_ESC: u8 = 0xdd;
/// CRC-32 of Ethernet and zlib, reflected: polynomial.
pub const CRC_POLYNOMIAL: u32 = 0xedb8_8320;
/// What its register holds, not yet inverted, after a frame and its CRC.
pub const CRC_RESIDUE: u32 = 0xdebb_20e3;
/// Bytes of a CRC.
pub const CRC_BYTES: usize = 4;
/// Set in an address: the frame writes.
pub const WRITE: u8 = 0x80;
/// Sequence and address.
pub const REQUEST_HEAD: usize = 2;
/// Words of a segment, the commit included.
pub const SEGMENT_FRAME_WORDS: usize = 8;
/// The longest request, without END and ESC.
pub const LONGEST_REQUEST: usize = 38;
/// An answer, without END and ESC.
pub const ANSWER_BYTES: usize = 15;
/// First byte of an answer's data.
pub const ANSWER_DATA: usize = 7;
/// Frames by which a repeated one may lie behind the next; so many may be on their way.
pub const WINDOW: u8 = 0x7f;
/// What IDENTITY holds.
pub const IDENTITY_VALUE: u32 = 0x5054_5343;
/// The version of the protocol that this map belongs to.
pub const PROTOCOL_VERSION: u32 = 0x0000_0001;
/// In CONTROL: power the drivers.
pub const CONTROL_ENABLE: u32 = 0x0000_0001;
/// In CONTROL: stop all axes.
pub const CONTROL_STOP: u32 = 0x0000_0002;
/// First address of the axes.
pub const AXES_AT: u8 = 0x40;
/// Addresses of each axis.
pub const PER_AXIS: u8 = 0x08;
/// Most axes of a build.
pub const MOST_AXES: u8 = 0x08;
/// Segments that can wait for an axis, beside the one that runs.
pub const QUEUE_SEGMENTS: u8 = 0x07;

/// "CSTP", low byte first: this is carrystep (read).
pub const IDENTITY: u8 = 0x00;
/// version of this protocol (read).
pub const PROTOCOL: u8 = 0x01;
/// build id, low half: a hash of this map and of all build parameters (read).
pub const BUILD_LOW: u8 = 0x02;
/// build id, high half (read).
pub const BUILD_HIGH: u8 = 0x03;
/// axes of this build (read).
pub const AXIS_COUNT: u8 = 0x04;
/// clock, Hz (read).
pub const CLOCK_HZ: u8 = 0x05;
/// tick, ns (read).
pub const TICK_NS: u8 = 0x06;
/// phases of a tick (read).
pub const PHASES: u8 = 0x07;
/// ticks of silence after which the axes are stopped; 0: never (read).
pub const WATCHDOG_TICKS: u8 = 0x08;
/// bit 0: power the drivers; bit 1: stop all axes by their ramps (write).
pub const CONTROL: u8 = 0x20;
/// axes that start together, a bit each, on the first tick at which all rest and have a segment (write).
pub const START: u8 = 0x21;
/// resume after a stop, whatever is written: queues empty, P at its start; the position stays (write).
pub const CLEAR: u8 = 0x22;
/// axes, a bit each, whose next limit latches their position and stops only them (write).
pub const HOME: u8 = 0x23;
/// fraction of a step, low half, 2^-64 step (read, axis 0).
pub const P_LOW: u8 = 0x40;
/// fraction of a step, high half (read, axis 0).
pub const P_HIGH: u8 = 0x41;
/// steps forward less steps back, two's complement (read, axis 0).
pub const POSITION: u8 = 0x42;
/// steps that freezes have discarded (read, axis 0).
pub const DISCARDED: u8 = 0x43;
/// position when the limit was reached in homing (read, axis 0).
pub const LATCHED: u8 = 0x44;
/// ticks - 1, V, A, J (low half first, 2^-64 step per tick^1, 2, 3), then 1 where it is the last of its move (write, 8 words, axis 0).
pub const SEGMENT: u8 = 0x40;

/// The causes of a stop, by their number in the field `cause` of an answer.
pub const CAUSES: [&str; 8] =
    ["e-stop", "overrun", "protocol", "watchdog", "overspeed", "limit", "underrun", "stop"];

/// Of an answer: the request's sequence number.
pub const fn sequence(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[0]
}

/// Of an answer: the request's address.
pub const fn address(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[1]
}

/// Of an answer: the sequence number that the next write must have: all before it have been executed.
pub const fn next(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[2]
}

/// Of an answer: a stop has been called; segments and starts are dropped until a clear.
pub const fn fault(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] & 1 == 1
}

/// Of an answer: the stop is over: no axis moves any more.
pub const fn halted(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] >> 1 & 1 == 1
}

/// Of an answer: all axes are done, and no start is armed.
pub const fn idle(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] >> 2 & 1 == 1
}

/// Of an answer: the drivers have had power for long enough: starts are taken.
pub const fn ready(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] >> 3 & 1 == 1
}

/// Of an answer: a start waits; another is refused as busy.
pub const fn armed(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] >> 4 & 1 == 1
}

/// Of an answer: why, where there is a fault.
pub const fn cause(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[3] >> 5
}

/// Of an answer: segments that the addressed axis still takes.
pub const fn free(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[4] & 7
}

/// Of an answer: this write was not executed: out of sequence, or busy.
pub const fn refused(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[4] >> 3 & 1 == 1
}

/// Of an answer: where there is a fault: the axes that it came from.
pub const fn culprits(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[5]
}

/// Of an answer: axes that still wait for their limit.
pub const fn homing(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[6]
}


//! The protocol between the gateware and its hosts: constants, the register map, and the fields of
//! an answer.
//!
//! This file is generated from `crates/core/src/link` by `cargo xtask generate`: change that source
//! instead.

/// Byte that begins and ends a frame.
pub const END: u8 = 0xc0;
/// Escape byte: with the next byte it stands for END or ESC in a frame.
pub const ESC: u8 = 0xdb;
/// After ESC: the pair stands for END.
pub const ESC_END: u8 = 0xdc;
/// After ESC: the pair stands for ESC.
pub const ESC_ESC: u8 = 0xdd;
/// Polynomial of the CRC-32 of Ethernet and zlib, reflected.
pub const CRC_POLYNOMIAL: u32 = 0xedb8_8320;
/// Value of the CRC register, before its inversion, after a frame and its CRC.
pub const CRC_RESIDUE: u32 = 0xdebb_20e3;
/// Length of a CRC in bytes.
pub const CRC_BYTES: usize = 4;
/// Bit that the address of every write has.
pub const WRITE: u8 = 0x80;
/// Length of the sequence number and the address of a request in bytes.
pub const REQUEST_HEAD: usize = 2;
/// Length of the session number in a request in bytes.
pub const SESSION_BYTES: usize = 2;
/// Number of words of a SEGMENT frame, the commit included.
pub const SEGMENT_FRAME_WORDS: usize = 8;
/// Number of words of a SEGMENTS frame before its axes: the mask, and ticks - 1.
pub const SEGMENTS_HEAD_WORDS: usize = 2;
/// Number of words for each axis of a SEGMENTS frame: V, A, J.
pub const SEGMENTS_AXIS_WORDS: usize = 6;
/// Length of the longest request (SEGMENTS for eight axes) in bytes, without END and ESC.
pub const LONGEST_REQUEST: usize = 212;
/// Length of an answer in bytes, without END and ESC.
pub const ANSWER_BYTES: usize = 16;
/// Number of the first data byte in an answer.
pub const ANSWER_DATA: usize = 8;
/// Number of writes that may be unacknowledged, and by which a repeated one may lie behind.
pub const WINDOW: u8 = 0x7f;
/// Value of the register IDENTITY.
pub const IDENTITY_VALUE: u32 = 0x5054_5343;
/// Version of the protocol to which this register map belongs.
pub const PROTOCOL_VERSION: u32 = 0x0000_0002;
/// Bit of CONTROL: power the drivers.
pub const CONTROL_ENABLE: u32 = 0x0000_0001;
/// Bit of OPEN: stop all axes if the gateware is busy.
pub const OPEN_FORCE: u32 = 0x0000_0001;
/// Lowest address at which a register of an axis is read.
pub const AXES_AT: u8 = 0x10;
/// Bits of STATUS: the slot of the running segment.
pub const STATUS_SLOT: u32 = 0x0000_001f;
/// Bit of STATUS: the axis runs a segment.
pub const STATUS_RUNS: u32 = 0x0000_0020;
/// Bits of STATUS: the number of segments that wait.
pub const STATUS_WAITING: u32 = 0x0000_07c0;
/// Bits of STATUS: the number of steps on their way, two's complement.
pub const STATUS_ON_WAY: u32 = 0x0000_f000;
/// Greatest number of axes of a build.
pub const MOST_AXES: u8 = 0x08;
/// Number of segments that can wait for an axis of any build, besides the one that runs.
pub const LEAST_QUEUE: u8 = 0x07;

/// The bytes of "CSTP", low byte first, which identify carrystep (read).
pub const IDENTITY: u8 = 0x00;
/// Version of the protocol (read).
pub const PROTOCOL: u8 = 0x01;
/// Build id, low half: a hash of register map and build parameters, for hosts to compare (read).
pub const BUILD_LOW: u8 = 0x02;
/// Build id, high half (read).
pub const BUILD_HIGH: u8 = 0x03;
/// Number of axes (read).
pub const AXIS_COUNT: u8 = 0x04;
/// Frequency of the clock in Hz (read).
pub const CLOCK_HZ: u8 = 0x05;
/// Length of a tick in ns (read).
pub const TICK_NS: u8 = 0x06;
/// Number of phases in a tick (read).
pub const PHASES: u8 = 0x07;
/// Ticks without a frame of the owner after which all axes are stopped; 0: no watchdog (read).
pub const WATCHDOG_TICKS: u8 = 0x08;
/// Byte 0: the axes that have hit the source of their seek, one bit each, until the seek is ended; byte 1: bits 3..0 further edges since latch 0 was armed, bit 4 it is armed (read).
pub const CAPTURES: u8 = 0x09;
/// Debounced states of the switches, 1 active, a byte for each row: limits at low ends, at high ends, inputs of row 2 (bit 0: probe) and of row 3 (bit 0: interlock) (read).
pub const INPUTS: u8 = 0x0a;
/// Levels of the same pins, 1 active, when they were sampled last (read).
pub const INPUT_LEVELS: u8 = 0x0b;
/// Number of segments that can wait for an axis, besides the one that runs: 7, 15 or 31 (read).
pub const QUEUE_DEPTH: u8 = 0x0c;
/// Only in a build with several latches, else 0; a bit for each latch: 3..0 it is armed, 7..4 the build has it; 15..8 the record of each, 2 bits each; 31..16 further edges since it was armed, 4 bits each; latch 0 lowest (read).
pub const LATCHES: u8 = 0x0d;
/// Limit at the low end: bit 7 its debounced state, bit 6 the level of its pin, 1 active; the other bits have no meaning (read, axis 0).
pub const LIMIT_MIN_SWITCH: u8 = 0x10;
/// Limit at the high end, likewise (read, axis 0).
pub const LIMIT_MAX_SWITCH: u8 = 0x50;
/// Input of row 2 in the time slot of this axis, likewise; of axis 0 it is the probe (read, axis 0).
pub const INPUT_0_SWITCH: u8 = 0x90;
/// Input of row 3 in the time slot of this axis, likewise; of axis 0 it is the interlock (read, axis 0).
pub const INPUT_1_SWITCH: u8 = 0xd0;
/// TICKS at the hit of a seek (read, axis 0).
pub const SEEK_TICKS: u8 = 0x18;
/// P in the tick after the hit of a seek, low half (read, axis 0).
pub const SEEK_P_LOW: u8 = 0x20;
/// P at the hit, high half (read, axis 0).
pub const SEEK_P_HIGH: u8 = 0x28;
/// POSITION at the hit (read, axis 0).
pub const SEEK_POSITION: u8 = 0x30;
/// STATUS at the hit (read, axis 0).
pub const SEEK_STATUS: u8 = 0x38;
/// Number of steps that freezes have discarded since configuration (read, axis 0).
pub const DISCARDED: u8 = 0x40;
/// Ticks of the running segment after the next one; no meaning while the axis does not run (read, axis 0).
pub const LEFT: u8 = 0x48;
/// Number of ticks since configuration, modulo 2^32; the same for all axes (read, axis 0).
pub const TICKS: u8 = 0x58;
/// P, the fraction of a step in units of 2^-64 step, low half (read, axis 0).
pub const P_LOW: u8 = 0x60;
/// P, high half (read, axis 0).
pub const P_HIGH: u8 = 0x68;
/// Position: steps forward minus steps backward, two's complement (read, axis 0).
pub const POSITION: u8 = 0x70;
/// Bits 4..0: slot of the running segment; 5: runs; 10..6: segments that wait; 15..12: steps on their way, two's complement; the other bits have no meaning (read, axis 0).
pub const STATUS: u8 = 0x78;
/// DISCARDED in the tick of the snapshot; no meaning if the axis ran (read, axis 0).
pub const SNAPSHOT_DISCARDED: u8 = 0x80;
/// LEFT in the tick of the snapshot; no meaning if the axis did not run (read, axis 0).
pub const SNAPSHOT_LEFT: u8 = 0x88;
/// TICKS of the snapshot; the same for all axes (read, axis 0).
pub const SNAPSHOT_TICKS: u8 = 0x98;
/// P in that tick, low half (read, axis 0).
pub const SNAPSHOT_P_LOW: u8 = 0xa0;
/// P in that tick, high half (read, axis 0).
pub const SNAPSHOT_P_HIGH: u8 = 0xa8;
/// POSITION in that tick (read, axis 0).
pub const SNAPSHOT_POSITION: u8 = 0xb0;
/// STATUS in that tick (read, axis 0).
pub const SNAPSHOT_STATUS: u8 = 0xb8;
/// DISCARDED in the tick of the chosen latch; no meaning if the axis ran (read, axis 0).
pub const LATCH_DISCARDED: u8 = 0xc0;
/// LEFT in the tick of the chosen latch; no meaning if the axis did not run (read, axis 0).
pub const LATCH_LEFT: u8 = 0xc8;
/// TICKS of the chosen latch; the same for all axes (read, axis 0).
pub const LATCH_TICKS: u8 = 0xd8;
/// P in that tick, low half (read, axis 0).
pub const LATCH_P_LOW: u8 = 0xe0;
/// P in that tick, high half (read, axis 0).
pub const LATCH_P_HIGH: u8 = 0xe8;
/// POSITION in that tick (read, axis 0).
pub const LATCH_POSITION: u8 = 0xf0;
/// STATUS in that tick (read, axis 0).
pub const LATCH_STATUS: u8 = 0xf8;
/// Bit 0: power the drivers (write).
pub const CONTROL: u8 = 0x20;
/// Axes, one bit each, to start together once all rest; an empty queue: fault (protocol) (write).
pub const START: u8 = 0x21;
/// Any value ends a complete stop: queues empty, P at its start value, position kept (write).
pub const CLEAR: u8 = 0x22;
/// Byte 0: the axes that wait for a source, one bit each, 0 ends the seek; byte 1: the source, axis of the switch in bits 2..0, row in 4..3, own switch of each axis in 5, state that is the hit in 6 (write).
pub const SEEK: u8 = 0x23;
/// Any value: the SNAPSHOT_ registers take the state of all axes in one and the same tick (write).
pub const SNAPSHOT: u8 = 0x24;
/// Makes the session number of this frame the owner; bit 0: stop all axes if it is busy (write).
pub const OPEN: u8 = 0x25;
/// Any value stops all axes, each with its ramp; executed for every host (write).
pub const STOP: u8 = 0x26;
/// One latch: any value arms it, so that its next edge latches the state of all axes; several: bits 3..0 arm these latches, 5..4 choose the one whose record LATCH_ registers show (write).
pub const LATCH: u8 = 0x27;
/// Ticks - 1; V, A, J in 2^-64 step per tick, tick^2, tick^3, low half first; 1 if last of its move, else 0 (write, 8 words, axis 0).
pub const SEGMENT: u8 = 0x40;
/// Axes, one bit each; ticks - 1; V, A, J of each of these axes in ascending order, low half first; 1 if last of their move, else 0 (write, 3 words and 6 for each axis).
pub const SEGMENTS: u8 = 0x48;
/// A word for each axis from 0 to 7: bits 4..0 the slot of the last segment that it keeps; bits 31..24 are 0 if the axis takes no part (write, 8 words).
pub const CUT: u8 = 0x50;

/// The causes of a stop, by their number in the field `cause` of an answer.
pub const CAUSES: [&str; 9] =
    ["e-stop", "overrun", "protocol", "watchdog", "overspeed", "limit", "underrun", "stop", "interlock"];

/// The reasons of a refusal, by their number in the field `reason` of an answer; 0: not refused.
pub const REASONS: [&str; 6] =
    ["none", "sequence", "busy", "session", "seek ended", "cut"];
/// A write before this one was lost: its number is not `next`.
pub const REASON_SEQUENCE: u8 = 1;
/// The request cannot be executed now: try again.
pub const REASON_BUSY: u8 = 2;
/// The request does not have the session number of the gateware's owner.
pub const REASON_SESSION: u8 = 3;
/// An axis that it names has hit the source of its seek, and the host has not ended the seek.
pub const REASON_SEEK_ENDED: u8 = 4;
/// A segment that the CUT names neither waits nor runs any more: no axis has dropped any.
pub const REASON_CUT: u8 = 5;

/// Of an answer: the sequence number of the request.
pub const fn sequence(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[0]
}

/// Of an answer: the address of the request.
pub const fn address(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[1]
}

/// Of an answer: number of the owner's next write; all before it were executed, or dropped during a fault.
pub const fn next(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[2]
}

/// Of an answer: a stop has been triggered; segments and starts are dropped until a clear.
pub const fn fault(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] & 1 == 1
}

/// Of an answer: the drivers have had power for the enable time, as a start requires.
pub const fn ready(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] >> 1 & 1 == 1
}

/// Of an answer: a start is armed; another start is refused as busy.
pub const fn armed(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] >> 2 & 1 == 1
}

/// Of an answer: the request was a write; a read of the same address has 0 here.
pub const fn written(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] >> 3 & 1 == 1
}

/// Of an answer: the last CUT was refused; always 1 in a build without cuts.
pub const fn cut_refused(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] >> 4 & 1 == 1
}

/// Of an answer: no axis moves, no queue holds a segment, and no start is armed.
pub const fn idle(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] >> 6 & 1 == 1
}

/// Of an answer: the stop is complete: no axis moves any more.
pub const fn halted(answer: &[u8; ANSWER_BYTES]) -> bool {
    answer[3] >> 7 & 1 == 1
}

/// Of an answer: number of segments for which the queue of the addressed axis has room; of SEGMENTS the least of its axes.
pub const fn free(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[4]
}

/// Of an answer: the axes that caused overrun, overspeed, limit or underrun, one bit each; else 0.
pub const fn culprits(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[5]
}

/// Of an answer: the axes that wait for the source of their seek, one bit each.
pub const fn seeking(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[6]
}

/// Of an answer: the cause of the stop, if `fault` is set; otherwise 0.
pub const fn cause(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[7] & 15
}

/// Of an answer: why the request was refused; 0 if it was not.
pub const fn reason(answer: &[u8; ANSWER_BYTES]) -> u8 {
    answer[7] >> 4
}


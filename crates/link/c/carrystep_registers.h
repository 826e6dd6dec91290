/* The protocol between the gateware and its hosts: constants, the register map, and the fields of
 * an answer.
 *
 * This file is generated from crates/core/src/link by `cargo xtask generate`: change that source
 * instead. */
#ifndef CARRYSTEP_REGISTERS_H
#define CARRYSTEP_REGISTERS_H

#include <stdint.h>

/* Byte that begins and ends a frame. */
#define CARRYSTEP_END 0xc0u
/* Escape byte: with the next byte it stands for END or ESC in a frame. */
#define CARRYSTEP_ESC 0xdbu
/* After ESC: the pair stands for END. */
#define CARRYSTEP_ESC_END 0xdcu
/* After ESC: the pair stands for ESC. */
#define CARRYSTEP_ESC_ESC 0xddu
/* Polynomial of the CRC-32 of Ethernet and zlib, reflected. */
#define CARRYSTEP_CRC_POLYNOMIAL UINT32_C(0xedb88320)
/* Value of the CRC register, before its inversion, after a frame and its CRC. */
#define CARRYSTEP_CRC_RESIDUE UINT32_C(0xdebb20e3)
/* Length of a CRC in bytes. */
#define CARRYSTEP_CRC_BYTES 4u
/* Bit that the address of every write has. */
#define CARRYSTEP_WRITE 0x80u
/* Length of the sequence number and the address of a request in bytes. */
#define CARRYSTEP_REQUEST_HEAD 2u
/* Length of the session number in a request in bytes. */
#define CARRYSTEP_SESSION_BYTES 2u
/* Number of words of a SEGMENT frame, the commit included. */
#define CARRYSTEP_SEGMENT_FRAME_WORDS 8u
/* Number of words of a SEGMENTS frame before its axes: the mask, and ticks - 1. */
#define CARRYSTEP_SEGMENTS_HEAD_WORDS 2u
/* Number of words for each axis of a SEGMENTS frame: V, A, J. */
#define CARRYSTEP_SEGMENTS_AXIS_WORDS 6u
/* Length of the longest request (SEGMENTS for eight axes) in bytes, without END and ESC. */
#define CARRYSTEP_LONGEST_REQUEST 212u
/* Length of an answer in bytes, without END and ESC. */
#define CARRYSTEP_ANSWER_BYTES 16u
/* Number of the first data byte in an answer. */
#define CARRYSTEP_ANSWER_DATA 8u
/* Number of writes that may be unacknowledged, and by which a repeated one may lie behind. */
#define CARRYSTEP_WINDOW 0x7fu
/* Value of the register IDENTITY. */
#define CARRYSTEP_IDENTITY_VALUE UINT32_C(0x50545343)
/* Version of the protocol to which this register map belongs. */
#define CARRYSTEP_PROTOCOL_VERSION UINT32_C(0x00000002)
/* Bit of CONTROL: power the drivers. */
#define CARRYSTEP_CONTROL_ENABLE UINT32_C(0x00000001)
/* Bit of OPEN: stop all axes if the gateware is busy. */
#define CARRYSTEP_OPEN_FORCE UINT32_C(0x00000001)
/* Lowest address at which a register of an axis is read. */
#define CARRYSTEP_AXES_AT 0x10u
/* Bits of STATUS: the slot of the running segment. */
#define CARRYSTEP_STATUS_SLOT UINT32_C(0x0000001f)
/* Bit of STATUS: the axis runs a segment. */
#define CARRYSTEP_STATUS_RUNS UINT32_C(0x00000020)
/* Bits of STATUS: the number of segments that wait. */
#define CARRYSTEP_STATUS_WAITING UINT32_C(0x000007c0)
/* Bits of STATUS: the number of steps on their way, two's complement. */
#define CARRYSTEP_STATUS_ON_WAY UINT32_C(0x0000f000)
/* Greatest number of axes of a build. */
#define CARRYSTEP_MOST_AXES 0x08u
/* Number of segments that can wait for an axis of any build, besides the one that runs. */
#define CARRYSTEP_LEAST_QUEUE 0x07u

/* The register map. The address of a register of an axis is CARRYSTEP_OF_AXIS(register, axis). */
#define CARRYSTEP_OF_AXIS(register, axis) ((register) + (axis))

/* The bytes of "CSTP", low byte first, which identify carrystep (read) */
#define CARRYSTEP_IDENTITY 0x00u
/* Version of the protocol (read) */
#define CARRYSTEP_PROTOCOL 0x01u
/* Build id, low half: a hash of register map and build parameters, for hosts to compare (read) */
#define CARRYSTEP_BUILD_LOW 0x02u
/* Build id, high half (read) */
#define CARRYSTEP_BUILD_HIGH 0x03u
/* Number of axes (read) */
#define CARRYSTEP_AXIS_COUNT 0x04u
/* Frequency of the clock in Hz (read) */
#define CARRYSTEP_CLOCK_HZ 0x05u
/* Length of a tick in ns (read) */
#define CARRYSTEP_TICK_NS 0x06u
/* Number of phases in a tick (read) */
#define CARRYSTEP_PHASES 0x07u
/* Ticks without a frame of the owner after which all axes are stopped; 0: no watchdog (read) */
#define CARRYSTEP_WATCHDOG_TICKS 0x08u
/* Byte 0: the axes that have hit the source of their seek, one bit each, until the seek is ended; byte 1: bits 3..0 further edges since latch 0 was armed, bit 4 it is armed (read) */
#define CARRYSTEP_CAPTURES 0x09u
/* Debounced states of the switches, 1 active, a byte for each row: limits at low ends, at high ends, inputs of row 2 (bit 0: probe) and of row 3 (bit 0: interlock) (read) */
#define CARRYSTEP_INPUTS 0x0au
/* Levels of the same pins, 1 active, when they were sampled last (read) */
#define CARRYSTEP_INPUT_LEVELS 0x0bu
/* Number of segments that can wait for an axis, besides the one that runs: 7, 15 or 31 (read) */
#define CARRYSTEP_QUEUE_DEPTH 0x0cu
/* Only in a build with several latches, else 0; a bit for each latch: 3..0 it is armed, 7..4 the build has it; 15..8 the record of each, 2 bits each; 31..16 further edges since it was armed, 4 bits each; latch 0 lowest (read) */
#define CARRYSTEP_LATCHES 0x0du
/* Limit at the low end: bit 7 its debounced state, bit 6 the level of its pin, 1 active; the other bits have no meaning (read, axis 0) */
#define CARRYSTEP_LIMIT_MIN_SWITCH 0x10u
/* Limit at the high end, likewise (read, axis 0) */
#define CARRYSTEP_LIMIT_MAX_SWITCH 0x50u
/* Input of row 2 in the time slot of this axis, likewise; of axis 0 it is the probe (read, axis 0) */
#define CARRYSTEP_INPUT_0_SWITCH 0x90u
/* Input of row 3 in the time slot of this axis, likewise; of axis 0 it is the interlock (read, axis 0) */
#define CARRYSTEP_INPUT_1_SWITCH 0xd0u
/* TICKS at the hit of a seek (read, axis 0) */
#define CARRYSTEP_SEEK_TICKS 0x18u
/* P in the tick after the hit of a seek, low half (read, axis 0) */
#define CARRYSTEP_SEEK_P_LOW 0x20u
/* P at the hit, high half (read, axis 0) */
#define CARRYSTEP_SEEK_P_HIGH 0x28u
/* POSITION at the hit (read, axis 0) */
#define CARRYSTEP_SEEK_POSITION 0x30u
/* STATUS at the hit (read, axis 0) */
#define CARRYSTEP_SEEK_STATUS 0x38u
/* Number of steps that freezes have discarded since configuration (read, axis 0) */
#define CARRYSTEP_DISCARDED 0x40u
/* Ticks of the running segment after the next one; no meaning while the axis does not run (read, axis 0) */
#define CARRYSTEP_LEFT 0x48u
/* Number of ticks since configuration, modulo 2^32; the same for all axes (read, axis 0) */
#define CARRYSTEP_TICKS 0x58u
/* P, the fraction of a step in units of 2^-64 step, low half (read, axis 0) */
#define CARRYSTEP_P_LOW 0x60u
/* P, high half (read, axis 0) */
#define CARRYSTEP_P_HIGH 0x68u
/* Position: steps forward minus steps backward, two's complement (read, axis 0) */
#define CARRYSTEP_POSITION 0x70u
/* Bits 4..0: slot of the running segment; 5: runs; 10..6: segments that wait; 15..12: steps on their way, two's complement; the other bits have no meaning (read, axis 0) */
#define CARRYSTEP_STATUS 0x78u
/* DISCARDED in the tick of the snapshot; no meaning if the axis ran (read, axis 0) */
#define CARRYSTEP_SNAPSHOT_DISCARDED 0x80u
/* LEFT in the tick of the snapshot; no meaning if the axis did not run (read, axis 0) */
#define CARRYSTEP_SNAPSHOT_LEFT 0x88u
/* TICKS of the snapshot; the same for all axes (read, axis 0) */
#define CARRYSTEP_SNAPSHOT_TICKS 0x98u
/* P in that tick, low half (read, axis 0) */
#define CARRYSTEP_SNAPSHOT_P_LOW 0xa0u
/* P in that tick, high half (read, axis 0) */
#define CARRYSTEP_SNAPSHOT_P_HIGH 0xa8u
/* POSITION in that tick (read, axis 0) */
#define CARRYSTEP_SNAPSHOT_POSITION 0xb0u
/* STATUS in that tick (read, axis 0) */
#define CARRYSTEP_SNAPSHOT_STATUS 0xb8u
/* DISCARDED in the tick of the chosen latch; no meaning if the axis ran (read, axis 0) */
#define CARRYSTEP_LATCH_DISCARDED 0xc0u
/* LEFT in the tick of the chosen latch; no meaning if the axis did not run (read, axis 0) */
#define CARRYSTEP_LATCH_LEFT 0xc8u
/* TICKS of the chosen latch; the same for all axes (read, axis 0) */
#define CARRYSTEP_LATCH_TICKS 0xd8u
/* P in that tick, low half (read, axis 0) */
#define CARRYSTEP_LATCH_P_LOW 0xe0u
/* P in that tick, high half (read, axis 0) */
#define CARRYSTEP_LATCH_P_HIGH 0xe8u
/* POSITION in that tick (read, axis 0) */
#define CARRYSTEP_LATCH_POSITION 0xf0u
/* STATUS in that tick (read, axis 0) */
#define CARRYSTEP_LATCH_STATUS 0xf8u
/* Bit 0: power the drivers (write) */
#define CARRYSTEP_CONTROL 0x20u
/* Axes, one bit each, to start together once all rest; an empty queue: fault (protocol) (write) */
#define CARRYSTEP_START 0x21u
/* Any value ends a complete stop: queues empty, P at its start value, position kept (write) */
#define CARRYSTEP_CLEAR 0x22u
/* Byte 0: the axes that wait for a source, one bit each, 0 ends the seek; byte 1: the source, axis of the switch in bits 2..0, row in 4..3, own switch of each axis in 5, state that is the hit in 6 (write) */
#define CARRYSTEP_SEEK 0x23u
/* Any value: the SNAPSHOT_ registers take the state of all axes in one and the same tick (write) */
#define CARRYSTEP_SNAPSHOT 0x24u
/* Makes the session number of this frame the owner; bit 0: stop all axes if it is busy (write) */
#define CARRYSTEP_OPEN 0x25u
/* Any value stops all axes, each with its ramp; executed for every host (write) */
#define CARRYSTEP_STOP 0x26u
/* One latch: any value arms it, so that its next edge latches the state of all axes; several: bits 3..0 arm these latches, 5..4 choose the one whose record LATCH_ registers show (write) */
#define CARRYSTEP_LATCH 0x27u
/* Ticks - 1; V, A, J in 2^-64 step per tick, tick^2, tick^3, low half first; 1 if last of its move, else 0 (write, 8 words, axis 0) */
#define CARRYSTEP_SEGMENT 0x40u
/* Axes, one bit each; ticks - 1; V, A, J of each of these axes in ascending order, low half first; 1 if last of their move, else 0 (write, 3 words and 6 for each axis) */
#define CARRYSTEP_SEGMENTS 0x48u
/* A word for each axis from 0 to 7: bits 4..0 the slot of the last segment that it keeps; bits 31..24 are 0 if the axis takes no part (write, 8 words) */
#define CARRYSTEP_CUT 0x50u

/* The causes of a stop, by their number in the field `cause` of an answer. */
#define CARRYSTEP_CAUSE_ESTOP 0u
#define CARRYSTEP_CAUSE_OVERRUN 1u
#define CARRYSTEP_CAUSE_PROTOCOL 2u
#define CARRYSTEP_CAUSE_WATCHDOG 3u
#define CARRYSTEP_CAUSE_OVERSPEED 4u
#define CARRYSTEP_CAUSE_LIMIT 5u
#define CARRYSTEP_CAUSE_UNDERRUN 6u
#define CARRYSTEP_CAUSE_STOP 7u
#define CARRYSTEP_CAUSE_INTERLOCK 8u

/* The reasons of a refusal, by their number in the field `reason` of an answer; 0: not refused. */

/* A write before this one was lost: its number is not `next`. */
#define CARRYSTEP_REASON_SEQUENCE 1u
/* The request cannot be executed now: try again. */
#define CARRYSTEP_REASON_BUSY 2u
/* The request does not have the session number of the gateware's owner. */
#define CARRYSTEP_REASON_SESSION 3u
/* An axis that it names has hit the source of its seek, and the host has not ended the seek. */
#define CARRYSTEP_REASON_SEEK_ENDED 4u
/* A segment that the CUT names neither waits nor runs any more: no axis has dropped any. */
#define CARRYSTEP_REASON_CUT 5u

/* The fields of an answer, in which the bytes END and ESC of the frame have been decoded. */

/* the sequence number of the request */
#define CARRYSTEP_ANSWER_SEQUENCE(answer) ((uint8_t)((answer)[0] >> 0 & 255u))
/* the address of the request */
#define CARRYSTEP_ANSWER_ADDRESS(answer) ((uint8_t)((answer)[1] >> 0 & 255u))
/* number of the owner's next write; all before it were executed, or dropped during a fault */
#define CARRYSTEP_ANSWER_NEXT(answer) ((uint8_t)((answer)[2] >> 0 & 255u))
/* a stop has been triggered; segments and starts are dropped until a clear */
#define CARRYSTEP_ANSWER_FAULT(answer) ((uint8_t)((answer)[3] >> 0 & 1u))
/* the drivers have had power for the enable time, as a start requires */
#define CARRYSTEP_ANSWER_READY(answer) ((uint8_t)((answer)[3] >> 1 & 1u))
/* a start is armed; another start is refused as busy */
#define CARRYSTEP_ANSWER_ARMED(answer) ((uint8_t)((answer)[3] >> 2 & 1u))
/* the request was a write; a read of the same address has 0 here */
#define CARRYSTEP_ANSWER_WRITTEN(answer) ((uint8_t)((answer)[3] >> 3 & 1u))
/* the last CUT was refused; always 1 in a build without cuts */
#define CARRYSTEP_ANSWER_CUT_REFUSED(answer) ((uint8_t)((answer)[3] >> 4 & 1u))
/* no axis moves, no queue holds a segment, and no start is armed */
#define CARRYSTEP_ANSWER_IDLE(answer) ((uint8_t)((answer)[3] >> 6 & 1u))
/* the stop is complete: no axis moves any more */
#define CARRYSTEP_ANSWER_HALTED(answer) ((uint8_t)((answer)[3] >> 7 & 1u))
/* number of segments for which the queue of the addressed axis has room; of SEGMENTS the least of its axes */
#define CARRYSTEP_ANSWER_FREE(answer) ((uint8_t)((answer)[4] >> 0 & 255u))
/* the axes that caused overrun, overspeed, limit or underrun, one bit each; else 0 */
#define CARRYSTEP_ANSWER_CULPRITS(answer) ((uint8_t)((answer)[5] >> 0 & 255u))
/* the axes that wait for the source of their seek, one bit each */
#define CARRYSTEP_ANSWER_SEEKING(answer) ((uint8_t)((answer)[6] >> 0 & 255u))
/* the cause of the stop, if `fault` is set; otherwise 0 */
#define CARRYSTEP_ANSWER_CAUSE(answer) ((uint8_t)((answer)[7] >> 0 & 15u))
/* why the request was refused; 0 if it was not */
#define CARRYSTEP_ANSWER_REASON(answer) ((uint8_t)((answer)[7] >> 4 & 15u))

#endif

/* The protocol between the gateware and its hosts: constants, the register map, and the fields of
 * an answer.
 *
 * This file is generated from crates/core/src/link by `cargo xtask generate`: change that source
 * instead. */
#ifndef CARRYSTEP_REGISTERS_H
#define CARRYSTEP_REGISTERS_H

#include <stdint.h>

/* Ends a frame, and begins one. */
#define CARRYSTEP_END 0xc0u
/* Says that the next byte stands for another. */
#define CARRYSTEP_ESC 0xdbu
/* After ESC: END. */
#define CARRYSTEP_ESC_END 0xdcu
/* After ESC: ESC. */
#define CARRYSTEP_ESC_ESC 0xddu
/* CRC-32 of Ethernet and zlib, reflected: polynomial. */
#define CARRYSTEP_CRC_POLYNOMIAL UINT32_C(0xedb88320)
/* What its register holds, not yet inverted, after a frame and its CRC. */
#define CARRYSTEP_CRC_RESIDUE UINT32_C(0xdebb20e3)
/* Bytes of a CRC. */
#define CARRYSTEP_CRC_BYTES 4u
/* Set in an address: the frame writes. */
#define CARRYSTEP_WRITE 0x80u
/* Sequence and address. */
#define CARRYSTEP_REQUEST_HEAD 2u
/* Words of a segment, the commit included. */
#define CARRYSTEP_SEGMENT_FRAME_WORDS 8u
/* The longest request, without END and ESC. */
#define CARRYSTEP_LONGEST_REQUEST 38u
/* An answer, without END and ESC. */
#define CARRYSTEP_ANSWER_BYTES 15u
/* First byte of an answer's data. */
#define CARRYSTEP_ANSWER_DATA 7u
/* Frames by which a repeated one may lie behind the next; so many may be on their way. */
#define CARRYSTEP_WINDOW 0x7fu
/* What IDENTITY holds. */
#define CARRYSTEP_IDENTITY_VALUE UINT32_C(0x50545343)
/* The version of the protocol that this map belongs to. */
#define CARRYSTEP_PROTOCOL_VERSION UINT32_C(0x00000001)
/* In CONTROL: power the drivers. */
#define CARRYSTEP_CONTROL_ENABLE UINT32_C(0x00000001)
/* In CONTROL: stop all axes. */
#define CARRYSTEP_CONTROL_STOP UINT32_C(0x00000002)
/* First address of the axes. */
#define CARRYSTEP_AXES_AT 0x40u
/* Addresses of each axis. */
#define CARRYSTEP_PER_AXIS 0x08u
/* Most axes of a build. */
#define CARRYSTEP_MOST_AXES 0x08u
/* Segments that can wait for an axis, beside the one that runs. */
#define CARRYSTEP_QUEUE_SEGMENTS 0x07u

/* The register map. The address of a register of an axis is CARRYSTEP_OF_AXIS(register, axis). */
#define CARRYSTEP_OF_AXIS(register, axis) ((register) + CARRYSTEP_PER_AXIS * (axis))

/* "CSTP", low byte first: this is carrystep (read) */
#define CARRYSTEP_IDENTITY 0x00u
/* version of this protocol (read) */
#define CARRYSTEP_PROTOCOL 0x01u
/* build id, low half: a hash of this map and of all build parameters (read) */
#define CARRYSTEP_BUILD_LOW 0x02u
/* build id, high half (read) */
#define CARRYSTEP_BUILD_HIGH 0x03u
/* axes of this build (read) */
#define CARRYSTEP_AXIS_COUNT 0x04u
/* clock, Hz (read) */
#define CARRYSTEP_CLOCK_HZ 0x05u
/* tick, ns (read) */
#define CARRYSTEP_TICK_NS 0x06u
/* phases of a tick (read) */
#define CARRYSTEP_PHASES 0x07u
/* ticks of silence after which the axes are stopped; 0: never (read) */
#define CARRYSTEP_WATCHDOG_TICKS 0x08u
/* bit 0: power the drivers; bit 1: stop all axes by their ramps (write) */
#define CARRYSTEP_CONTROL 0x20u
/* axes that start together, a bit each, on the first tick at which all rest and have a segment (write) */
#define CARRYSTEP_START 0x21u
/* resume after a stop, whatever is written: queues empty, P at its start; the position stays (write) */
#define CARRYSTEP_CLEAR 0x22u
/* axes, a bit each, whose next limit latches their position and stops only them (write) */
#define CARRYSTEP_HOME 0x23u
/* fraction of a step, low half, 2^-64 step (read, axis 0) */
#define CARRYSTEP_P_LOW 0x40u
/* fraction of a step, high half (read, axis 0) */
#define CARRYSTEP_P_HIGH 0x41u
/* steps forward less steps back, two's complement (read, axis 0) */
#define CARRYSTEP_POSITION 0x42u
/* steps that freezes have discarded (read, axis 0) */
#define CARRYSTEP_DISCARDED 0x43u
/* position when the limit was reached in homing (read, axis 0) */
#define CARRYSTEP_LATCHED 0x44u
/* ticks - 1, V, A, J (low half first, 2^-64 step per tick^1, 2, 3), then 1 where it is the last of its move (write, 8 words, axis 0) */
#define CARRYSTEP_SEGMENT 0x40u

/* The causes of a stop, by their number in the field `cause` of an answer. */
#define CARRYSTEP_CAUSE_ESTOP 0u
#define CARRYSTEP_CAUSE_OVERRUN 1u
#define CARRYSTEP_CAUSE_PROTOCOL 2u
#define CARRYSTEP_CAUSE_WATCHDOG 3u
#define CARRYSTEP_CAUSE_OVERSPEED 4u
#define CARRYSTEP_CAUSE_LIMIT 5u
#define CARRYSTEP_CAUSE_UNDERRUN 6u
#define CARRYSTEP_CAUSE_STOP 7u

/* The fields of an answer, in which the bytes END and ESC of the frame have been decoded. */

/* the request's sequence number */
#define CARRYSTEP_ANSWER_SEQUENCE(answer) ((uint8_t)((answer)[0] >> 0 & 255u))
/* the request's address */
#define CARRYSTEP_ANSWER_ADDRESS(answer) ((uint8_t)((answer)[1] >> 0 & 255u))
/* the sequence number that the next write must have: all before it have been executed */
#define CARRYSTEP_ANSWER_NEXT(answer) ((uint8_t)((answer)[2] >> 0 & 255u))
/* a stop has been called; segments and starts are dropped until a clear */
#define CARRYSTEP_ANSWER_FAULT(answer) ((uint8_t)((answer)[3] >> 0 & 1u))
/* the stop is over: no axis moves any more */
#define CARRYSTEP_ANSWER_HALTED(answer) ((uint8_t)((answer)[3] >> 1 & 1u))
/* all axes are done, and no start is armed */
#define CARRYSTEP_ANSWER_IDLE(answer) ((uint8_t)((answer)[3] >> 2 & 1u))
/* the drivers have had power for long enough: starts are taken */
#define CARRYSTEP_ANSWER_READY(answer) ((uint8_t)((answer)[3] >> 3 & 1u))
/* a start waits; another is refused as busy */
#define CARRYSTEP_ANSWER_ARMED(answer) ((uint8_t)((answer)[3] >> 4 & 1u))
/* why, where there is a fault */
#define CARRYSTEP_ANSWER_CAUSE(answer) ((uint8_t)((answer)[3] >> 5 & 7u))
/* segments that the addressed axis still takes */
#define CARRYSTEP_ANSWER_FREE(answer) ((uint8_t)((answer)[4] >> 0 & 7u))
/* this write was not executed: out of sequence, or busy */
#define CARRYSTEP_ANSWER_REFUSED(answer) ((uint8_t)((answer)[4] >> 3 & 1u))
/* where there is a fault: the axes that it came from */
#define CARRYSTEP_ANSWER_CULPRITS(answer) ((uint8_t)((answer)[5] >> 0 & 255u))
/* axes that still wait for their limit */
#define CARRYSTEP_ANSWER_HOMING(answer) ((uint8_t)((answer)[6] >> 0 & 255u))

#endif

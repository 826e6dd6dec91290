//! The register map. The gateware's address decoder, the constants in Rust and C, and
//! docs/registers.md are generated from this table: run `cargo xtask generate` after a change.
//!
//! ```text
//! reads     0x00 .. 0x0f   facts of the build, and what the link program puts together; the
//!                          identity comes first in every version
//!           0x10 .. 0xff   the state of the axes: page 2 | item 3 | axis 3 (engine/state.rs)
//! writes    0xa0 .. 0xbf   commands of the host, one word each
//!           0xc0 .. 0xc7   segments: 0xc0 + axis, eight words
//!           0xc8           segments of several axes
//!           0xd0           a cut, eight words
//! ```
//!
//! A request without words reads, a request with words writes, so that the same address can be a
//! register of either kind.

use crate::engine::StateItem::{self, Discarded, Left, PHigh, PLow, Position, Status, Ticks};
use crate::engine::StatePage::{self as Page, Live, Seek, Snapshot};
use crate::engine::{MAX_AXES, QUEUE_DEPTHS, state_address};
use strum::Display;

/// Access to a register. It is displayed as in the documentation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Display)]
#[strum(serialize_all = "lowercase")]
pub enum RegisterAccess {
    /// Read only.
    Read,
    /// Written with one word.
    Write,
    /// Written with the eight words of a segment in one frame.
    #[strum(to_string = "write, 8 words")]
    WriteSegment,
    /// Written with a word for each of [`MAX_AXES`] axes in one frame.
    #[strum(to_string = "write, 8 words")]
    WriteCut,
    /// Written with the segments of several axes in one frame.
    #[strum(to_string = "write, 3 words and 6 for each axis")]
    WriteSegments,
}

impl RegisterAccess {
    /// True if the register is read.
    pub const fn is_read(self) -> bool {
        matches!(self, Self::Read)
    }
}

/// One row of the register map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MappedRegister {
    /// Name of the register; the name of its constant in Rust and C.
    pub name: &'static str,
    /// Address. For a register of an axis, the address for axis 0; each further axis adds one.
    pub address: u8,
    /// Access.
    pub access: RegisterAccess,
    /// Whether each axis has one.
    pub per_axis: bool,
    /// Content, with its unit.
    pub what: &'static str,
}

/// Declares each register once: a constant with its address, and its row of the map.
macro_rules! registers {
    ($($name:ident = $address:expr, $access:ident $per_axis:literal $what:literal;)*) => {
        $(#[doc = $what] pub const $name: u8 = $address;)*

        /// The register map: what is read, then what is written, in the order of addresses.
        pub const REGISTERS: &[MappedRegister] = &[$(MappedRegister {
            name: stringify!($name),
            address: $address,
            access: RegisterAccess::$access,
            per_axis: $per_axis,
            what: $what,
        }),*];
    };
}

registers! {
    IDENTITY     = 0x00, Read false
        "The bytes of \"CSTP\", low byte first, which identify carrystep";
    PROTOCOL     = 0x01, Read false "Version of the protocol";
    BUILD_LOW    = 0x02, Read false
        "Build id, low half: a hash of register map and build parameters, for hosts to compare";
    BUILD_HIGH   = 0x03, Read false "Build id, high half";
    AXIS_COUNT   = 0x04, Read false "Number of axes";
    CLOCK_HZ     = 0x05, Read false "Frequency of the clock in Hz";
    TICK_NS      = 0x06, Read false "Length of a tick in ns";
    PHASES       = 0x07, Read false "Number of phases in a tick";
    WATCHDOG_TICKS = 0x08, Read false
        "Ticks without a frame of the owner after which all axes are stopped; 0: no watchdog";
    CAPTURES     = 0x09, Read false
        "Byte 0: the axes that have hit the source of their seek, one bit each, until the seek is \
         ended; byte 1: bits 3..0 further edges since latch 0 was armed, bit 4 it is armed";
    INPUTS       = 0x0a, Read false
        "Debounced states of the switches, 1 active, a byte for each row: limits at low ends, at \
         high ends, inputs of row 2 (bit 0: probe) and of row 3 (bit 0: interlock)";
    INPUT_LEVELS = 0x0b, Read false
        "Levels of the same pins, 1 active, when they were sampled last";
    QUEUE_DEPTH  = 0x0c, Read false
        "Number of segments that can wait for an axis, besides the one that runs: 7, 15 or 31";
    LATCHES      = 0x0d, Read false
        "Only in a build with several latches, else 0; a bit for each latch: 3..0 it is armed, 7..4 \
         the build has it; 15..8 the record of each, 2 bits each; 31..16 further edges since it was \
         armed, 4 bits each; latch 0 lowest";
    LIMIT_MIN_SWITCH = switch_address(0), Read true
        "Limit at the low end: bit 7 its debounced state, bit 6 the level of its pin, 1 active; \
         the other bits have no meaning";
    LIMIT_MAX_SWITCH = switch_address(1), Read true "Limit at the high end, likewise";
    INPUT_0_SWITCH = switch_address(2), Read true
        "Input of row 2 in the time slot of this axis, likewise; of axis 0 it is the probe";
    INPUT_1_SWITCH = switch_address(3), Read true
        "Input of row 3 in the time slot of this axis, likewise; of axis 0 it is the interlock";
    SEEK_TICKS   = state_address(Seek, Ticks), Read true "TICKS at the hit of a seek";
    SEEK_P_LOW   = state_address(Seek, PLow), Read true
        "P in the tick after the hit of a seek, low half";
    SEEK_P_HIGH  = state_address(Seek, PHigh), Read true "P at the hit, high half";
    SEEK_POSITION = state_address(Seek, Position), Read true "POSITION at the hit";
    SEEK_STATUS  = state_address(Seek, Status), Read true "STATUS at the hit";
    DISCARDED    = state_address(Live, Discarded), Read true
        "Number of steps that freezes have discarded since configuration";
    LEFT         = state_address(Live, Left), Read true
        "Ticks of the running segment after the next one; no meaning while the axis does not run";
    TICKS        = state_address(Live, Ticks), Read true
        "Number of ticks since configuration, modulo 2^32; the same for all axes";
    P_LOW        = state_address(Live, PLow), Read true
        "P, the fraction of a step in units of 2^-64 step, low half";
    P_HIGH       = state_address(Live, PHigh), Read true "P, high half";
    POSITION     = state_address(Live, Position), Read true
        "Position: steps forward minus steps backward, two's complement";
    STATUS       = state_address(Live, Status), Read true
        "Bits 4..0: slot of the running segment; 5: runs; 10..6: segments that wait; 15..12: steps \
         on their way, two's complement; the other bits have no meaning";
    SNAPSHOT_DISCARDED = state_address(Snapshot, Discarded), Read true
        "DISCARDED in the tick of the snapshot; no meaning if the axis ran";
    SNAPSHOT_LEFT = state_address(Snapshot, Left), Read true
        "LEFT in the tick of the snapshot; no meaning if the axis did not run";
    SNAPSHOT_TICKS = state_address(Snapshot, Ticks), Read true
        "TICKS of the snapshot; the same for all axes";
    SNAPSHOT_P_LOW = state_address(Snapshot, PLow), Read true "P in that tick, low half";
    SNAPSHOT_P_HIGH = state_address(Snapshot, PHigh), Read true "P in that tick, high half";
    SNAPSHOT_POSITION = state_address(Snapshot, Position), Read true "POSITION in that tick";
    SNAPSHOT_STATUS = state_address(Snapshot, Status), Read true "STATUS in that tick";
    LATCH_DISCARDED = state_address(Page::Latch, Discarded), Read true
        "DISCARDED in the tick of the chosen latch; no meaning if the axis ran";
    LATCH_LEFT   = state_address(Page::Latch, Left), Read true
        "LEFT in the tick of the chosen latch; no meaning if the axis did not run";
    LATCH_TICKS  = state_address(Page::Latch, Ticks), Read true
        "TICKS of the chosen latch; the same for all axes";
    LATCH_P_LOW  = state_address(Page::Latch, PLow), Read true "P in that tick, low half";
    LATCH_P_HIGH = state_address(Page::Latch, PHigh), Read true "P in that tick, high half";
    LATCH_POSITION = state_address(Page::Latch, Position), Read true "POSITION in that tick";
    LATCH_STATUS = state_address(Page::Latch, Status), Read true "STATUS in that tick";
    CONTROL      = 0x20, Write false
        "Bit 0: power the drivers";
    START        = 0x21, Write false
        "Axes, one bit each, to start together once all rest; an empty queue: fault (protocol)";
    CLEAR        = 0x22, Write false
        "Any value ends a complete stop: queues empty, P at its start value, position kept";
    SEEK         = 0x23, Write false
        "Byte 0: the axes that wait for a source, one bit each, 0 ends the seek; byte 1: the \
         source, axis of the switch in bits 2..0, row in 4..3, own switch of each axis in 5, state \
         that is the hit in 6";
    SNAPSHOT     = 0x24, Write false
        "Any value: the SNAPSHOT_ registers take the state of all axes in one and the same tick";
    OPEN         = 0x25, Write false
        "Makes the session number of this frame the owner; bit 0: stop all axes if it is busy";
    STOP         = 0x26, Write false
        "Any value stops all axes, each with its ramp; executed for every host";
    LATCH        = 0x27, Write false
        "One latch: any value arms it, so that its next edge latches the state of all axes; several: \
         bits 3..0 arm these latches, 5..4 choose the one whose record LATCH_ registers show";
    SEGMENT      = 0x40, WriteSegment true
        "Ticks - 1; V, A, J in 2^-64 step per tick, tick^2, tick^3, low half first; 1 if last of \
         its move, else 0";
    SEGMENTS     = 0x48, WriteSegments false
        "Axes, one bit each; ticks - 1; V, A, J of each of these axes in ascending order, low half \
         first; 1 if last of their move, else 0";
    CUT          = 0x50, WriteCut false
        "A word for each axis from 0 to 7: bits 4..0 the slot of the last segment that it keeps; \
         bits 31..24 are 0 if the axis takes no part";
}

super::constants! {
    IDENTITY_VALUE: u32 = u32::from_le_bytes(*b"CSTP"), "Value of the register IDENTITY.";
    PROTOCOL_VERSION: u32 = 2, "Version of the protocol to which this register map belongs.";
    CONTROL_ENABLE: u32 = 1 << 0, "Bit of CONTROL: power the drivers.";
    OPEN_FORCE: u32 = 1 << 0, "Bit of OPEN: stop all axes if the gateware is busy.";
    AXES_AT: u8 = LIMIT_MIN_SWITCH, "Lowest address at which a register of an axis is read.";
    STATUS_SLOT: u32 = 0x1f, "Bits of STATUS: the slot of the running segment.";
    STATUS_RUNS: u32 = 1 << 5, "Bit of STATUS: the axis runs a segment.";
    STATUS_WAITING: u32 = 0x1f << 6, "Bits of STATUS: the number of segments that wait.";
    STATUS_ON_WAY: u32 = 0xf << 12,
        "Bits of STATUS: the number of steps on their way, two's complement.";
    MOST_AXES: u8 = MAX_AXES as u8, "Greatest number of axes of a build.";
    LEAST_QUEUE: u8 = QUEUE_DEPTHS[0] as u8,
        "Number of segments that can wait for an axis of any build, besides the one that runs.";
}

/// Address of the word of the switch of axis 0 in this row.
pub(super) const fn switch_address(row: u8) -> u8 {
    state_address(Page::of_number(row), StateItem::Switch)
}

/// The address of a register of an axis.
///
/// ```
/// use carrystep_core::link::registers::{POSITION, of_axis};
/// assert_eq!(of_axis(POSITION, 3), 0x73);
/// ```
pub const fn of_axis(register: u8, axis: u8) -> u8 {
    register + axis
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::AxisStatus;

    #[test]
    fn addresses_are_unique_per_access() {
        for (index, one) in REGISTERS.iter().enumerate() {
            for other in &REGISTERS[..index] {
                let reads = |register: &MappedRegister| register.access == RegisterAccess::Read;
                assert!(
                    one.address != other.address || reads(one) != reads(other),
                    "{} {}",
                    one.name,
                    other.name
                );
            }
        }
    }

    #[test]
    fn bits_of_status_are_those_of_the_engine() {
        let status = AxisStatus { slot: 31, ..AxisStatus::default() };
        assert_eq!(status.word(), STATUS_SLOT);
        let status = AxisStatus { running: true, ..AxisStatus::default() };
        assert_eq!(status.word(), STATUS_RUNS);
        let status = AxisStatus { waiting: 31, ..AxisStatus::default() };
        assert_eq!(status.word(), STATUS_WAITING);
        let status = AxisStatus { on_way: -1, ..AxisStatus::default() };
        assert_eq!(status.word(), STATUS_ON_WAY);
    }

    #[test]
    fn registers_of_all_axes_have_addresses_of_their_own() {
        let reads = REGISTERS.iter().filter(|register| register.access == RegisterAccess::Read);
        let mut addresses: alloc::vec::Vec<u8> = reads
            .flat_map(|register| {
                let axes = if register.per_axis { MAX_AXES as u8 } else { 1 };
                (0..axes).map(|axis| of_axis(register.address, axis))
            })
            .collect();
        let count = addresses.len();
        addresses.sort_unstable();
        addresses.dedup();
        assert_eq!(addresses.len(), count);
    }
}

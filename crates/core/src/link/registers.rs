//! The register map. The gateware's address decoder, the constants in Rust and C, and
//! docs/registers.md are generated from this table: run `cargo xtask generate` after a change.
//!
//! ```text
//! 0x00 .. 0x1f   facts of the build, read only; the identity comes first in every version
//! 0x20 .. 0x3f   commands of the host
//! 0x40 .. 0x7f   eight words for each axis: 0x40 + 8 axis + word
//! ```

use crate::engine::{MAX_AXES, QUEUE};
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
}

/// One row of the register map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MappedRegister {
    /// Name of the register; the name of its constant in Rust and C.
    pub name: &'static str,
    /// Address. For a register of an axis, the address for axis 0; each further axis adds eight.
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
    ($($name:ident = $address:literal $access:ident $what:literal;)*) => {
        $(#[doc = $what] pub const $name: u8 = $address;)*

        /// The register map, in the order of addresses.
        pub const REGISTERS: &[MappedRegister] = &[$(MappedRegister {
            name: stringify!($name),
            address: $address,
            access: RegisterAccess::$access,
            per_axis: $address >= AXES_AT,
            what: $what,
        }),*];
    };
}

registers! {
    IDENTITY     = 0x00 Read "The bytes of \"CSTP\", low byte first, which identify carrystep";
    PROTOCOL     = 0x01 Read "Version of the protocol";
    BUILD_LOW    = 0x02 Read
        "Build id, low half: a hash of register map and build parameters, for hosts to compare";
    BUILD_HIGH   = 0x03 Read "Build id, high half";
    AXIS_COUNT   = 0x04 Read "Number of axes";
    CLOCK_HZ     = 0x05 Read "Frequency of the clock in Hz";
    TICK_NS      = 0x06 Read "Length of a tick in ns";
    PHASES       = 0x07 Read "Number of phases in a tick";
    WATCHDOG_TICKS = 0x08 Read
        "Ticks without a valid frame after which all axes are stopped; 0: no watchdog";
    CONTROL      = 0x20 Write "Bit 0: power the drivers; bit 1: stop all axes, each with its ramp";
    START        = 0x21 Write
        "Axes, one bit each, to start together once all rest; an empty queue: fault (protocol)";
    CLEAR        = 0x22 Write
        "Any value ends a complete stop: queues empty, P at its start value, position kept";
    HOME         = 0x23 Write
        "Axes, one bit each: the next limit latches the position and ramps down this axis only";
    P_LOW        = 0x40 Read "P, the fraction of a step in units of 2^-64 step, low half";
    P_HIGH       = 0x41 Read "P, high half";
    POSITION     = 0x42 Read "Position: steps forward minus steps backward, two's complement";
    DISCARDED    = 0x43 Read "Number of steps that freezes have discarded since configuration";
    LATCHED      = 0x44 Read "Position in steps at which the limit was reached in homing";
    SEGMENT      = 0x40 WriteSegment
        "Ticks - 1; V, A, J in 2^-64 step per tick, tick^2, tick^3, low half first; 1 if last of \
         its move, else 0";
}

super::constants! {
    IDENTITY_VALUE: u32 = u32::from_le_bytes(*b"CSTP"), "Value of the register IDENTITY.";
    PROTOCOL_VERSION: u32 = 1, "Version of the protocol to which this register map belongs.";
    CONTROL_ENABLE: u32 = 1 << 0, "Bit of CONTROL: power the drivers.";
    CONTROL_STOP: u32 = 1 << 1, "Bit of CONTROL: stop all axes.";
    AXES_AT: u8 = 0x40, "First address of the axes' registers.";
    PER_AXIS: u8 = 8, "Number of addresses of each axis.";
    MOST_AXES: u8 = MAX_AXES as u8, "Greatest number of axes of a build.";
    QUEUE_SEGMENTS: u8 = QUEUE as u8,
        "Number of segments that can wait for an axis, in addition to the one that runs.";
}

/// The address of a register of an axis.
///
/// ```
/// use carrystep_core::link::registers::{POSITION, of_axis};
/// assert_eq!(of_axis(POSITION, 3), 0x5a);
/// ```
pub const fn of_axis(register: u8, axis: u8) -> u8 {
    register + PER_AXIS * axis
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn registers_of_all_axes_have_addresses() {
        let last = REGISTERS.iter().map(|register| register.address).max().unwrap();
        assert!(last < AXES_AT + PER_AXIS);
        assert!(of_axis(last, MAX_AXES as u8 - 1) < super::super::WRITE);
    }
}

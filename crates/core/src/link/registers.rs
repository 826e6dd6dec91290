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
pub enum Access {
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
pub struct Register {
    /// Name of the register; the name of its constant in Rust and C.
    pub name: &'static str,
    /// Address. For a register of an axis, the address for axis 0; each further axis adds eight.
    pub address: u8,
    /// Access.
    pub access: Access,
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
        pub const REGISTERS: &[Register] = &[$(Register {
            name: stringify!($name),
            address: $address,
            access: Access::$access,
            per_axis: $address >= AXES_AT,
            what: $what,
        }),*];
    };
}

registers! {
    IDENTITY     = 0x00 Read "\"CSTP\", low byte first: this is carrystep";
    PROTOCOL     = 0x01 Read "version of this protocol";
    BUILD_LOW    = 0x02 Read "build id, low half: a hash of this map and of all build parameters";
    BUILD_HIGH   = 0x03 Read "build id, high half";
    AXIS_COUNT   = 0x04 Read "axes of this build";
    CLOCK_HZ     = 0x05 Read "clock, Hz";
    TICK_NS      = 0x06 Read "tick, ns";
    PHASES       = 0x07 Read "phases of a tick";
    WATCHDOG_TICKS = 0x08 Read "ticks of silence after which the axes are stopped; 0: never";
    CONTROL      = 0x20 Write "bit 0: power the drivers; bit 1: stop all axes by their ramps";
    START        = 0x21 Write "axes that start together, a bit each, on the first tick at which all rest and have a segment";
    CLEAR        = 0x22 Write "resume after a stop, whatever is written: queues empty, P at its start; the position stays";
    HOME         = 0x23 Write "axes, a bit each, whose next limit latches their position and stops only them";
    P_LOW        = 0x40 Read "fraction of a step, low half, 2^-64 step";
    P_HIGH       = 0x41 Read "fraction of a step, high half";
    POSITION     = 0x42 Read "steps forward less steps back, two's complement";
    DISCARDED    = 0x43 Read "steps that freezes have discarded";
    LATCHED      = 0x44 Read "position when the limit was reached in homing";
    SEGMENT      = 0x40 WriteSegment "ticks - 1, V, A, J (low half first, 2^-64 step per tick^1, 2, 3), then 1 where it is the last of its move";
}

super::constants! {
    IDENTITY_VALUE: u32 = u32::from_le_bytes(*b"CSTP"), "What IDENTITY holds.";
    PROTOCOL_VERSION: u32 = 1, "The version of the protocol that this map belongs to.";
    CONTROL_ENABLE: u32 = 1 << 0, "In CONTROL: power the drivers.";
    CONTROL_STOP: u32 = 1 << 1, "In CONTROL: stop all axes.";
    AXES_AT: u8 = 0x40, "First address of the axes.";
    PER_AXIS: u8 = 8, "Addresses of each axis.";
    MOST_AXES: u8 = MAX_AXES as u8, "Most axes of a build.";
    QUEUE_SEGMENTS: u8 = QUEUE as u8, "Segments that can wait for an axis, beside the one that runs.";
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
                let reads = |register: &Register| register.access == Access::Read;
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

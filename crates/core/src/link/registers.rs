//! The register map. From this table come the gateware's decode, the constants in Rust and C, and docs/registers.md.
//!
//! ```text
//! 0x00 .. 0x1f   facts of the build, read only: who it is comes first, in every version
//! 0x20 .. 0x3f   what the host commands
//! 0x40 .. 0x7f   eight words for each axis: 0x40 + 8 axis + word
//! ```

use crate::engine::{MAX_AXES, QUEUE};

/// Who may do what with a register.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// It is read.
    Read,
    /// It is written, one word.
    Write,
    /// It is written, the eight words of a segment in one frame.
    WriteSegment,
}

/// One row of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Register {
    /// Its name; in Rust and C a constant.
    pub name: &'static str,
    /// Its address; for an axis the first axis', with eight for each next one.
    pub address: u8,
    /// Who may do what.
    pub access: Access,
    /// One for each axis.
    pub per_axis: bool,
    /// What it holds, with its unit.
    pub what: &'static str,
}

/// Declares each register once: a constant with its address, and its row of the table.
macro_rules! registers {
    ($($name:ident = $address:literal $access:ident $what:literal;)*) => {
        $(#[doc = $what] pub const $name: u8 = $address;)*

        /// The map, by address.
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

/// The address of an axis' register.
///
/// ```
/// use crate::link::registers::{POSITION, of_axis};
/// assert_eq!(of_axis(POSITION, 3), 0x5a);
/// ```
pub const fn of_axis(register: u8, axis: u8) -> u8 {
    register + PER_AXIS * axis
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_registers_share_an_address_for_the_same_access() {
        for (index, one) in REGISTERS.iter().enumerate() {
            for other in &REGISTERS[..index] {
                let reads = |register: &Register| register.access == Access::Read;
                assert!(one.address != other.address || reads(one) != reads(other), "{} {}", one.name, other.name);
            }
        }
    }

    #[test]
    fn all_axes_have_addresses() {
        let last = REGISTERS.iter().map(|register| register.address).max().unwrap();
        assert!(last < AXES_AT + PER_AXIS);
        assert!(of_axis(last, MAX_AXES as u8 - 1) < super::super::WRITE);
    }
}

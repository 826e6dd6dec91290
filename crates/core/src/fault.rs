//! The faults that the six-axis core latches, and their names.

use crate::build::AXES;
use core::fmt;

/// Latched faults of the six-axis core. Any of them freezes all axes until the host asserts
/// `clear`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Faults {
    /// Bit i: a second step arrived on axis i while one was held back for its pin timing (promise
    /// 6).
    pub overrun: u8,
    /// Bit i: V of axis i would have left (-2^63, 2^63).
    pub overspeed: u8,
    /// Bit i: the queue of axis i was empty after a segment not marked LAST.
    pub underrun: u8,
    /// The host violated the segment protocol.
    pub protocol: bool,
}

impl Faults {
    /// Whether any fault is latched.
    pub const fn any(self) -> bool {
        self.overrun != 0 || self.overspeed != 0 || self.underrun != 0 || self.protocol
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.any() {
            return f.write_str("none");
        }
        let mut separator = "";
        for (name, bits) in
            [("overrun", self.overrun), ("overspeed", self.overspeed), ("underrun", self.underrun)]
        {
            for axis in (0..AXES).filter(|axis| bits >> axis & 1 == 1) {
                write!(f, "{separator}{name} on axis {axis}")?;
                separator = ", ";
            }
        }
        if self.protocol {
            write!(f, "{separator}segment protocol broken")?;
        }
        Ok(())
    }
}

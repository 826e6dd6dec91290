//! The latches: each takes the state of all axes at an edge of its pin, and motion goes on.

use super::snapshot::{Snapshot, SnapshotReader};
use super::{Clock, Host, HostError};
use crate::line::Line;
use crate::registers as map;

/// Greatest number of latches of a build.
pub const MOST_LATCHES: u8 = 4;

/// Bit of byte 1 of CAPTURES: the latch waits for its edge.
const ARMED: u32 = 1 << 4;

/// The state of all latches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Latches {
    /// Mask of the latches that the build has. A build with at most one latch does not say whether
    /// it has one: then this is 1.
    pub built: u8,
    /// Mask of the latches that wait for their edges.
    pub armed: u8,
    /// Further edges of each latch since it was armed, at most 15.
    pub edges: [u8; MOST_LATCHES as usize],
}

impl Latches {
    /// The state in the words of the registers LATCHES and CAPTURES.
    fn of_words(latches: u32, captures: u32) -> Self {
        if latches == 0 {
            let state = captures >> 8;
            let armed = u8::from(state & ARMED != 0);
            return Self { built: 1, armed, edges: [(state & 15) as u8, 0, 0, 0] };
        }
        let edges = [16, 20, 24, 28].map(|bit| (latches >> bit & 15) as u8);
        Self { built: (latches >> 4 & 15) as u8, armed: (latches & 15) as u8, edges }
    }

    /// True if the build has several latches.
    pub const fn are_several(&self) -> bool {
        self.built.count_ones() > 1
    }
}

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Reads the state of all latches.
    ///
    /// # Errors
    /// [`HostError`] if the connection fails.
    pub fn latches(&mut self) -> Result<Latches, HostError<L::Error>> {
        let [latches, captures] = self.registers([map::LATCHES, map::CAPTURES])?;
        Ok(Latches::of_words(latches, captures))
    }

    /// Arms latches, bit k of the mask latch k: each takes the state of all axes at its next edge. In
    /// a build with several latches, hosts that read the LATCH_ registers see latch 0 from now on.
    ///
    /// # Errors
    /// [`HostError::NoLatch`] if the build does not have one of them; then nothing is armed.
    /// [`HostError::NoSession`] if [`Self::open`] was not called. Other errors concern the line.
    pub fn arm_latches(&mut self, mask: u8) -> Result<(), HostError<L::Error>> {
        let latches = self.latches()?;
        let missing = mask & !latches.built;
        if missing != 0 {
            return Err(HostError::NoLatch { latch: missing.trailing_zeros() as u8 });
        }
        if mask == 0 { Ok(()) } else { self.write(map::LATCH, mask.into()) }
    }

    /// Reads the record of a latch: the state of all axes at the edge that it has taken. Before its
    /// first edge, and while it is armed, the record has no meaning ([`Self::latches`]).
    ///
    /// # Errors
    /// [`HostError::NoLatch`] if the build does not have this latch. [`HostError::NoSession`] if
    /// [`Self::open`] was not called. Other errors concern the line.
    pub fn latched(&mut self, latch: u8) -> Result<Snapshot, HostError<L::Error>> {
        let latches = self.latches()?;
        if latch >= MOST_LATCHES || latches.built >> latch & 1 == 0 {
            return Err(HostError::NoLatch { latch });
        }
        if latches.are_several() {
            // Arms none and chooses this one. In a build with one latch any word would arm it.
            self.write(map::LATCH, u32::from(latch) << 4)?;
        }
        self.read_whole(SnapshotReader::of_latch(self.axes()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn state_is_that_of_one_latch_or_of_several() {
        let one = Latches::of_words(0, 0x1300);
        assert_eq!(one, Latches { built: 1, armed: 1, edges: [3, 0, 0, 0] });
        assert!(!one.are_several());
        let several = Latches::of_words(0x4321_e472, 0);
        assert_eq!(several, Latches { built: 7, armed: 2, edges: [1, 2, 3, 4] });
        assert!(several.are_several());
    }
}

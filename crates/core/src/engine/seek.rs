//! The source of a seek: a switch, and the level of it that the axes wait for.
//!
//! ```text
//! bits   2 .. 0   4 .. 3   5     6
//!        axis     row      own   level
//! ```
//!
//! "Seek" in docs/clock-by-clock.md says what the engine does with it.

/// The switch and the level that end a seek.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct SeekSource {
    /// The axis in whose time slot the switch is sampled, 0 to 7. It has no meaning with `own`.
    pub axis: u8,
    /// The row of the switch, 0 to 3: limits at the low ends, at the high ends, other inputs.
    pub row: u8,
    /// Each axis waits for its own switch in this row, and all others go on.
    pub own: bool,
    /// The debounced state that is the hit; true is active.
    pub level: bool,
}

impl SeekSource {
    /// The byte of the port `seek_source`.
    ///
    /// ```
    /// use carrystep_core::engine::SeekSource;
    /// let source = SeekSource { axis: 2, row: 3, own: false, level: true };
    /// assert_eq!(source.byte(), 0x5a);
    /// assert_eq!(SeekSource::of_byte(0xda), source);
    /// ```
    pub const fn byte(self) -> u8 {
        let Self { axis, row, own, level } = self;
        (axis & 7) | (row & 3) << 3 | (own as u8) << 5 | (level as u8) << 6
    }

    /// The source in such a byte; bit 7 is ignored.
    pub const fn of_byte(byte: u8) -> Self {
        Self {
            axis: byte & 7,
            row: byte >> 3 & 3,
            own: byte >> 5 & 1 == 1,
            level: byte >> 6 & 1 == 1,
        }
    }

    /// True if the switch of this row and axis is the source for that axis.
    pub const fn is(self, row: u8, axis: u8) -> bool {
        self.row == row && (self.own || self.axis == axis)
    }
}

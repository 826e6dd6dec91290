//! The block RAMs of a family: what they take of a part, and the shapes of memories that they hold.

/// A kind of block RAM, with one port that reads and one that writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BlockRam {
    /// What it takes of a part: the two halves of a block RAM as the part's data count them, or one.
    pub halves: u32,
    /// The widths of its words, bits, by their number, the fewest words first.
    pub widths: &'static [(u32, u32)],
    /// Number of parts of a word that are written separately.
    pub enables: u32,
}

/// Widths of a block RAM of 18 kbit.
pub(super) const OF_18_KBIT: &[(u32, u32)] = &[(512, 36), (1024, 18), (2048, 9)];

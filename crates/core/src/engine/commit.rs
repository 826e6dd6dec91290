//! The last word of a segment, which commits it to the queue: whether the segment is the last of
//! its move, and the outputs that change where it begins.
//!
//! ```text
//! bits   0      1            3 2   11 .. 4   19 .. 12   31 .. 20
//!        last   sets_duty    0     mask      levels     duty
//! ```
//!
//! "Outputs" in docs/clock-by-clock.md says what the engine does with it.

use crate::output_change::OutputChange;

/// Greatest divider of the PWM.
pub const MAX_PWM_DIVIDER: u32 = 256;

/// Number of steps of a period of the PWM.
pub const PWM_STEPS: u32 = 1 << 12;

/// Bits of a commit that name outputs and give their levels.
const OUTPUT_BITS: u32 = 0x000f_fff0;

/// Bits of a commit that are about the PWM.
const PWM_BITS: u32 = 0xfff0_0002;

/// The outputs of an engine, which change where a segment begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Outputs {
    /// The outputs that exist, one bit each.
    pub exist: u8,
    /// Clocks for each of the [`PWM_STEPS`] steps of a period of the PWM, 1 to
    /// [`MAX_PWM_DIVIDER`]; 0 if the build has no PWM.
    pub pwm_divider: u32,
    /// Whether a stop by ramps turns all outputs off; a freeze always does.
    pub off_at_ramps: bool,
}

impl Outputs {
    /// The bits that the commit of a segment of axis 0 may have. Other axes have [`Commit::LAST`]
    /// only.
    pub const fn commit_bits(self) -> u32 {
        let exist = self.exist as u32;
        let pwm = if self.pwm_divider == 0 { 0 } else { PWM_BITS };
        Commit::LAST | exist << 4 | exist << 12 | pwm
    }

    /// True if the build has an output or the PWM. Otherwise the engine ignores all bits of a
    /// commit but [`Commit::LAST`].
    pub const fn is_any(self) -> bool {
        self.exist != 0 || self.pwm_divider != 0
    }
}

/// The content of a commit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Commit {
    /// The segment is the last of its move.
    pub last: bool,
    /// What changes at the outputs where the segment begins.
    pub outputs: OutputChange,
}

impl Commit {
    /// Bit of the word: the segment is the last of its move.
    pub const LAST: u32 = 1 << 0;

    /// The word that commits the segment. Of the duty, only the lowest 12 bits count.
    ///
    /// ```
    /// use carrystep_core::OutputChange;
    /// use carrystep_core::engine::Commit;
    /// let outputs = OutputChange { mask: 3, levels: 1, duty: Some(0x800) };
    /// let commit = Commit { last: true, outputs };
    /// assert_eq!(commit.word(), 0x8000_1033);
    /// assert_eq!(Commit::of_word(0x8000_1033), commit);
    /// ```
    pub const fn word(self) -> u32 {
        self.last as u32 | self.outputs.word()
    }

    /// The commit in such a word.
    pub const fn of_word(word: u32) -> Self {
        Self { last: word & Self::LAST != 0, outputs: OutputChange::of_word(word) }
    }
}

const _: () = assert!(OUTPUT_BITS | PWM_BITS | Commit::LAST == !0xc, "two bits are left");

//! A change of outputs, which a segment of the first axis brings with it.

/// What changes at the outputs where a segment of the first axis begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct OutputChange {
    /// The outputs that change, one bit each.
    pub mask: u8,
    /// Their new levels; 1 is active.
    pub levels: u8,
    /// The new duty of the PWM, 0 to 4095 of 4096; `None` if it stays.
    pub duty: Option<u16>,
}

impl OutputChange {
    /// Nothing changes.
    pub const NONE: Self = Self { mask: 0, levels: 0, duty: None };

    /// The bits of a commit that are about outputs, as the drawing in `engine/commit.rs` shows them.
    /// Of the duty, only the lowest 12 bits count.
    pub const fn word(self) -> u32 {
        let duty = match self.duty {
            Some(duty) => 1 << 1 | (duty as u32) << 20,
            None => 0,
        };
        (self.mask as u32) << 4 | (self.levels as u32) << 12 | duty
    }

    /// The change in such a word, whose other bits do not count.
    pub const fn of_word(word: u32) -> Self {
        Self {
            mask: (word >> 4) as u8,
            levels: (word >> 12) as u8,
            duty: if word >> 1 & 1 == 1 { Some((word >> 20) as u16) } else { None },
        }
    }

    /// True if no output and no duty can change.
    pub const fn is_none(self) -> bool {
        self.mask == 0 && self.duty.is_none()
    }

    /// The change that has the effect of this one followed by a later one.
    ///
    /// ```
    /// use carrystep_core::OutputChange;
    /// let first = OutputChange { mask: 3, levels: 3, duty: Some(7) };
    /// let later = OutputChange { mask: 6, levels: 4, duty: None };
    /// assert_eq!(first.then(later), OutputChange { mask: 7, levels: 5, duty: Some(7) });
    /// ```
    #[must_use]
    pub const fn then(self, later: Self) -> Self {
        Self {
            mask: self.mask | later.mask,
            levels: (self.levels & !later.mask) | (later.levels & later.mask),
            duty: match later.duty {
                Some(duty) => Some(duty),
                None => self.duty,
            },
        }
    }
}

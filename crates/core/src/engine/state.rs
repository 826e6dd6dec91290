//! The words of state that the engine outputs for the host: in each tick, those of every axis.
//!
//! ```text
//! address   page 2 | item 3 | axis 3          the register from which a host reads the word
//! page      0 hit of a seek   1 live   2 snapshot   3 latch;  of item 2: the row of the switch
//! item      0 discarded   1 left   2 switch   3 ticks   4 5 P (low, high)   6 position   7 status
//! ```
//!
//! "What the host reads" in docs/clock-by-clock.md says in which clock each word is output.

use super::MAX_AXES;

/// Number of bits of an axis at the port `state_axis`, and of the axis in a word's address.
pub const STATE_AXIS_BITS: u32 = 3;

/// Number of bits of the port `state_item`, and of the item in a word's address.
pub const STATE_ITEM_BITS: u32 = 3;

/// Number of the lowest bits of [`StateItem::Status`] that have a meaning.
pub const STATUS_BITS: u32 = 16;

/// Bit of [`StateItem::Switch`]: the debounced state of the switch, 1 active.
pub const SWITCH_STATE: u32 = 1 << 7;

/// Bit of [`StateItem::Switch`]: the level at its pin, 1 active.
pub const SWITCH_LEVEL: u32 = 1 << 6;

/// The copy of the state to which a word belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StatePage {
    /// The state in the tick after the hit of a seek.
    Seek = 0,
    /// The state in the latest tick.
    Live = 1,
    /// The state in the tick of the latest snapshot.
    Snapshot = 2,
    /// The state in the tick after the edge that a latch accepted.
    Latch = 3,
}

impl StatePage {
    /// The page with this number; only the lowest two bits of the number count.
    pub const fn of_number(number: u8) -> Self {
        match number & 3 {
            0 => Self::Seek,
            1 => Self::Live,
            2 => Self::Snapshot,
            _ => Self::Latch,
        }
    }
}

/// One word of the state of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StateItem {
    /// Number of steps that freezes have discarded; output while the axis does not run.
    Discarded = 0,
    /// Ticks of the running segment that follow the next tick; output while the axis runs.
    Left = 1,
    /// Levels of a switch: [`SWITCH_STATE`] and [`SWITCH_LEVEL`]. The page is the row of the switch
    /// and no copy of the state.
    Switch = 2,
    /// Number of strobes since configuration, modulo 2^32.
    Ticks = 3,
    /// P in units of 2^-64 step, low half.
    PLow = 4,
    /// P, high half.
    PHigh = 5,
    /// Position in steps, two's complement.
    Position = 6,
    /// An [`AxisStatus`] in the lowest [`STATUS_BITS`] bits; the others have no meaning.
    Status = 7,
}

/// A word of state, as the engine outputs it in one clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct StateWord {
    /// The page that it belongs to.
    pub page: StatePage,
    /// Number of the record to which the words of [`StatePage::Latch`] belong in this tick; the
    /// same for all words of a tick, and 0 in a build with at most one latch.
    pub record: u8,
    /// The axis.
    pub axis: u8,
    /// Its meaning.
    pub item: StateItem,
    /// Its value; bits without a meaning are 0.
    pub word: u32,
}

/// What an axis does: the content of [`StateItem::Status`].
///
/// ```text
/// bits   4 .. 0   5         10 .. 6   15 .. 12
///        slot     running   waiting   on_way
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct AxisStatus {
    /// Slot of the running segment, or of the last one that ran. It is 0 after a clear, and each
    /// segment has the slot after that of the segment before it, modulo the number of slots.
    pub slot: u8,
    /// The axis runs a segment.
    pub running: bool,
    /// Number of segments that wait in its queue.
    pub waiting: u8,
    /// Steps on their way, -8 to 7: carries since the last clear less the steps that the position
    /// has counted since then. Steps that a freeze has discarded stay in this number until the
    /// clear.
    pub on_way: i8,
}

impl AxisStatus {
    /// The word that the engine outputs.
    ///
    /// ```
    /// use carrystep_core::engine::AxisStatus;
    /// let status = AxisStatus { slot: 3, running: true, waiting: 2, on_way: -1 };
    /// assert_eq!(status.word(), 0xf0a3);
    /// assert_eq!(AxisStatus::of_word(0x1234_f0a3), status);
    /// ```
    pub const fn word(self) -> u32 {
        let Self { slot, running, waiting, on_way } = self;
        (slot & 31) as u32
            | (running as u32) << 5
            | ((waiting & 31) as u32) << 6
            | ((on_way & 15) as u32) << 12
    }

    /// The status in such a word. Bits without a meaning are ignored.
    pub const fn of_word(word: u32) -> Self {
        Self {
            slot: (word & 31) as u8,
            running: word >> 5 & 1 == 1,
            waiting: (word >> 6 & 31) as u8,
            on_way: ((word >> 8 & 0xf0) as u8).cast_signed() >> 4,
        }
    }
}

/// The words of state that the engine outputs in one clock: at most one of the axes of each adder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StateWords([Option<StateWord>; MAX_AXES]);

impl StateWords {
    /// No word.
    pub const NONE: Self = Self([None; MAX_AXES]);

    /// The words of the adders; `of` gives that of an adder, whose number is less than [`MAX_AXES`].
    pub fn of(of: impl FnMut(usize) -> Option<StateWord>) -> Self {
        Self(core::array::from_fn(of))
    }

    /// The word of this adder.
    pub fn of_adder(&self, adder: usize) -> Option<StateWord> {
        self.0.get(adder).copied().flatten()
    }

    /// True if no word is output.
    pub fn is_none(&self) -> bool {
        self.0.iter().all(Option::is_none)
    }

    /// The words, in the order of the adders.
    pub fn iter(&self) -> impl Iterator<Item = StateWord> + use<> {
        self.0.into_iter().flatten()
    }
}

impl IntoIterator for StateWords {
    type Item = StateWord;
    type IntoIter = core::iter::Flatten<core::array::IntoIter<Option<StateWord>, MAX_AXES>>;
    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter().flatten()
    }
}

impl StateWord {
    /// Address of the register from which a host reads the word.
    pub const fn address(self) -> u8 {
        address(self.page, self.item) + self.axis
    }
}

/// Address of the register of axis 0 with this word; that of axis i is i higher.
pub const fn address(page: StatePage, item: StateItem) -> u8 {
    (page as u8) << (STATE_AXIS_BITS + STATE_ITEM_BITS) | (item as u8) << STATE_AXIS_BITS
}

/// The commanded position of an axis in steps: all carries so far, those included whose pulses are
/// on their way. Valid without a stop; in a stop it includes discarded steps. `position` and the
/// status are those of one page.
///
/// ```
/// use carrystep_core::engine::{AxisStatus, commanded_steps};
/// let status = AxisStatus { on_way: 2, ..AxisStatus::default() };
/// assert_eq!(commanded_steps(-7, status), -5);
/// ```
pub const fn commanded_steps(position: i32, status: AxisStatus) -> i32 {
    position.wrapping_add(status.on_way as i32)
}

const _: () = assert!(MAX_AXES <= 1 << STATE_AXIS_BITS && super::QUEUE_DEPTHS[2] < 32);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn status_keeps_every_value_of_every_field() {
        for slot in 0..32 {
            for waiting in 0..32 {
                for on_way in -8..8 {
                    for running in [false, true] {
                        let status = AxisStatus { slot, running, waiting, on_way };
                        assert_eq!(AxisStatus::of_word(status.word()), status);
                        assert!(status.word() < 1 << STATUS_BITS);
                    }
                }
            }
        }
    }
}

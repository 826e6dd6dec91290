//! Names for the beats of a time slot, and for the words and the bits in the memories of the
//! engine.
//!
//! ```text
//! beat        0    1    2    3    4    5    6    7    8    9    10   11   12   13-15   16
//! READ        A    J    V    P    n    pos  J'   A'   V'   P'   tick      tick
//! LOAD             A    J    V    P    n    pos  J'   A'   V'   P'             tick
//! SUM                        A    V    P    n    pos  put  A'   V'   P'   bisection    phase, tick
//! WRITE                           A    V    P    n    pos  put  A'   V'   P'
//! STATE                           P    n    pos  sw             P'   tick stat
//!             ': high halves      n: remaining ticks, or at rest the discarded steps
//! ```
//!
//! A word is read in its `READ` beat and is loaded into an operand of the adder in the next one.
//! The sum that replaces it is computed in its `SUM` beat and written in the next one. In its
//! `STATE` beat a word is output to the host. A beat that has a role of another kind has another
//! name too. The number of the tick is added to only in the tail of the last time slot, which no
//! other time slot overlaps.
//!
//! Kernels name these constants as indices of bits: `beat.val().get_bit(BEAT_READ_V_LOW)`. Rust-HDL
//! passes such a name on as text. [`index`] gives its value, so that the Verilog contains the
//! number.

use carrystep_core::engine::{COMMIT, PUT_BEAT, TIME_SLOT_CLOCKS};

/// Defines the constants and the table of their names.
macro_rules! indices {
    ($($(#[$doc:meta])* $name:ident = $value:expr;)*) => {
        $($(#[$doc])* pub const $name: usize = $value;)*
        /// The constants of this module that kernels use as indices, with their names.
        pub const INDICES: &[(&str, usize)] = &[$((stringify!($name), $name)),*];
    };
}

indices! {
    /// First beat of a time slot.
    BEAT_FIRST = 0;
    /// Last beat of a time slot. The four beats after it overlap the next time slot.
    BEAT_LAST = TIME_SLOT_CLOCKS as usize - 1;

    /// A or the stop acceleration is read, low half.
    BEAT_READ_A_LOW = 0;
    /// J is read, low half.
    BEAT_READ_J_LOW = 1;
    /// V is read, low half.
    BEAT_READ_V_LOW = 2;
    /// P is read, low half.
    BEAT_READ_P_LOW = 3;
    /// The remaining ticks are read, or at rest the discarded steps.
    BEAT_READ_TICKS = 4;
    /// The position is read.
    BEAT_READ_POSITION = 5;
    /// J is read, high half.
    BEAT_READ_J_HIGH = 6;
    /// A or the stop acceleration is read, high half.
    BEAT_READ_A_HIGH = 7;
    /// V is read, high half.
    BEAT_READ_V_HIGH = 8;
    /// P is read, high half.
    BEAT_READ_P_HIGH = 9;
    /// The number of the tick is read, for the host.
    BEAT_READ_TICK = 10;
    /// The number of the tick is read, for the adder.
    BEAT_READ_TICK_AGAIN = 12;

    /// A is loaded into operand A, low half.
    BEAT_LOAD_A_LOW = BEAT_READ_A_LOW + 1;
    /// J is loaded into operand B, low half.
    BEAT_LOAD_J_LOW = BEAT_READ_J_LOW + 1;
    /// V is loaded into operand B, low half.
    BEAT_LOAD_V_LOW = BEAT_READ_V_LOW + 1;
    /// P is loaded into operand A, low half.
    BEAT_LOAD_P_LOW = BEAT_READ_P_LOW + 1;
    /// The remaining ticks are loaded into operand A, and -1 or 0 into operand B.
    BEAT_LOAD_TICKS = BEAT_READ_TICKS + 1;
    /// The position is loaded into operand A, and -1 or 0 into operand B. It is compared with the
    /// position of the pulser.
    BEAT_LOAD_POSITION = BEAT_READ_POSITION + 1;
    /// J is loaded into operand B, high half.
    BEAT_LOAD_J_HIGH = BEAT_READ_J_HIGH + 1;
    /// A is loaded into operand A, high half.
    BEAT_LOAD_A_HIGH = BEAT_READ_A_HIGH + 1;
    /// V is loaded into operand B, high half.
    BEAT_LOAD_V_HIGH = BEAT_READ_V_HIGH + 1;
    /// P is loaded into operand A, high half.
    BEAT_LOAD_P_HIGH = BEAT_READ_P_HIGH + 1;
    /// The number of the tick is loaded into operand A.
    BEAT_LOAD_TICK = BEAT_READ_TICK_AGAIN + 1;
    /// In the tail of the last time slot: 0 is loaded into operand B.
    BEAT_LOAD_TICK_STEP = 15;
    /// The beat of the next time slot that overlaps [`BEAT_LOAD_TICK_STEP`], if there is one.
    BEAT_OVER_LOAD_TICK_STEP = BEAT_LOAD_TICK_STEP - TIME_SLOT_CLOCKS as usize;

    /// The sum is P + V, low half.
    BEAT_SUM_P_LOW = 5;
    /// The sum is the remaining ticks - 1, or at rest the discarded steps.
    BEAT_SUM_TICKS = 6;
    /// The sum is the word of the host, unchanged.
    BEAT_SUM_PUT = 8;
    /// The sum is P + V, high half.
    BEAT_SUM_P_HIGH = 11;
    /// First sum of the bisection: P + V / 2.
    BEAT_BISECT_1 = 12;
    /// Second sum of the bisection: the last one + or - V / 4.
    BEAT_BISECT_2 = 13;
    /// Third sum of the bisection: the last one + or - V / 8.
    BEAT_BISECT_3 = 14;
    /// The last bit of the phase is found; the phase is valid from the next clock on.
    BEAT_PHASE = 16;
    /// In the tail of the last time slot: the sum is the number of the tick + 1.
    BEAT_SUM_TICK = BEAT_LOAD_TICK_STEP + 1;
    /// The beat of the next time slot that overlaps [`BEAT_SUM_TICK`], if there is one.
    BEAT_OVER_SUM_TICK = BEAT_SUM_TICK - TIME_SLOT_CLOCKS as usize;

    /// A + J is written, low half.
    BEAT_WRITE_A_LOW = 4;
    /// V + A is written, low half.
    BEAT_WRITE_V_LOW = 5;
    /// P + V is written, low half.
    BEAT_WRITE_P_LOW = BEAT_SUM_P_LOW + 1;
    /// The remaining ticks are written, or at rest the discarded steps.
    BEAT_WRITE_TICKS = BEAT_SUM_TICKS + 1;
    /// The position is written.
    BEAT_WRITE_POSITION = 8;
    /// The word of the host is written.
    BEAT_WRITE_PUT = BEAT_SUM_PUT + 1;
    /// A + J is written, high half.
    BEAT_WRITE_A_HIGH = 10;
    /// V + A is written, high half.
    BEAT_WRITE_V_HIGH = 11;
    /// P + V is written, high half.
    BEAT_WRITE_P_HIGH = BEAT_SUM_P_HIGH + 1;

    /// The discarded steps of the pulser are compared with those that have been counted.
    BEAT_COMPARE_DISCARDED = 4;
    /// A word of the host for this axis is accepted.
    BEAT_PUT = PUT_BEAT as usize;

    /// P is output, low half.
    BEAT_STATE_P_LOW = BEAT_READ_P_LOW + 1;
    /// The remaining ticks are output, or at rest the discarded steps.
    BEAT_STATE_LEFT = BEAT_READ_TICKS + 1;
    /// The position is output.
    BEAT_STATE_POSITION = BEAT_READ_POSITION + 1;
    /// The levels of the switch are output, in a tick that samples it.
    BEAT_STATE_SWITCH = 7;
    /// P is output, high half.
    BEAT_STATE_P_HIGH = BEAT_READ_P_HIGH + 1;
    /// The number of the tick is output.
    BEAT_STATE_TICK = BEAT_READ_TICK + 1;
    /// The status is output.
    BEAT_STATE_STATUS = 12;

    /// Sign of a high half.
    WORD_SIGN = 31;
    /// Lowest bit of a word, which halving drops.
    WORD_LOWEST = 0;
    /// Lowest bit of the sum in `wide`, above the bit by which the carry enters.
    WIDE_SUM = 1;
    /// Bit 32 of the sum in `wide`.
    WIDE_TOP = 33;

    /// Control word: slot of the running segment, 5 bits.
    CONTROL_LIVE = 0;
    /// Control word: slot of the newest segment, 5 bits.
    CONTROL_NEWEST = 5;
    /// Control word: the axis runs.
    CONTROL_RUNNING = 10;
    /// Control word: the next V does not fit in 64 bits.
    CONTROL_UNFIT = 11;
    /// Control word: the ramp began with V < 0.
    CONTROL_BACK = 12;
    /// Control word: the ramp has begun.
    CONTROL_KNOWN = 13;
    /// Control word: the number of the word that the host must put next, 3 bits.
    CONTROL_DUE = 14;
    /// Control word: the words of this tick are those of the axis' own hit.
    CONTROL_MET = 17;
    /// Control word: what the step counts keep, 7 bits.
    CONTROL_COUNTS = 18;
    /// Control word: slot of the last segment that the next cut keeps, 5 bits.
    CONTROL_TARGET = 25;
    /// Control word: the axis takes part in the next cut.
    CONTROL_NAMED = 30;
    /// Number of a word of the host: the number in its segment, 3 bits.
    PUT_NUMBER = 0;
    /// Number of a word of the host: it is no word of a segment and names the slot of a cut.
    PUT_NAMES = 3;
    /// Word of the host that names a slot, 5 bits.
    PUT_SLOT = 0;
    /// Slot: its lowest part in an address of the segments' memory, 3 bits.
    SLOT_LOW = 0;
    /// Slot: its highest part in such an address, 2 bits.
    SLOT_HIGH = 3;
    /// What the step counts keep: discarded steps modulo 8, 3 bits.
    KEPT_DISCARDED = 0;
    /// What the step counts keep: carries less counted steps, modulo 16, 4 bits.
    KEPT_ON_WAY = 3;
    /// Low bits of the position, in memory or as the pulser counts them, 3 bits.
    POSITION_LOW = 0;
    /// Sign of the difference between the pulser's count and the position in memory.
    MISSING_SIGN = 2;

    /// Word of a switch: number of consecutive samples that differ, 7 bits.
    SWITCH_COUNT = 0;
    /// Word of a switch: debounced state.
    SWITCH_STATE = 7;
    /// Row of a switch: it is 1 or 3.
    ROW_IS_ODD = 0;
    /// Row of a switch: it is 2 or 3.
    ROW_OF_INPUTS = 1;
    /// Number of the tick in its round: the row of the switches that are sampled, 2 bits.
    ROUND_ROW = 0;
    /// Number of the tick in its round: 0 in the first four ticks, 8 bits.
    ROUND_FOURS = 2;
    /// Source of seeks: axis of the switch, 3 bits.
    SOURCE_AXIS = 0;
    /// Source of seeks: row of the switch, 2 bits.
    SOURCE_ROW = 3;
    /// Source of seeks: each axis waits for its own switch in this row.
    SOURCE_OWN = 5;
    /// Source of seeks: the debounced state that is the hit.
    SOURCE_LEVEL = 6;

    /// Address of an event word: the tick modulo 4, 2 bits.
    EVENT_TICK = 5;
    /// Event word: one bit for each axis that has an event.
    EVENT_AXES = 0;
    /// Event word: one bit for each axis whose event is backward.
    EVENT_BACKWARD = 8;

    /// Counts of the pulser: pulses forward less pulses backward modulo 8, 3 bits.
    COUNTS_PULSES = 0;
    /// Counts of the pulser: discarded steps modulo 8, 3 bits.
    COUNTS_LOSSES = 3;

    /// Data of a commit: the segment is the last of its move.
    COMMIT_LAST = 0;
    /// Data of a commit: the duty of the PWM changes.
    COMMIT_SETS_DUTY = 1;
    /// Data of a commit: the outputs that change and their levels, 16 bits.
    COMMIT_MASK = 4;
    /// Data of a commit: the duty, 12 bits.
    COMMIT_DUTY = 20;
    /// Word of outputs: those that change, 8 bits.
    OUTPUT_MASK = 0;
    /// Word of outputs: their levels, 8 bits.
    OUTPUT_LEVELS = 8;
    /// Word of a duty: the duty, 12 bits.
    DUTY_STEPS = 0;
    /// Word of a duty: the duty changes.
    DUTY_VALID = 12;
    /// The ring of the start's mask: the axis of this time slot.
    MASK_OF_SLOT = 0;
    /// One bit per axis: the first axis.
    SLOT_OF_FIRST = 0;
}

/// Word of a segment: ticks - 1.
pub const WORD_TICKS: u64 = 0;
/// Word of a segment: V, low half.
pub const WORD_V_LOW: u64 = 1;
/// Word of a segment: V, high half.
pub const WORD_V_HIGH: u64 = 2;
/// Word of a segment: A, low half.
pub const WORD_A_LOW: u64 = 3;
/// Word of a segment: A, high half.
pub const WORD_A_HIGH: u64 = 4;
/// Word of a segment: J, low half.
pub const WORD_J_LOW: u64 = 5;
/// Word of a segment: J, high half.
pub const WORD_J_HIGH: u64 = 6;
/// Word of each slot that no segment uses. Those of the slots 0 to 7 hold the state of the axis.
pub const WORD_STATE: u64 = COMMIT as u64;

/// Slot of [`WORD_STATE`]: P, low half.
pub const SLOT_P_LOW: u64 = 0;
/// Slot of [`WORD_STATE`]: P, high half.
pub const SLOT_P_HIGH: u64 = 1;
/// Slot of [`WORD_STATE`]: position.
pub const SLOT_POSITION: u64 = 2;
/// Slot of [`WORD_STATE`]: discarded steps.
pub const SLOT_DISCARDED: u64 = 3;
/// Slot of [`WORD_STATE`]: -s of the stop acceleration s, low half.
pub const SLOT_DOWN_LOW: u64 = 4;
/// Slot of [`WORD_STATE`]: -s, high half.
pub const SLOT_DOWN_HIGH: u64 = 5;
/// Slot of [`WORD_STATE`]: s, low half.
pub const SLOT_UP_LOW: u64 = 6;
/// Slot of [`WORD_STATE`]: s, high half.
pub const SLOT_UP_HIGH: u64 = 7;

/// Address of the number of the tick. Only as many of its lowest bits count as an address has. With
/// up to seven axes and eight slots these are nine, and the address is one of the axis 7, which
/// does not exist. With more slots it is that of word 7 in the last slot, which no axis uses.
pub const TICK_ADDRESS: u64 = 0x7ff;

/// Address of a word of the state of an axis.
pub const fn state_address(axis: usize, slot: u64) -> usize {
    axis << 6 | (slot as usize) << 3 | WORD_STATE as usize
}

/// The value of an index that a kernel names.
pub fn index(name: &str) -> Option<usize> {
    INDICES.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_index_is_known_by_its_name_only() {
        assert_eq!(index("BEAT_WRITE_P_HIGH"), Some(12));
        assert_eq!(index("BEAT_LAST"), Some(12));
        assert_eq!(index("BEAT"), None);
        let names: std::collections::BTreeSet<&str> =
            INDICES.iter().map(|(name, _)| *name).collect();
        assert_eq!(names.len(), INDICES.len());
    }
}

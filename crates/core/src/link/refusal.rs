//! The reasons for which the gateware refuses a request: number, name and meaning.
//!
//! The register map of the clients and docs/registers.md are generated from this table.

use strum::{Display, IntoStaticStr};

/// Declares the enumeration and its table.
macro_rules! refusals {
    ($($refusal:ident = $number:literal, $name:literal, $what:literal;)*) => {
        /// Reason of a refusal. Its number is the value of the field `reason` of an answer, in
        /// which 0 means that the request was not refused.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Display, IntoStaticStr)]
        pub enum Refusal {
            $(#[doc = $what] #[strum(to_string = $name)] $refusal = $number,)*
        }

        /// All reasons, in the order of their numbers, from 1 on.
        pub const REFUSALS: [Refusal; [$($number),*].len()] = [$(Refusal::$refusal),*];

        impl Refusal {
            /// What the reason means, as a sentence.
            pub const fn what(self) -> &'static str {
                match self {
                    $(Self::$refusal => $what,)*
                }
            }
        }
    };
}

refusals! {
    Sequence = 1, "sequence", "A write before this one was lost: its number is not `next`.";
    Busy = 2, "busy", "The request cannot be executed now: try again.";
    Session = 3, "session", "The request does not have the session number of the gateware's owner.";
    SeekEnded = 4, "seek ended",
        "An axis that it names has hit the source of its seek, and the host has not ended the seek.";
    Cut = 5, "cut",
        "A segment that the CUT names neither waits nor runs any more: no axis has dropped any.";
}

impl Refusal {
    /// Its number in the field `reason` of an answer.
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// The reason with this number; `None` if there is none.
    pub fn from_number(number: u8) -> Option<Self> {
        REFUSALS.get(usize::from(number).checked_sub(1)?).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_count_from_one() {
        for (index, refusal) in REFUSALS.into_iter().enumerate() {
            assert_eq!(usize::from(refusal.number()), index + 1);
            assert_eq!(Refusal::from_number(refusal.number()), Some(refusal));
        }
        assert_eq!(Refusal::from_number(0), None);
        assert_eq!(Refusal::from_number(REFUSALS.len() as u8 + 1), None);
    }
}

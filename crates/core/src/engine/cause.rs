//! The stop causes: number, name, meaning, and what the user does about each.
//!
//! An answer of the link has three bits for the number, so there is no room for a ninth cause.

use strum::Display;

/// Cause of a stop. Its number is the value at the engine's `cause` port and in an answer of the
/// link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Display)]
#[strum(serialize_all = "lowercase")]
pub enum Cause {
    /// The e-stop input was asserted.
    #[strum(to_string = "e-stop")]
    EStop = 0,
    /// A second step arrived on an axis that already held one back for its pin timing (promise 6).
    Overrun = 1,
    /// The host violated the segment protocol.
    #[strum(to_string = "segment protocol broken")]
    Protocol = 2,
    /// No valid request arrived within the watchdog's time.
    Watchdog = 3,
    /// V of an axis would have left (-2^63, 2^63).
    Overspeed = 4,
    /// A limit switch was reached.
    Limit = 5,
    /// The queue of an axis was empty after a segment that was not marked LAST.
    Underrun = 6,
    /// The host requested the stop.
    Stop = 7,
}

/// All causes, in the order of their numbers.
pub const CAUSES: [Cause; 8] = [
    Cause::EStop,
    Cause::Overrun,
    Cause::Protocol,
    Cause::Watchdog,
    Cause::Overspeed,
    Cause::Limit,
    Cause::Underrun,
    Cause::Stop,
];

impl Cause {
    /// What has happened, in words for the operator: a sentence without its full stop.
    pub const fn meaning(self) -> &'static str {
        self.words().0
    }

    /// What the operator must do before the machine may move again, up to `carrystep stop --clear`.
    pub const fn remedy(self) -> &'static str {
        self.words().1
    }

    /// Meaning and remedy of each cause.
    const fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::EStop => (
                "the e-stop was pressed; all axes stopped at once, without ramps, so motors may have slipped",
                "release it, then `carrystep stop --clear`, and home if the axes were fast",
            ),
            Self::Overrun => (
                "an axis got its steps faster than its driver's pulse times allow; all axes stopped without ramps",
                "`carrystep stop --clear`, home, and send planned moves only: the planner keeps these times",
            ),
            Self::Protocol => (
                "a host broke the segment protocol (a segment for a full queue, a START without a segment, or a \
                 segment of no ticks); all axes stopped without ramps",
                "end every other host of this board, then `carrystep stop --clear`, and home if the axes were fast",
            ),
            Self::Watchdog => (
                "the board heard no host for longer than its watchdog's time, and ramped the axes down",
                "see that the host runs and its cable holds, then `carrystep stop --clear`; plan anew from the \
                 positions, for the rest of the moves was dropped",
            ),
            Self::Overspeed => (
                "a segment drove an axis beyond half a step in a tick; all axes stopped without ramps",
                "`carrystep stop --clear`, home, and send planned moves only: the planner keeps this limit",
            ),
            Self::Limit => (
                "a limit switch was reached",
                "`carrystep stop --clear`, then jog that axis away from the switch",
            ),
            Self::Underrun => (
                "a queue ran dry in the middle of a move, and the axes ramped down: the host sent too slowly",
                "`carrystep stop --clear`, plan anew from the positions, and relieve the computer or raise the baud rate",
            ),
            Self::Stop => ("a host asked for it", "`carrystep stop --clear`"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cause_has_its_number_and_a_remedy_that_clears_the_stop() {
        for (number, cause) in CAUSES.iter().enumerate() {
            assert_eq!(*cause as usize, number);
            assert!(cause.remedy().contains("`carrystep stop --clear`"), "{cause}");
        }
    }
}

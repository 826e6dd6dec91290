//! The table of stop causes: number, name, kind of stop, rank, meaning, and what the user does
//! about each.
//!
//! Everything that names a cause takes it from here: the models, the constants of the kernels and
//! of the proofs, the register map of the clients, and the messages of the commands.
//! `docs/clock-by-clock.md` specifies the same table for those who build gateware, and a test
//! compares the two. To add a cause, add a row here and a row there.

use core::fmt;
use strum::Display;

/// Number of bits of a cause's number, at the engine's `cause` port and in an answer of the link.
pub const CAUSE_BITS: usize = 4;

/// How a cause stops the axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Display)]
#[strum(serialize_all = "lowercase")]
pub enum StopKind {
    /// No new pulse starts, from the next clock on.
    Freeze,
    /// Each axis slows down by its stop acceleration.
    Ramp,
    /// One or the other, as the guard's `limit_freezes` says.
    #[strum(to_string = "freeze or ramp, `limit_freezes`")]
    OfTheBuild,
}

/// What is known about a stop cause.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CauseFacts {
    /// Name in messages, documentation and clients.
    pub name: &'static str,
    /// How it stops the axes.
    pub stops_by: StopKind,
    /// Of several causes in one clock, that of the lowest rank is latched. Causes that a tick finds
    /// share a rank: the axis with the lowest number counts, and within an axis overspeed comes
    /// before limit before underrun.
    pub rank: u8,
    /// True if `culprits` names the axes that it came from; otherwise `culprits` is 0.
    pub has_culprits: bool,
    /// What has happened, in words for the operator: a sentence without its full stop.
    pub meaning: &'static str,
    /// What the operator must do before the machine may move again, up to `carrystep stop --clear`.
    pub remedy: &'static str,
}

/// Declares the enumeration and its table.
macro_rules! causes {
    ($($(#[$what:meta])* $cause:ident = $number:literal, $facts:expr;)*) => {
        /// Cause of a stop. Its number is the value at the engine's `cause` port and in an answer
        /// of the link.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Cause {
            $($(#[$what])* $cause = $number,)*
        }

        /// All causes, in the order of their numbers.
        pub const CAUSES: [Cause; [$($number),*].len()] = [$(Cause::$cause),*];

        impl Cause {
            /// The row of the table.
            pub const fn facts(self) -> CauseFacts {
                match self {
                    $(Self::$cause => $facts,)*
                }
            }
        }
    };
}

causes! {
    /// The e-stop input was asserted.
    EStop = 0, CauseFacts {
        name: "e-stop",
        stops_by: StopKind::Freeze,
        rank: 1,
        has_culprits: false,
        meaning: "the e-stop was pressed; all axes stopped at once, without ramps, so motors may \
                  have slipped",
        remedy: "release it, then `carrystep stop --clear`, and home if the axes were fast",
    };
    /// A second step arrived on an axis that already held one back for its pin timing (promise 6).
    Overrun = 1, CauseFacts {
        name: "overrun",
        stops_by: StopKind::Freeze,
        rank: 0,
        has_culprits: true,
        meaning: "an axis got its steps faster than its driver's pulse times allow; all axes \
                  stopped without ramps",
        remedy: "`carrystep stop --clear`, home, and send planned moves only: the planner keeps \
                 these times",
    };
    /// The host violated the segment protocol.
    Protocol = 2, CauseFacts {
        name: "protocol",
        stops_by: StopKind::Freeze,
        rank: 2,
        has_culprits: false,
        meaning: "a host broke the segment protocol (a segment for a full queue, a START without a \
                  segment, or a segment of no ticks); all axes stopped without ramps",
        remedy: "end every other host of this board, then `carrystep stop --clear`, and home if \
                 the axes were fast",
    };
    /// No valid request arrived within the watchdog's time.
    Watchdog = 3, CauseFacts {
        name: "watchdog",
        stops_by: StopKind::Ramp,
        rank: 4,
        has_culprits: false,
        meaning: "the board heard no host for longer than its watchdog's time, and ramped the axes \
                  down",
        remedy: "see that the host runs and its cable holds, then `carrystep stop --clear`; plan \
                 anew from the positions, for the rest of the moves was dropped",
    };
    /// V of an axis would have left (-2^63, 2^63).
    Overspeed = 4, CauseFacts {
        name: "overspeed",
        stops_by: StopKind::Freeze,
        rank: 3,
        has_culprits: true,
        meaning: "a segment drove an axis beyond half a step in a tick; all axes stopped without \
                  ramps",
        remedy: "`carrystep stop --clear`, home, and send planned moves only: the planner keeps \
                 this limit",
    };
    /// A limit switch was reached.
    Limit = 5, CauseFacts {
        name: "limit",
        stops_by: StopKind::OfTheBuild,
        rank: 3,
        has_culprits: true,
        meaning: "a limit switch was reached",
        remedy: "`carrystep stop --clear`, then jog that axis away from the switch",
    };
    /// The queue of an axis was empty after a segment that was not marked LAST.
    Underrun = 6, CauseFacts {
        name: "underrun",
        stops_by: StopKind::Ramp,
        rank: 3,
        has_culprits: true,
        meaning: "a queue ran dry in the middle of a move, and the axes ramped down: the host sent \
                  too slowly",
        remedy: "`carrystep stop --clear`, plan anew from the positions, and relieve the computer \
                 or raise the baud rate",
    };
    /// The host requested the stop.
    Stop = 7, CauseFacts {
        name: "stop",
        stops_by: StopKind::Ramp,
        rank: 6,
        has_culprits: false,
        meaning: "a host asked for it",
        remedy: "`carrystep stop --clear`",
    };
    /// The interlock is open: a door of the machine, for example.
    Interlock = 8, CauseFacts {
        name: "interlock",
        stops_by: StopKind::Ramp,
        rank: 5,
        has_culprits: false,
        meaning: "the interlock was opened (a door, for example), and the axes ramped down; the \
                  drivers keep their power",
        remedy: "close it, then `carrystep stop --clear`",
    };
}

const _: () = assert!(CAUSES.len() <= 1 << CAUSE_BITS);

impl Cause {
    /// The cause with this number; `None` if there is none.
    pub fn from_number(number: u8) -> Option<Self> {
        CAUSES.get(usize::from(number)).copied()
    }

    /// Name in messages, documentation and clients.
    pub const fn name(self) -> &'static str {
        self.facts().name
    }

    /// What has happened, in words for the operator: a sentence without its full stop.
    pub const fn meaning(self) -> &'static str {
        self.facts().meaning
    }

    /// What the operator must do before the machine may move again, up to `carrystep stop --clear`.
    pub const fn remedy(self) -> &'static str {
        self.facts().remedy
    }

    /// True if this cause freezes the axes at once, so that their motors may lose steps; false if
    /// the axes slow down in a ramp. `limit_freezes` is the guard's.
    pub const fn freezes(self, limit_freezes: bool) -> bool {
        match self.facts().stops_by {
            StopKind::Freeze => true,
            StopKind::Ramp => false,
            StopKind::OfTheBuild => limit_freezes,
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::format;
    use alloc::vec::Vec;

    #[test]
    fn every_cause_has_its_number_and_a_remedy_that_clears_the_stop() {
        for (number, cause) in CAUSES.iter().enumerate() {
            assert_eq!(*cause as usize, number);
            assert_eq!(Cause::from_number(number as u8), Some(*cause));
            assert!(cause.remedy().contains("`carrystep stop --clear`"), "{cause}");
        }
        assert_eq!(Cause::from_number(CAUSES.len() as u8), None);
    }

    /// The page states number, name, kind of stop, rank and culprits of each cause in a table.
    #[test]
    fn the_contract_page_specifies_this_table() {
        let page = include_str!("../../../../docs/clock-by-clock.md");
        let (_, rows) = page.split_once("| | cause | stops by |").expect("the table of causes");
        let rows: Vec<&str> = rows.lines().skip(2).take_while(|row| row.starts_with('|')).collect();
        assert_eq!(rows.len(), CAUSES.len());
        for (row, cause) in rows.iter().zip(CAUSES) {
            let CauseFacts { name, stops_by, rank, has_culprits, .. } = cause.facts();
            let culprits = if has_culprits { "yes " } else { "" };
            let wanted = format!("| {} | {name} | {stops_by} | {rank} | {culprits}| ", cause as u8);
            assert!(row.starts_with(&wanted), "{row}\nis not\n{wanted}");
        }
    }
}

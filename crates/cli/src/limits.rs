//! Refuses a motion that begins toward a limit switch that is closed already.
//!
//! With a switch at each end, the board stops an axis that moves toward a closed switch. With one
//! input for both ends or for all axes, it stops an axis only when the switch closes, because it
//! cannot know at which end the axis stands. The command therefore reads the switches first, and
//! remembers in which direction an axis has met its limit.

use crate::belt_ways::EITHER;
use crate::connection::{ConnectedBoard, ConnectedBoardError};
use crate::failure::Failure;
use carrystep_core::engine::LimitWiring;
use carrystep_link::registers::INPUTS;

/// The limit switches that are closed, by their debounced states: one bit per axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClosedLimits {
    /// At the low ends, or with one input for both ends.
    pub low: u8,
    /// At the high ends.
    pub high: u8,
}

impl ClosedLimits {
    /// Reads them from the board.
    ///
    /// # Errors
    /// The board does not answer.
    pub fn read(board: &mut ConnectedBoard) -> Result<Self, ConnectedBoardError> {
        let [low, high, ..] = board.register(INPUTS)?.to_le_bytes();
        Ok(Self { low, high })
    }

    /// Whether a switch of this axis is closed.
    pub const fn any(self, axis: usize) -> bool {
        (self.low | self.high) >> axis & 1 == 1
    }

    /// The first axis whose letter would move toward a closed switch in a motion that begins with these
    /// directions, 1, -1 or 0 for each axis. `met` are the directions in which the axes have met
    /// limits whose switches are still closed, as far as they are known; [`EITHER`] is one or the other.
    pub fn blocked(
        self,
        wiring: LimitWiring,
        directions: &[i8],
        met: &[Option<i8>],
    ) -> Option<Blocked> {
        for (axis, &direction) in directions.iter().enumerate().filter(|(_, way)| **way != 0) {
            let closed = |mask: u8| mask >> axis & 1 == 1;
            let toward = match wiring {
                LimitWiring::None => continue,
                LimitWiring::Pair if closed(if direction < 0 { self.low } else { self.high }) => {
                    Some(direction)
                }
                LimitWiring::Pair => continue,
                LimitWiring::Each | LimitWiring::One if !closed(self.low) => continue,
                // With one input for all, the switch is that of an axis that has met it.
                LimitWiring::One if met[axis].is_none() && met.iter().any(Option::is_some) => {
                    continue;
                }
                LimitWiring::Each | LimitWiring::One => met[axis],
            };
            let is_known = toward.is_some_and(|toward| toward != EITHER);
            if !is_known || toward == Some(direction) {
                return Some(Blocked { axis, direction, is_known });
            }
        }
        None
    }

    /// Checks such a motion.
    ///
    /// # Errors
    /// An axis would move toward a closed switch, or it is not known at which end the closed switch
    /// of an axis is. The message names the axis and what to do.
    pub fn check(
        self,
        wiring: LimitWiring,
        directions: &[i8],
        met: &[Option<i8>],
        axes: &[String],
    ) -> Result<(), Failure> {
        let Some(Blocked { axis, direction, is_known }) = self.blocked(wiring, directions, met)
        else {
            return Ok(());
        };
        let axis = &axes[axis];
        let [further, away] = ways(direction);
        Err(Failure::input(if is_known {
            format!(
                "the limit switch of axis {axis} is closed, and the axis would move further \
                 {further}: jog it {away} until the switch is open, or home it; --into-limit moves it \
                 {further} all the same"
            )
        } else {
            format!(
                "the limit switch of axis {axis} is closed, and it is not known at which end: home \
                 the axis, or move it away from the switch with --into-limit"
            )
        }))
    }
}

/// An axis that would move toward a closed switch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Blocked {
    /// Its number.
    pub axis: usize,
    /// 1 or -1.
    pub direction: i8,
    /// Whether it is known that the switch is at this end.
    pub is_known: bool,
}

/// A direction and the other one, in words.
pub const fn ways(direction: i8) -> [&'static str; 2] {
    if direction > 0 { ["forward", "back"] } else { ["back", "forward"] }
}

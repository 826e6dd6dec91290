//! Refuses a motion that begins toward a limit switch that is closed already.
//!
//! With a switch at each end, the board stops an axis that moves toward a closed switch. With one
//! input for both ends or for all axes, it stops an axis only when the switch closes, because it
//! cannot know at which end the axis stands. The command therefore reads the switches first, and
//! remembers in which direction an axis has met its limit.

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

    /// Checks a motion that begins with these directions, 1, -1 or 0 for each axis. `met` are the
    /// directions in which the axes have met limits whose switches are still closed, as far as they
    /// are known.
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
        for (number, &direction) in directions.iter().enumerate().filter(|(_, way)| **way != 0) {
            let closed = |mask: u8| mask >> number & 1 == 1;
            let toward = match wiring {
                LimitWiring::None => continue,
                LimitWiring::Pair if closed(if direction < 0 { self.low } else { self.high }) => {
                    Some(direction)
                }
                LimitWiring::Pair => continue,
                LimitWiring::Each | LimitWiring::One if !closed(self.low) => continue,
                // With one input for all, the switch is that of an axis that has met it.
                LimitWiring::One if met[number].is_none() && met.iter().any(Option::is_some) => {
                    continue;
                }
                LimitWiring::Each | LimitWiring::One => met[number],
            };
            let (axis, further) = (&axes[number], if direction > 0 { "forward" } else { "back" });
            let away = if direction > 0 { "back" } else { "forward" };
            match toward {
                Some(toward) if toward == direction => {
                    return Err(Failure::input(format!(
                        "the limit switch of axis {axis} is closed, and the axis would move further {further}: jog it {away} \
                         until the switch is open, or home it; --into-limit moves it {further} all the same"
                    )));
                }
                Some(_) => {}
                None => {
                    return Err(Failure::input(format!(
                        "the limit switch of axis {axis} is closed, and it is not known at which end: home the axis, or move it \
                         away from the switch with --into-limit"
                    )));
                }
            }
        }
        Ok(())
    }
}

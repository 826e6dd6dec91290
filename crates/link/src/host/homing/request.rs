//! What homing is asked for, and how it may end.

use crate::registers::MOST_AXES;
use crate::travel::{Gait, TooLong, Travel};
use core::fmt;
use thiserror::Error;

/// Axes of the largest build.
pub(super) const AXES: usize = MOST_AXES as usize;

/// How the limit switches are wired.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wiring {
    /// An input for each end of each axis. A limit counts while it is closed and the axis moves toward it.
    Pair,
    /// An input for each axis, for both ends. A limit counts as it closes: one that is closed already is not seen.
    Each,
    /// One input for all axes. As `Each`; a switch of any axis that is closed hides all others.
    One,
}

/// How one axis homes; distances are in steps, 1 or more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisHoming {
    /// The switch is at the high end: the way to it is positive.
    pub toward_max: bool,
    /// The speed from which the axis starts, 2^-64 step per tick.
    pub start: u64,
    /// Acceleration, 2^-64 step per tick^2.
    pub accel: u64,
    /// Speed of the search, 2^-64 step per tick.
    pub seek: u64,
    /// Speed of the approach, 2^-64 step per tick.
    pub slow: u64,
    /// How far it moves away before each search.
    pub move_off: u32,
    /// How far it searches at the most.
    pub max_travel: u32,
    /// How far from the switch it rests at the end.
    pub pull_off: u32,
}

/// How a machine homes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Homing<'a> {
    /// How its switches are wired.
    pub wiring: Wiring,
    /// The axes that home.
    pub axes: [Option<AxisHoming>; AXES],
    /// Groups of axes, a bit each: one group after the other, the axes of a group together where the wiring allows it.
    pub groups: &'a [u8],
    /// In the wiring `One`: axes of no group that move off first as well, for their switches would hide the others.
    pub others: u8,
    /// Ticks from one look at a limit to the next.
    pub round: u32,
    /// Looks until a level is accepted.
    pub debounce: u32,
}

/// What an axis does in homing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// It moves away from its switch, before anything else.
    MoveOff,
    /// It searches, fast.
    Seek,
    /// It moves away again.
    BackOff,
    /// It approaches slowly.
    Approach,
    /// It moves to where it rests.
    PullOff,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::MoveOff => "moves off",
            Self::Seek => "seeks",
            Self::BackOff => "backs off",
            Self::Approach => "approaches",
            Self::PullOff => "pulls off",
        })
    }
}

/// Why an axis did not find its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum HomingFault {
    /// The search came to its end.
    #[error("no limit was met within max_travel")]
    NotFound,
    /// A limit closed while the axis moved away from its switch.
    #[error("a limit closed while the axis moved away from its switch")]
    Closed,
    /// The switch did not open when the axis moved away from it by `move_off`.
    #[error("the limit is still closed after moving off")]
    StillClosed,
    /// The slow approach did not find the limit that the search had found.
    #[error("the slow approach did not find the limit again")]
    NotAgain,
    /// A move takes too long.
    #[error(transparent)]
    TooLong(TooLong),
}

/// How homing ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Homed {
    /// The positions, in steps of the register, at which the limits were accepted in the slow approach.
    At([i32; AXES]),
    /// It was stopped, as wished.
    Stopped,
}

/// The axes of a mask.
pub(super) fn each(mask: u8) -> impl Iterator<Item = u8> {
    (0..MOST_AXES).filter(move |axis| mask >> axis & 1 == 1)
}

impl Homing<'_> {
    /// The axes of all groups.
    pub fn mask(&self) -> u8 {
        self.groups.iter().fold(0, |mask, group| mask | group) & self.known()
    }

    /// The axes of which it is said how they home.
    pub(super) fn known(&self) -> u8 {
        (0..MOST_AXES).filter(|&axis| self.axis(axis).is_some()).fold(0, |mask, axis| mask | 1 << axis)
    }

    /// Ticks after which a level is accepted that had come before them.
    pub(super) fn settle(&self) -> u32 {
        self.debounce.saturating_add(2).saturating_mul(self.round)
    }

    pub(super) fn axis(&self, axis: u8) -> Option<&AxisHoming> {
        self.axes.get(usize::from(axis))?.as_ref()
    }

    /// Whether all moves can be made: what [`Host::home`] would only find on its way.
    ///
    /// # Errors
    /// [`HomingFault::TooLong`], and the axis.
    pub fn check(&self) -> Result<(), (u8, HomingFault)> {
        for (axis, homing) in each(self.known()).filter_map(|axis| Some((axis, self.axis(axis)?))) {
            for (steps, speed) in [
                (homing.max_travel, homing.seek),
                (homing.move_off.saturating_mul(2), homing.slow),
                (homing.pull_off.saturating_mul(2), homing.seek),
            ] {
                homing.travel(steps, true, speed, 0).map_err(|error| (axis, HomingFault::TooLong(error)))?;
            }
        }
        Ok(())
    }
}

impl AxisHoming {
    /// Toward the switch or away from it, with so many ticks of rest before and behind.
    pub(super) fn travel(&self, steps: u32, toward: bool, speed: u64, rest: u32) -> Result<Travel, TooLong> {
        let steps = i32::try_from(steps).unwrap_or(i32::MAX);
        let steps = if toward == self.toward_max { steps } else { -steps };
        Travel::new(steps, Gait { start: self.start, speed, accel: self.accel }, rest, rest)
    }
}

//! The parameters of homing, and its possible results.

use crate::host::HomingFault;
use crate::registers::MOST_AXES;
use crate::travel::{Gait, TooLong, Travel};
use core::fmt;

/// Number of axes of the largest build.
pub(super) const AXES: usize = MOST_AXES as usize;

/// Lowest bit of the row in the source of a seek.
const SEEK_ROW: u32 = 3;
/// Bit of the source of a seek: each axis waits for its own switch.
const SEEK_OWN: u8 = 1 << 5;
/// Bit of the source of a seek: it waits for the active level.
const SEEK_LEVEL: u8 = 1 << 6;

/// Wiring of the limit switches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wiring {
    /// One input for each end of each axis. A limit is reached while its input is closed and the
    /// axis moves toward it.
    Pair,
    /// One input for each axis, shared by both ends. A limit is reached when the input closes; a
    /// switch that is closed already is not detected.
    Each,
    /// One input for all axes, otherwise as `Each`. A closed switch of any axis hides all others.
    One,
}

/// Homing parameters of one axis. Distances are in steps, 1 or more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisHoming {
    /// Whether the switch is at the high end, so that the axis moves toward it in the positive
    /// direction.
    pub toward_max: bool,
    /// Speed at which the axis starts, 2^-64 step per tick.
    pub start: u64,
    /// Acceleration, 2^-64 step per tick^2.
    pub accel: u64,
    /// Speed of the search, 2^-64 step per tick.
    pub seek: u64,
    /// Speed of the approach, 2^-64 step per tick.
    pub slow: u64,
    /// Distance by which the axis moves away before each search, steps.
    pub move_off: u32,
    /// Greatest distance of the search, steps.
    pub max_travel: u32,
    /// Distance from the switch at which the axis rests at the end, steps.
    pub pull_off: u32,
    /// Mask of the motors that make a step forward when the letter moves up by a step: the axis alone,
    /// or both motors of crossed belts, one of which may run backward. Letters with several motors
    /// need the wiring `One`, because each motor waits for a switch that it samples itself.
    pub forward: u8,
    /// Mask of the motors that make a step backward then.
    pub backward: u8,
    /// Mask of the other axes that move the same letter, as the motors of a gantry do; 0 if it moves
    /// its letter alone.
    pub beside: u8,
    /// How far the axis may move further than these, from the beginning of homing on, steps.
    pub most_apart: u32,
}

/// Homing parameters of a machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Homing<'a> {
    /// Wiring of the switches.
    pub wiring: Wiring,
    /// The axes that home, by number.
    pub axes: [Option<AxisHoming>; AXES],
    /// Groups of axes, as masks. The groups home one after the other; the axes of a group home
    /// together if the wiring allows it.
    pub groups: &'a [u8],
    /// For the wiring `One`: mask of axes outside of the groups that also move off first, because
    /// their switches would hide the others.
    pub others: u8,
    /// Time between two samples of a limit, ticks.
    pub round: u32,
    /// Number of equal samples after which a level is accepted.
    pub debounce: u32,
}

/// The stage of homing that an axis is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HomingStage {
    /// It moves away from its switch first.
    MoveOff,
    /// It searches the switch at the seek speed.
    Seek,
    /// It moves away from the switch again.
    BackOff,
    /// It approaches the switch slowly.
    Approach,
    /// It moves to the place where it rests.
    PullOff,
}

impl fmt::Display for HomingStage {
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

/// How homing ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Homed {
    /// The places of the letters at which the slow approach met the limits, in steps of the position
    /// register: its sum over the forward motors of an axis less that over its backward motors.
    At([i32; AXES]),
    /// The caller stopped homing.
    Stopped,
}

/// The numbers of the axes of a mask.
pub(super) fn each(mask: u8) -> impl Iterator<Item = u8> {
    (0..MOST_AXES).filter(move |axis| mask >> axis & 1 == 1)
}

impl Homing<'_> {
    /// The mask of the axes of all groups.
    pub fn mask(&self) -> u8 {
        self.groups.iter().fold(0, |mask, group| mask | group) & self.known()
    }

    /// The mask of the axes whose switches are at their high ends.
    pub(super) fn toward_max(&self) -> u8 {
        let at_max = |axis: &u8| self.axis(*axis).is_some_and(|axis| axis.toward_max);
        each(self.known()).filter(at_max).fold(0, |mask, axis| mask | 1 << axis)
    }

    /// The motors of these axes, as a mask.
    pub(super) fn motors(&self, axes: u8) -> u8 {
        let motors = each(axes).filter_map(|axis| self.axis(axis));
        motors.fold(0, |mask, axis| mask | axis.motors())
    }

    /// Of these axes, those with a motor of this mask.
    pub(super) fn axes_of(&self, axes: u8, motors: u8) -> u8 {
        let is_one = |axis: &u8| self.motors(1 << axis) & motors != 0;
        each(axes).filter(is_one).fold(0, |mask, axis| mask | 1 << axis)
    }

    /// These axes in parts that move one after the other, as letters with common motors must.
    pub(super) fn parts(&self, axes: u8) -> impl Iterator<Item = u8> {
        let is_crossed =
            |axis: &u8| self.axis(*axis).is_some_and(|axis| axis.motors().count_ones() > 1);
        let crossed = each(axes).filter(is_crossed).fold(0, |mask, axis| mask | 1 << axis);
        let alone = each(crossed).map(|axis| 1 << axis);
        core::iter::once(axes & !crossed).chain(alone).filter(|&part| part != 0)
    }

    /// The place of an axis' letter where the motors have these positions, in steps of one motor after
    /// the other: a step of a letter with two motors changes it by 2.
    pub(super) fn place(&self, axis: u8, positions: &[i32; AXES]) -> i32 {
        let at = |motor: u8| positions.get(usize::from(motor)).copied().unwrap_or(0);
        let sum = |motors: u8| each(motors).fold(0_i32, |sum, motor| sum.wrapping_add(at(motor)));
        self.axis(axis).map_or(0, |axis| sum(axis.forward).wrapping_sub(sum(axis.backward)))
    }

    /// Steps of an axis' letter from one place to another. The registers may wrap between them.
    pub(super) fn way(&self, axis: u8, from: i32, to: i32) -> i32 {
        let motors = self.motors(1 << axis).count_ones().max(1);
        to.wrapping_sub(from) / motors as i32
    }

    /// The source for which these axes wait in this stage, as the register SEEK has it; `None` if
    /// they move without waiting. Toward their switches they wait for these, away from them for the
    /// switches at their other ends.
    pub(super) fn source(&self, axes: u8, stage: HomingStage) -> Option<u8> {
        let toward = matches!(stage, HomingStage::Seek | HomingStage::Approach);
        let high = axes & self.toward_max() != 0;
        let row = match self.wiring {
            Wiring::Pair => u8::from(high == toward),
            Wiring::Each | Wiring::One if toward => 0,
            Wiring::Each | Wiring::One => return None,
        };
        Some(row << SEEK_ROW | SEEK_OWN | SEEK_LEVEL)
    }

    /// The mask of the axes that have homing parameters.
    pub(super) fn known(&self) -> u8 {
        (0..MOST_AXES)
            .filter(|&axis| self.axis(axis).is_some())
            .fold(0, |mask, axis| mask | 1 << axis)
    }

    /// Number of ticks after which a level is certainly accepted.
    pub(super) fn settle(&self) -> u32 {
        self.debounce.saturating_add(2).saturating_mul(self.round)
    }

    /// Of these axes and of those that move their letters with them, those that home.
    pub(super) fn with_their_letters(&self, axes: u8) -> u8 {
        let beside = each(axes).filter_map(|axis| self.axis(axis)).map(|axis| axis.beside);
        beside.fold(axes, |mask, beside| mask | beside) & self.known()
    }

    /// Whether a letter has several axes that home.
    pub(super) fn has_letters_of_several(&self) -> bool {
        each(self.mask()).any(|axis| self.axis(axis).is_some_and(|axis| axis.beside != 0))
    }

    /// The axes that have moved further than others of their letters, from these positions to
    /// those, by more than they may.
    pub(super) fn apart(&self, from: &[i32; AXES], to: &[i32; AXES]) -> u8 {
        let way = |axis: u8| {
            let axis = usize::from(axis);
            let place = |positions: &[i32; AXES]| positions.get(axis).copied().unwrap_or(0);
            i64::from(place(to).wrapping_sub(place(from)))
        };
        let is_apart = |axis: &u8| {
            self.axis(*axis).is_some_and(|one| {
                let own = way(*axis);
                each(one.beside).any(|other| {
                    let other = way(other);
                    let further = own.unsigned_abs() >= other.unsigned_abs();
                    further && (own - other).unsigned_abs() > u64::from(one.most_apart)
                })
            })
        };
        each(self.known()).filter(is_apart).fold(0, |mask, axis| mask | 1 << axis)
    }

    pub(super) fn axis(&self, axis: u8) -> Option<&AxisHoming> {
        self.axes.get(usize::from(axis))?.as_ref()
    }

    /// Checks in advance that all moves can be made; otherwise [`Host::home`] would fail on the
    /// way.
    ///
    /// # Errors
    /// The number of the axis, and [`HomingFault::TooLong`].
    pub fn check(&self) -> Result<(), (u8, HomingFault)> {
        for (axis, homing) in each(self.known()).filter_map(|axis| Some((axis, self.axis(axis)?))) {
            for (steps, speed) in [
                (homing.max_travel, homing.seek),
                (homing.move_off.saturating_mul(2), homing.slow),
                (homing.pull_off.saturating_mul(2), homing.seek),
            ] {
                homing
                    .travel(steps, true, speed, 0)
                    .map_err(|error| (axis, HomingFault::TooLong(error)))?;
            }
        }
        Ok(())
    }
}

impl AxisHoming {
    /// The motors that move the letter.
    const fn motors(&self) -> u8 {
        self.forward | self.backward
    }

    /// The move of `steps` steps toward the switch or away from it, with `rest` ticks of rest
    /// before and behind it.
    pub(super) fn travel(
        &self,
        steps: u32,
        toward: bool,
        speed: u64,
        rest: u32,
    ) -> Result<Travel, TooLong> {
        let steps = i32::try_from(steps).unwrap_or(i32::MAX);
        let steps = if toward == self.toward_max { steps } else { -steps };
        Travel::new(steps, Gait { start: self.start, speed, accel: self.accel }, rest, rest)
    }
}

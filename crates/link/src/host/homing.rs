//! Homing: each axis finds the place where its limit switch closes, and rests beside it (docs/homing.md).
//!
//! ```text
//! switch   closed ########|  open
//!                    <----|-----o            1  move off: away by move_off, whatever the switch says
//!                    <====|=======================o   2  seek: fast, up to max_travel
//!                    o----|----------->      3  back off: until move_off away from where the limit was accepted
//!                       <-|------------o     4  approach: slowly; the position is set from here
//!                       o-|----->            5  pull off: rest pull_off away from that place
//! ```

use super::motion::{Ended, Progress, Wish};
use super::{Clock, Host, HostError};
use crate::command::{ProgramError, Segment};
use crate::feeder::Source;
use crate::frame::of_axis;
use crate::line::Line;
use crate::registers::{HOME, LATCHED, MOST_AXES};
use crate::travel::{Gait, TooLong, Travel};
use core::fmt;
use thiserror::Error;

/// Axes of the largest build.
const AXES: usize = MOST_AXES as usize;

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

/// How one move of homing ended.
struct Leg {
    /// Axes that have met their limit,
    met: u8,
    /// and where that was accepted.
    latched: [i32; AXES],
    /// Where the move began.
    begun: [i32; AXES],
}

/// The moves of some axes, started together.
#[derive(Clone, Default)]
struct Moves {
    travels: [Travel; AXES],
    sent: [usize; AXES],
    start: Option<u8>,
}

impl Source for Moves {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        let axis = usize::from(axis);
        let sent = self.sent.get_mut(axis)?;
        let segment = self.travels.get(axis)?.get(*sent)?;
        *sent += 1;
        Some(segment)
    }

    fn start(&mut self) -> Option<u8> {
        self.start.take()
    }
}

/// The axes of a mask.
fn each(mask: u8) -> impl Iterator<Item = u8> {
    (0..MOST_AXES).filter(move |axis| mask >> axis & 1 == 1)
}

/// The element of an axis; what is out of range is zero.
fn at(values: &[i32; AXES], axis: u8) -> i32 {
    values.get(usize::from(axis)).copied().unwrap_or(0)
}

/// How far it is from one position to another; a register may wrap between them.
fn apart(from: i32, to: i32) -> u32 {
    to.wrapping_sub(from).unsigned_abs()
}

impl Homing<'_> {
    /// The axes of all groups.
    pub fn mask(&self) -> u8 {
        self.groups.iter().fold(0, |mask, group| mask | group) & self.known()
    }

    /// The axes of which it is said how they home.
    fn known(&self) -> u8 {
        (0..MOST_AXES).filter(|&axis| self.axis(axis).is_some()).fold(0, |mask, axis| mask | 1 << axis)
    }

    /// Ticks after which a level is accepted that had come before them.
    fn settle(&self) -> u32 {
        self.debounce.saturating_add(2).saturating_mul(self.round)
    }

    fn axis(&self, axis: u8) -> Option<&AxisHoming> {
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
    fn travel(&self, steps: u32, toward: bool, speed: u64, rest: u32) -> Result<Travel, TooLong> {
        let steps = i32::try_from(steps).unwrap_or(i32::MAX);
        let steps = if toward == self.toward_max { steps } else { -steps };
        Travel::new(steps, Gait { start: self.start, speed, accel: self.accel }, rest, rest)
    }
}

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Homes the axes of all groups of a powered machine at rest. `watch` is called after each exchange with the line: with the
    /// axes that move, and what they do. Where it ends otherwise than [`Homed::At`], no axis is homed.
    ///
    /// Every axis first moves away from its switch: a switch that is closed would not be found. A switch that is still closed
    /// then is found only in the wiring `Pair`, where its limit is met at once ([`HomingFault::StillClosed`]).
    ///
    /// # Errors
    /// [`HostError::Homing`] names the axes and what was wrong; else as [`Self::stream`].
    pub fn home(
        &mut self,
        homing: &Homing<'_>,
        mut watch: impl FnMut(u8, Stage, &Progress<'_>) -> Wish,
    ) -> Result<Homed, HostError<L::Error>> {
        homing.check().map_err(|(axis, why)| HostError::Homing { axes: 1 << axis, why })?;
        let beyond = (homing.mask() | homing.others).checked_shr(self.session.axes().into()).unwrap_or(0);
        if beyond != 0 {
            let axis = self.session.axes() + beyond.trailing_zeros() as u8;
            return Err(ProgramError::Axis { axis, axes: self.session.axes() }.into());
        }
        let mut edges = [0; AXES];
        match self.find_all(homing, &mut edges, &mut watch)? {
            Some(()) => Ok(Homed::At(edges)),
            None => Ok(Homed::Stopped),
        }
    }

    /// `None`: stopped.
    fn find_all(
        &mut self,
        homing: &Homing<'_>,
        edges: &mut [i32; AXES],
        watch: &mut impl FnMut(u8, Stage, &Progress<'_>) -> Wish,
    ) -> Result<Option<()>, HostError<L::Error>> {
        let one = homing.wiring == Wiring::One;
        // A switch of any axis would hide the others.
        if one && self.move_off(homing, homing.mask() | homing.others & homing.known(), watch)?.is_none() {
            return Ok(None);
        }
        for group in homing.groups.iter().map(|group| group & homing.known()).filter(|&group| group != 0) {
            if !one && self.move_off(homing, group, watch)?.is_none() {
                return Ok(None);
            }
            let alone = each(group).map(|axis| 1 << axis);
            let together = [group].into_iter().filter(|_| !one);
            for axes in alone.filter(|_| one).chain(together) {
                if self.find(homing, axes, edges, watch)?.is_none() {
                    return Ok(None);
                }
                // One input for all: the switch must be open while the others search. It has opened at this distance before.
                let place = |axis: &AxisHoming| if one { axis.move_off.max(axis.pull_off) } else { axis.pull_off };
                if self.pull_off(homing, axes, edges, place, watch)?.is_none() {
                    return Ok(None);
                }
            }
        }
        if one { self.pull_off(homing, homing.mask(), edges, |axis| axis.pull_off, watch) } else { Ok(Some(())) }
    }

    /// The axes move away from their switches. In the wiring `Pair` an axis may meet the limit of its other end: it is far
    /// enough from its switch then.
    fn move_off(
        &mut self,
        homing: &Homing<'_>,
        axes: u8,
        watch: &mut impl FnMut(u8, Stage, &Progress<'_>) -> Wish,
    ) -> Result<Option<()>, HostError<L::Error>> {
        let far = |_, axis: &AxisHoming| (axis.move_off, false, axis.seek);
        let Some(leg) = self.leg(homing, axes, Stage::MoveOff, far, watch)? else { return Ok(None) };
        if leg.met != 0 && homing.wiring != Wiring::Pair {
            return Err(HostError::Homing { axes: leg.met, why: HomingFault::Closed });
        }
        Ok(Some(()))
    }

    /// The axes search, back off and approach; `edges` are where the approach has met the limits.
    fn find(
        &mut self,
        homing: &Homing<'_>,
        axes: u8,
        edges: &mut [i32; AXES],
        watch: &mut impl FnMut(u8, Stage, &Progress<'_>) -> Wish,
    ) -> Result<Option<()>, HostError<L::Error>> {
        let seek = |_, axis: &AxisHoming| (axis.max_travel, true, axis.seek);
        let Some(found) = self.leg(homing, axes, Stage::Seek, seek, watch)? else { return Ok(None) };
        found.all(homing, axes, HomingFault::NotFound, |axis| axis.seek)?;
        let ran_on = each(axes).fold([0; AXES], |mut ran_on, axis| {
            let rests = self.status.positions.get(usize::from(axis)).copied().unwrap_or(0);
            ran_on
                .get_mut(usize::from(axis))
                .into_iter()
                .for_each(|ran_on| *ran_on = apart(at(&found.latched, axis), rests));
            ran_on
        });
        let ran_on = |axis: u8| ran_on.get(usize::from(axis)).copied().unwrap_or(0);
        let back = |number, axis: &AxisHoming| (axis.move_off.saturating_add(ran_on(number)), false, axis.seek);
        let Some(leg) = self.leg(homing, axes, Stage::BackOff, back, watch)? else { return Ok(None) };
        if leg.met != 0 {
            return Err(HostError::Homing { axes: leg.met, why: HomingFault::Closed });
        }
        // Not further than the search has run already, but for what the approach runs until the level is accepted.
        let near = |number, axis: &AxisHoming| {
            let accepted = (u128::from(axis.slow) * u128::from(homing.settle())).div_ceil(1 << 64) as u32;
            let steps = axis.move_off.saturating_add(ran_on(number)).saturating_add(accepted + 2);
            (steps, true, axis.slow)
        };
        let Some(found) = self.leg(homing, axes, Stage::Approach, near, watch)? else { return Ok(None) };
        found.all(homing, axes, HomingFault::NotAgain, |axis| axis.slow)?;
        for axis in each(axes) {
            edges.get_mut(usize::from(axis)).into_iter().for_each(|edge| *edge = at(&found.latched, axis));
        }
        Ok(Some(()))
    }

    /// The axes move to this distance from their switches.
    fn pull_off(
        &mut self,
        homing: &Homing<'_>,
        axes: u8,
        edges: &[i32; AXES],
        place: impl Fn(&AxisHoming) -> u32,
        watch: &mut impl FnMut(u8, Stage, &Progress<'_>) -> Wish,
    ) -> Result<Option<()>, HostError<L::Error>> {
        let positions = self.status.positions;
        let pull = |number, axis: &AxisHoming| {
            // How far it is from the switch, away from it; it may have run over it.
            let away = at(&positions, number).wrapping_sub(at(edges, number));
            let away = if axis.toward_max { away.wrapping_neg() } else { away };
            let wanted = i32::try_from(place(axis)).unwrap_or(i32::MAX);
            let steps = i64::from(wanted) - i64::from(away);
            (u32::try_from(steps.unsigned_abs()).unwrap_or(u32::MAX), steps < 0, axis.seek)
        };
        let Some(leg) = self.leg(homing, axes, Stage::PullOff, pull, watch)? else { return Ok(None) };
        match leg.met {
            0 => Ok(Some(())),
            axes => Err(HostError::Homing { axes, why: HomingFault::Closed }),
        }
    }

    /// One move of some axes, which all wait for their limits; `None` where it was stopped. A limit that is met stops its axis
    /// only. Behind a move away the axes rest until the level of the switch is accepted.
    fn leg(
        &mut self,
        homing: &Homing<'_>,
        axes: u8,
        stage: Stage,
        wish: impl Fn(u8, &AxisHoming) -> (u32, bool, u64),
        watch: &mut impl FnMut(u8, Stage, &Progress<'_>) -> Wish,
    ) -> Result<Option<Leg>, HostError<L::Error>> {
        let mut moves = Moves { start: Some(axes), ..Moves::default() };
        for (number, axis) in each(axes).filter_map(|number| Some((number, homing.axis(number)?))) {
            let (steps, toward, speed) = wish(number, axis);
            let rest = if toward { 0 } else { homing.settle() };
            let travel = axis
                .travel(steps, toward, speed, rest)
                .map_err(|error| HostError::Homing { axes: 1 << number, why: HomingFault::TooLong(error) })?;
            moves.travels.get_mut(usize::from(number)).into_iter().for_each(|place| *place = travel);
        }
        let begun = self.look()?.positions;
        self.write(HOME, axes.into())?;
        let ended = self.stream(moves, |progress| watch(axes, stage, progress));
        let waits = self.status.answer.homing & axes;
        if matches!(ended, Ok(_) | Err(HostError::Fault { .. })) {
            // No axis waits for a limit from here on, whatever comes.
            self.write(HOME, 0)?;
        }
        if ended? == Ended::Stopped {
            return Ok(None);
        }
        let met = axes & !waits;
        let mut latched = [0; AXES];
        for (axis, place) in (0..).zip(&mut latched).filter(|(axis, _)| met >> axis & 1 == 1) {
            *place = self.register(of_axis(LATCHED, axis))?.cast_signed();
        }
        if met != 0 {
            // An axis that has met its limit rests anywhere in a step: a clear brings it to the middle of one.
            self.stop()?;
            self.clear()?;
        }
        Ok(Some(Leg { met, latched, begun }))
    }
}

impl Leg {
    /// All of these axes have met their limits, and none of them at once.
    fn all<E>(
        &self,
        homing: &Homing<'_>,
        axes: u8,
        missed: HomingFault,
        speed: impl Fn(&AxisHoming) -> u64,
    ) -> Result<(), HostError<E>> {
        match axes & !self.met {
            0 => {}
            axes => return Err(HostError::Homing { axes, why: missed }),
        }
        if homing.wiring != Wiring::Pair {
            return Ok(());
        }
        // A limit that was closed before is found by the first look, one that closes not before it was looked at so often.
        let at_once = |axis: &u8| {
            let Some(homes) = homing.axis(*axis) else { return false };
            let looks = u128::from(homing.round) * 2;
            let reach = 1 + (u128::from(speed(homes)) * looks >> 64) as u32;
            apart(at(&self.begun, *axis), at(&self.latched, *axis)) <= reach
        };
        match each(axes).filter(at_once).fold(0, |mask, axis| mask | 1 << axis) {
            0 => Ok(()),
            axes => Err(HostError::Homing { axes, why: HomingFault::StillClosed }),
        }
    }
}

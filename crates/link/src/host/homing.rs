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
use crate::registers::{HOME, LATCHED};
use crate::travel::Travel;

mod request;

use request::{AXES, each};
pub use request::{AxisHoming, Homed, Homing, HomingFault, Stage, Wiring};

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

/// The element of an axis; what is out of range is zero.
fn at(values: &[i32; AXES], axis: u8) -> i32 {
    values.get(usize::from(axis)).copied().unwrap_or(0)
}

/// How far it is from one position to another; a register may wrap between them.
fn apart(from: i32, to: i32) -> u32 {
    to.wrapping_sub(from).unsigned_abs()
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
            let reach = 1 + ((u128::from(speed(homes)) * looks) >> 64) as u32;
            apart(at(&self.begun, *axis), at(&self.latched, *axis)) <= reach
        };
        match each(axes).filter(at_once).fold(0, |mask, axis| mask | 1 << axis) {
            0 => Ok(()),
            axes => Err(HostError::Homing { axes, why: HomingFault::StillClosed }),
        }
    }
}

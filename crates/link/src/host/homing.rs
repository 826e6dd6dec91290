//! Homing: each axis finds the place where its limit switch closes, and then rests beside it
//! (docs/homing.md).
//!
//! ```text
//! switch   closed ########|  open
//!                    o----|----->            1  move off: away by move_off, if the switch is closed
//!                    <====|=======================o   2  seek: fast, up to max_travel
//!                    o----|----------->      3  back off: to move_off from the accepted limit
//!                       <-|------------o     4  approach: slow; its limit sets the position
//!                       o-|----->            5  pull off: to pull_off from that limit, and rest
//! ```

use super::motion::{Ended, Progress, Wish};
use super::{Clock, HomingFault, Host, HostError};
use crate::command::{ProgramError, Segment};
use crate::feeder::SegmentSource;
use crate::frame::of_axis;
use crate::line::Line;
use crate::registers::{INPUTS, SEEK, SEEK_POSITION};
use crate::travel::Travel;

mod request;

use request::{AXES, each};
pub use request::{AxisHoming, Homed, Homing, HomingStage, Wiring};

/// Index of the limit in [`CAUSES`](crate::registers::CAUSES).
const LIMIT: u8 = 5;

/// Result of one move of homing.
struct Leg {
    /// Mask of the axes that met their limit.
    met: u8,
    /// Position of each of their motors at which the limit was accepted, steps.
    latched: [i32; AXES],
    /// Position of each motor at the start of the move, steps.
    begun: [i32; AXES],
}

/// What a caller is told after each exchange with the line: the mask of the axes that move, the stage
/// and the progress.
type Watch<'a> = dyn FnMut(u8, HomingStage, &Progress<'_>) -> Wish + 'a;

/// Moves of several axes that start together.
#[derive(Clone, Default)]
struct Moves {
    travels: [Travel; AXES],
    sent: [usize; AXES],
    start: Option<u8>,
}

impl SegmentSource for Moves {
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

/// The element of an axis; 0 if the number is out of range.
fn at(values: &[i32; AXES], axis: u8) -> i32 {
    values.get(usize::from(axis)).copied().unwrap_or(0)
}

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Homes the axes of all groups. The machine must have power and be at rest. `watch` is called
    /// after each exchange with the line, with the mask of the axes that move, the stage and the
    /// progress. Unless the result is [`Homed::At`], no axis is homed.
    ///
    /// The debounced states of the switches are read first. An axis whose switch is closed moves away
    /// from it, and the switch must be open afterwards ([`HomingFault::StillClosed`]). With the
    /// wiring `One` a closed switch may be that of any axis, so all of them move away, in any case.
    ///
    /// # Errors
    /// [`HostError::Homing`] gives the axes and the reason. Other errors are those of
    /// [`Self::stream`].
    pub fn home(
        &mut self,
        homing: &Homing<'_>,
        mut watch: impl FnMut(u8, HomingStage, &Progress<'_>) -> Wish,
    ) -> Result<Homed, HostError<L::Error>> {
        homing.check().map_err(|(axis, why)| HostError::Homing { axes: 1 << axis, why })?;
        let beyond = (homing.mask() | homing.others).checked_shr(self.axes().into()).unwrap_or(0);
        if beyond != 0 {
            let axis = self.axes() + beyond.trailing_zeros() as u8;
            return Err(ProgramError::Axis { axis, axes: self.axes() }.into());
        }
        let mut edges = [0; AXES];
        let begun = self.read_status()?.positions;
        // The axes that have moved too far alone, which stops all of them. The positions of several
        // axes at one time are those of a snapshot.
        let mut apart = 0;
        let looks = homing.has_letters_of_several();
        let mut watch = |moving: u8, stage: HomingStage, progress: &Progress<'_>| {
            if let Some(snapshot) = progress.snapshot {
                apart |= homing.apart(&begun, &snapshot.axes.map(|axis| axis.commanded()));
            }
            match watch(moving, stage, progress) {
                _ if apart != 0 => Wish::Stop,
                Wish::GoOn if looks => Wish::Snapshot,
                wish => wish,
            }
        };
        let found = self.find_all(homing, &mut edges, &mut watch)?;
        match found {
            Some(()) => Ok(Homed::At(edges)),
            None if apart != 0 => {
                self.clear()?;
                Err(HostError::Homing { axes: apart, why: HomingFault::Apart })
            }
            None => Ok(Homed::Stopped),
        }
    }

    /// Homes all groups; `None` if homing was stopped.
    fn find_all(
        &mut self,
        homing: &Homing<'_>,
        edges: &mut [i32; AXES],
        watch: &mut Watch<'_>,
    ) -> Result<Option<()>, HostError<L::Error>> {
        let one = homing.wiring == Wiring::One;
        // With one input for all switches, a closed switch of any axis would hide the others, and a
        // switch that bounces may look open: all axes move away from theirs in any case.
        if one {
            let axes = homing.mask() | homing.others & homing.known();
            if self.move_off(homing, axes, watch)?.is_none() {
                return Ok(None);
            }
        }
        // A seek has one source, and with the wiring `Pair` the two ends have a row each: the axes
        // of a group whose switches are at low ends home before the others.
        let ends = |group: u8| match homing.wiring {
            Wiring::Pair => [group & !homing.toward_max(), group & homing.toward_max()],
            Wiring::Each | Wiring::One => [group, 0],
        };
        let groups = homing.groups.iter().flat_map(|group| ends(group & homing.known()));
        for group in groups.filter(|&group| group != 0) {
            if !one {
                // The motors of a letter move off together.
                let closed = homing.with_their_letters(self.closed(homing, group)?);
                if closed != 0 && self.move_off(homing, closed, watch)?.is_none() {
                    return Ok(None);
                }
            }
            let alone = each(group).map(|axis| 1 << axis);
            let together = homing.parts(group).filter(|_| !one);
            for axes in alone.filter(|_| one).chain(together) {
                if self.find(homing, axes, edges, watch)?.is_none() {
                    return Ok(None);
                }
                // With one input for all switches, this switch must be open while the other axes
                // search. It was open at the distance `move_off` before.
                let place = |axis: &AxisHoming| {
                    if one { axis.move_off.max(axis.pull_off) } else { axis.pull_off }
                };
                if self.pull_off(homing, axes, edges, &place, watch)?.is_none() {
                    return Ok(None);
                }
            }
        }
        for part in homing.parts(homing.mask()).filter(|_| one) {
            if self.pull_off(homing, part, edges, &|axis| axis.pull_off, watch)?.is_none() {
                return Ok(None);
            }
        }
        Ok(Some(()))
    }

    /// The axes move away from their switches, letters with common motors one after the other. With
    /// the wiring `Pair` an axis may meet the limit at
    /// its other end; it is then far enough from its switch.
    fn move_off(
        &mut self,
        homing: &Homing<'_>,
        axes: u8,
        watch: &mut Watch<'_>,
    ) -> Result<Option<()>, HostError<L::Error>> {
        let far = |_, axis: &AxisHoming| (axis.move_off, false, axis.seek);
        for part in homing.parts(axes) {
            let Some(leg) = self.leg(homing, part, HomingStage::MoveOff, &far, watch)? else {
                return Ok(None);
            };
            if leg.met != 0 && homing.wiring != Wiring::Pair {
                return Err(HostError::Homing { axes: leg.met, why: HomingFault::Closed });
            }
        }
        self.opened(homing, axes).map(Some)
    }

    /// The axes whose home switches are closed, of these, by their debounced states.
    fn closed(&mut self, homing: &Homing<'_>, axes: u8) -> Result<u8, HostError<L::Error>> {
        let [low, high, ..] = self.register(INPUTS)?.to_le_bytes();
        let at_high_end = if homing.wiring == Wiring::Pair { homing.toward_max() } else { 0 };
        Ok(axes & (low & !at_high_end | high & at_high_end))
    }

    /// Checks that the home switches of these axes are open.
    fn opened(&mut self, homing: &Homing<'_>, axes: u8) -> Result<(), HostError<L::Error>> {
        match self.closed(homing, axes)? {
            0 => Ok(()),
            axes => Err(HostError::Homing { axes, why: HomingFault::StillClosed }),
        }
    }

    /// The axes search, back off and approach. The positions at which the approach met the limits
    /// are stored in `edges`.
    fn find(
        &mut self,
        homing: &Homing<'_>,
        axes: u8,
        edges: &mut [i32; AXES],
        watch: &mut Watch<'_>,
    ) -> Result<Option<()>, HostError<L::Error>> {
        let seek = |_, axis: &AxisHoming| (axis.max_travel, true, axis.seek);
        let Some(found) = self.leg(homing, axes, HomingStage::Seek, &seek, watch)? else {
            return Ok(None);
        };
        found.all(axes, HomingFault::NotFound)?;
        let rests = self.status.positions;
        let ran_on = |axis: u8| {
            let [from, to] = [&found.latched, &rests].map(|places| homing.place(axis, places));
            homing.way(axis, from, to).unsigned_abs()
        };
        let back = |number, axis: &AxisHoming| {
            (axis.move_off.saturating_add(ran_on(number)), false, axis.seek)
        };
        let Some(leg) = self.leg(homing, axes, HomingStage::BackOff, &back, watch)? else {
            return Ok(None);
        };
        if leg.met != 0 {
            return Err(HostError::Homing { axes: leg.met, why: HomingFault::Closed });
        }
        self.opened(homing, axes)?;
        // The approach need not go further than the axis has backed off, plus the distance that it
        // moves while the level is accepted.
        let near = |number, axis: &AxisHoming| {
            let accepted =
                (u128::from(axis.slow) * u128::from(homing.settle())).div_ceil(1 << 64) as u32;
            let steps = axis.move_off.saturating_add(ran_on(number)).saturating_add(accepted + 2);
            (steps, true, axis.slow)
        };
        let Some(found) = self.leg(homing, axes, HomingStage::Approach, &near, watch)? else {
            return Ok(None);
        };
        found.all(axes, HomingFault::NotAgain)?;
        found.moved(homing, axes)?;
        for axis in each(axes) {
            edges
                .get_mut(usize::from(axis))
                .into_iter()
                .for_each(|edge| *edge = homing.place(axis, &found.latched));
        }
        Ok(Some(()))
    }

    /// The axes move to this distance from their switches.
    fn pull_off(
        &mut self,
        homing: &Homing<'_>,
        axes: u8,
        edges: &[i32; AXES],
        place: &dyn Fn(&AxisHoming) -> u32,
        watch: &mut Watch<'_>,
    ) -> Result<Option<()>, HostError<L::Error>> {
        let positions = self.status.positions;
        let pull = |number, axis: &AxisHoming| {
            // Distance from the switch, positive away from it. It is negative if the axis has
            // overrun the switch.
            let away = homing.way(number, at(edges, number), homing.place(number, &positions));
            let away = if axis.toward_max { away.wrapping_neg() } else { away };
            let wanted = i32::try_from(place(axis)).unwrap_or(i32::MAX);
            let steps = i64::from(wanted) - i64::from(away);
            (u32::try_from(steps.unsigned_abs()).unwrap_or(u32::MAX), steps < 0, axis.seek)
        };
        let Some(leg) = self.leg(homing, axes, HomingStage::PullOff, &pull, watch)? else {
            return Ok(None);
        };
        match leg.met {
            0 => Ok(Some(())),
            axes => Err(HostError::Homing { axes, why: HomingFault::Closed }),
        }
    }

    /// One move of several axes, which all wait for their limits; `None` if it was stopped. A limit
    /// stops only the axis that meets it. With one input for both ends of an axis, no axis waits
    /// while it moves away from its switch, which may still be closed. After a move away from the
    /// switch, the axes rest until the level of the switch is accepted.
    fn leg(
        &mut self,
        homing: &Homing<'_>,
        axes: u8,
        stage: HomingStage,
        wish: &dyn Fn(u8, &AxisHoming) -> (u32, bool, u64),
        watch: &mut Watch<'_>,
    ) -> Result<Option<Leg>, HostError<L::Error>> {
        let begun = self.read_status()?.positions;
        let mut leg = Leg { met: 0, latched: [0; AXES], begun };
        // An axis whose limit is met before the start hinders the others from starting.
        let mut left = axes;
        while left != 0 {
            let moves = moves(homing, left, wish)
                .map_err(|(axis, why)| HostError::Homing { axes: 1 << axis, why })?;
            let source = homing.source(left, stage);
            let motors = homing.motors(left);
            if let Some(source) = source {
                self.write(SEEK, u32::from(motors) | u32::from(source) << 8)?;
            }
            let ended = self.stream(moves, |progress| watch(left, stage, progress));
            let waits = if source.is_some() { self.status.answer.seeking } else { motors };
            if source.is_some() && matches!(ended, Ok(_) | Err(HostError::Fault { .. })) {
                // From here on no axis waits for a limit, and those that have met it may move
                // again.
                self.write(SEEK, 0)?;
            }
            if let Err(HostError::Fault { cause: LIMIT, culprits }) = ended
                && source.is_none()
            {
                self.clear()?;
                // One input for all does not tell whose switch it is.
                let axes = match homing.wiring {
                    Wiring::One => left,
                    Wiring::Each | Wiring::Pair => culprits,
                };
                return Err(HostError::Homing { axes, why: HomingFault::Closed });
            }
            let ended = ended?;
            if ended == Ended::Stopped {
                return Ok(None);
            }
            let met = left & !homing.axes_of(left, waits);
            for motor in each(homing.motors(met)) {
                let position = self.register(of_axis(SEEK_POSITION, motor))?.cast_signed();
                leg.latched.get_mut(usize::from(motor)).into_iter().for_each(|at| *at = position);
            }
            if met != 0 {
                // An axis that has met its limit rests at any fraction of a step. A clear sets the
                // fraction to the middle of the step.
                self.stop()?;
                self.clear()?;
            }
            leg.met |= met;
            left = if ended == Ended::SeekEnded && met != 0 { left & !met } else { 0 };
        }
        Ok(Some(leg))
    }
}

/// The moves of the motors of these axes: steps, whether toward the switch, and speed of each as `wish` gives
/// them. A failure names its axis.
fn moves(
    homing: &Homing<'_>,
    axes: u8,
    wish: &dyn Fn(u8, &AxisHoming) -> (u32, bool, u64),
) -> Result<Moves, (u8, HomingFault)> {
    let mut moves = Moves { start: Some(homing.motors(axes)), ..Moves::default() };
    for (number, axis) in each(axes).filter_map(|number| Some((number, homing.axis(number)?))) {
        let (steps, toward, speed) = wish(number, axis);
        let rest = if toward { 0 } else { homing.settle() };
        for (motors, toward) in [(axis.forward, toward), (axis.backward, !toward)] {
            let travel = axis
                .travel(steps, toward, speed, rest)
                .map_err(|error| (number, HomingFault::TooLong(error)))?;
            for motor in each(motors) {
                moves.travels.get_mut(usize::from(motor)).into_iter().for_each(|at| *at = travel);
            }
        }
    }
    Ok(moves)
}

impl Leg {
    /// Checks that all of these axes have met their limits.
    fn all<E>(&self, axes: u8, missed: HomingFault) -> Result<(), HostError<E>> {
        match axes & !self.met {
            0 => Ok(()),
            axes => Err(HostError::Homing { axes, why: missed }),
        }
    }

    /// Checks that each of these axes has moved before it has met its limit. One that was met at
    /// once has closed between the last look at the switches and the start.
    fn moved<E>(&self, homing: &Homing<'_>, axes: u8) -> Result<(), HostError<E>> {
        let at_once =
            |axis: &u8| homing.place(*axis, &self.begun) == homing.place(*axis, &self.latched);
        match each(axes).filter(at_once).fold(0, |mask, axis| mask | 1 << axis) {
            0 => Ok(()),
            axes => Err(HostError::Homing { axes, why: HomingFault::StillClosed }),
        }
    }
}

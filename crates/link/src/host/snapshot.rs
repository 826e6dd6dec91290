//! Snapshots: the state of all axes in one and the same tick, also while they move.

use super::{Clock, Host, HostError};
use crate::frame::of_axis;
use crate::line::Line;
use crate::registers as map;

/// The state of an axis in the tick of a snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct AxisState {
    /// P, the fraction of a step in 2^-64 step.
    pub p: u64,
    /// Position: steps on the pin forward less steps backward.
    pub position: i32,
    /// Ticks of the running segment after the next one; 0 if the axis does not run.
    pub left: u32,
    /// The content of the register STATUS.
    pub status: u32,
}

impl AxisState {
    /// Whether the axis runs a segment.
    pub const fn runs(&self) -> bool {
        self.status & map::STATUS_RUNS != 0
    }

    /// The slot of the running segment, or of the last one that ran; 0 after a clear, and one more
    /// for each segment, modulo the number of slots.
    pub const fn slot(&self) -> u8 {
        (self.status & map::STATUS_SLOT) as u8
    }

    /// Number of segments that wait in the queue.
    pub const fn waiting(&self) -> u8 {
        ((self.status & map::STATUS_WAITING) >> map::STATUS_WAITING.trailing_zeros()) as u8
    }

    /// Steps that were commanded and are not counted in `position` yet, -8 to 7. In a stop it also
    /// counts the steps that a freeze has discarded.
    pub const fn on_way(&self) -> i8 {
        let bits = (self.status & map::STATUS_ON_WAY) >> map::STATUS_ON_WAY.trailing_zeros();
        ((bits << 4) as u8).cast_signed() >> 4
    }

    /// The commanded position in steps, without its fraction, which is `p`.
    pub const fn commanded(&self) -> i32 {
        self.position.wrapping_add(self.on_way() as i32)
    }
}

/// The state of all axes in one tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Snapshot {
    /// Number of the tick, counted from configuration, modulo 2^32.
    pub ticks: u32,
    /// Each axis; those that the build does not have are zero.
    pub axes: [AxisState; map::MOST_AXES as usize],
}

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Takes a snapshot of all axes and reads it. Motion is not affected.
    ///
    /// # Errors
    /// [`HostError::TooLong`] if another host takes snapshots all the time, so that this one is
    /// never read whole. Other errors concern the line.
    pub fn snapshot(&mut self) -> Result<Snapshot, HostError<L::Error>> {
        let begin = self.clock.milliseconds();
        loop {
            self.write(map::SNAPSHOT, 0)?;
            if let Some(snapshot) = self.read_snapshot()? {
                return Ok(snapshot);
            }
            if self.clock.milliseconds().wrapping_sub(begin) > self.patience.change {
                let cause = self.status.answer.cause_name();
                let ms = self.patience.change;
                return Err(HostError::TooLong { what: "the snapshot", cause, ms });
            }
        }
    }

    /// Reads the words of a snapshot; `None` if they are not all of one tick.
    fn read_snapshot(&mut self) -> Result<Option<Snapshot>, HostError<L::Error>> {
        let mut snapshot = Snapshot::default();
        for axis in 0..self.session.axes() {
            let of = |register| of_axis(register, axis);
            let [p_low, p_high, position, left, status, ticks] = self.registers([
                of(map::SNAPSHOT_P_LOW),
                of(map::SNAPSHOT_P_HIGH),
                of(map::SNAPSHOT_POSITION),
                of(map::SNAPSHOT_LEFT),
                of(map::SNAPSHOT_STATUS),
                of(map::SNAPSHOT_TICKS),
            ])?;
            if axis > 0 && ticks != snapshot.ticks {
                return Ok(None);
            }
            snapshot.ticks = ticks;
            let mut state = AxisState {
                p: u64::from(p_high) << 32 | u64::from(p_low),
                position: position.cast_signed(),
                left,
                status,
            };
            if !state.runs() {
                state.left = 0;
            }
            snapshot.axes.get_mut(usize::from(axis)).into_iter().for_each(|place| *place = state);
        }
        Ok(Some(snapshot))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_of_the_status_are_read_with_their_signs() {
        let state = AxisState { status: 0xf0a3, position: -7, ..AxisState::default() };
        assert_eq!(
            (state.slot(), state.runs(), state.waiting(), state.on_way(), state.commanded()),
            (3, true, 2, -1, -8)
        );
        let state = AxisState { status: 0x7000, ..AxisState::default() };
        assert_eq!((state.runs(), state.on_way(), state.commanded()), (false, 7, 7));
    }
}

//! Seeks of several axes with one switch for all, such as the probe.

use super::{AxisState, Clock, Host, HostError};
use crate::frame::of_axis;
use crate::line::Line;
use crate::registers as map;

/// Bit of the row of the switch in the source.
const ROW: u32 = 3;
/// The state of the switch that is the hit.
const LEVEL: u8 = 1 << 6;
/// Bits of an axis in the source, and of a row.
const AXIS: u8 = 7;
const ROWS: u8 = 3;

/// A switch, and the debounced state of it at which a seek ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SeekSource {
    /// Row of the switch, 0 to 3.
    pub row: u8,
    /// Axis in whose time slot it is sampled, 0 to 7.
    pub axis: u8,
    /// Whether the seek ends when the switch is active, or when it is not.
    pub active: bool,
}

impl SeekSource {
    /// The probe: it closes (`contact`), or it opens.
    pub const fn probe(contact: bool) -> Self {
        Self { row: 2, axis: 0, active: contact }
    }
}

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// From now on these axes wait for the switch: at the hit they ramp down, and their queues are
    /// emptied. If the switch has the state already, they are hit at once. Then
    /// [`Self::stream`] sends the move; [`Self::end_seek`] has to follow.
    ///
    /// # Errors
    /// [`HostError::NoSession`] if [`Self::open`] was not called. Other errors concern the line.
    pub fn seek(&mut self, axes: u8, source: SeekSource) -> Result<(), HostError<L::Error>> {
        let SeekSource { row, axis, active } = source;
        let level = if active { LEVEL } else { 0 };
        let byte = (row & ROWS) << ROW | axis & AXIS | level;
        self.write(map::SEEK, u32::from(axes) | u32::from(byte) << 8)
    }

    /// Ends a seek, and waits until the axes rest. If it was hit, the state of all axes in the tick
    /// after the hit is returned (without `left`), otherwise `None`. Then P of the axes has any
    /// value, and must be brought to its start value before other moves.
    ///
    /// # Errors
    /// [`HostError::TooLong`] if the axes do not come to rest; [`HostError::Fault`] if the machine
    /// stops by itself meanwhile. Other errors concern the line.
    pub fn end_seek(
        &mut self,
    ) -> Result<Option<[AxisState; map::MOST_AXES as usize]>, HostError<L::Error>> {
        let hits = self.register(map::CAPTURES)? as u8;
        // A hit from here on is too late: the move is over.
        self.write(map::SEEK, 0)?;
        self.wait("the end of the ramp", |answer| answer.idle || answer.fault)?;
        let answer = self.status.answer;
        if answer.fault {
            return Err(HostError::Fault { cause: answer.cause, culprits: answer.culprits });
        }
        self.read_status()?;
        if hits == 0 {
            return Ok(None);
        }
        let mut states = [AxisState::default(); map::MOST_AXES as usize];
        for (axis, state) in (0..self.axes()).zip(&mut states) {
            let [low, high, position, status] = self.registers([
                of_axis(map::SEEK_P_LOW, axis),
                of_axis(map::SEEK_P_HIGH, axis),
                of_axis(map::SEEK_POSITION, axis),
                of_axis(map::SEEK_STATUS, axis),
            ])?;
            let p = u64::from(high) << 32 | u64::from(low);
            *state = AxisState { p, position: position.cast_signed(), left: 0, status };
        }
        Ok(Some(states))
    }
}

//! Snapshots: the state of all axes in one and the same tick, also while they move. The record of a
//! latch is read in the same way.

use super::{Clock, Host, HostError};
use crate::frame::{Answer, of_axis};
use crate::line::Line;
use crate::registers as map;
use crate::session::Session;
use crate::ticks::TickCount;

/// The words of each axis.
const WORDS: [u8; 5] = [
    map::SNAPSHOT_P_LOW,
    map::SNAPSHOT_P_HIGH,
    map::SNAPSHOT_POSITION,
    map::SNAPSHOT_LEFT,
    map::SNAPSHOT_STATUS,
];

/// Number of words that are read at a time; other reads have room beside them.
const AT_A_TIME: usize = 4;

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
    /// Number of the tick, without the wraps of TICKS ([`TickCount`]).
    pub tick: i64,
    /// Each axis; those that the build does not have are zero.
    pub axes: [AxisState; map::MOST_AXES as usize],
}

/// A snapshot that the gateware has taken and that is being read.
#[derive(Debug, Clone)]
pub(super) struct SnapshotReader {
    /// Number that is added to the address of each word.
    above: u8,
    snapshot: Snapshot,
    ticks: u32,
    /// The words that are missing, one bit each: TICKS, then those of each axis.
    missing: u64,
}

impl SnapshotReader {
    pub(super) fn new(axes: u8) -> Self {
        let count = 1 + WORDS.len() * usize::from(axes);
        Self { above: 0, snapshot: Snapshot::default(), ticks: 0, missing: (1 << count) - 1 }
    }

    /// Reads the registers of the latch in place of those of the snapshot.
    pub(super) fn of_latch(axes: u8) -> Self {
        Self { above: map::LATCH_TICKS - map::SNAPSHOT_TICKS, ..Self::new(axes) }
    }

    /// Address, axis and kind of a word; the kind is an index of [`WORDS`].
    fn word(&self, at: usize) -> (u8, usize, Option<usize>) {
        let Some(at) = at.checked_sub(1) else {
            return (map::SNAPSHOT_TICKS + self.above, 0, None);
        };
        let (axis, kind) = (at / WORDS.len(), at % WORDS.len());
        let address = WORDS.get(kind).copied().unwrap_or(0) + self.above;
        (of_axis(address, axis as u8), axis, Some(kind))
    }

    fn missing(&self) -> impl Iterator<Item = usize> + use<> {
        let missing = self.missing;
        (0..u64::BITS as usize).filter(move |at| missing >> at & 1 == 1)
    }

    /// Requests some of the missing words.
    pub(super) fn ask<const N: usize>(&self, session: &mut Session<N>) {
        for at in self.missing().take(AT_A_TIME) {
            // An error only means that enough reads are in progress.
            let _ = session.read(self.word(at).0);
        }
    }

    /// Takes an answer.
    pub(super) fn hear(&mut self, answer: &Answer) {
        let Some(at) = self.missing().find(|&at| answer.is_read_of(self.word(at).0)) else {
            return;
        };
        self.missing &= !(1 << at);
        let (_, axis, kind) = self.word(at);
        let Some(kind) = kind else {
            self.ticks = answer.data;
            return;
        };
        let Some(state) = self.snapshot.axes.get_mut(axis) else { return };
        match kind {
            0 => state.p |= u64::from(answer.data),
            1 => state.p |= u64::from(answer.data) << 32,
            2 => state.position = answer.data.cast_signed(),
            3 => state.left = answer.data,
            _ => state.status = answer.data,
        }
    }

    /// The snapshot, once all its words were read.
    pub(super) fn whole(&self, ticks: &mut TickCount) -> Option<Snapshot> {
        if self.missing != 0 {
            return None;
        }
        let mut snapshot = Snapshot { tick: ticks.see(self.ticks), ..self.snapshot };
        for state in snapshot.axes.iter_mut().filter(|state| !state.runs()) {
            state.left = 0;
        }
        Some(snapshot)
    }
}

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Takes a snapshot of all axes and reads it. Motion is not affected. While a program is
    /// streamed, [`Wish::Snapshot`](super::Wish::Snapshot) takes one.
    ///
    /// # Errors
    /// [`HostError::NoSession`] if [`Self::open`] was not called. Other errors concern the line.
    pub fn snapshot(&mut self) -> Result<Snapshot, HostError<L::Error>> {
        self.write(map::SNAPSHOT, 0)?;
        self.read_whole(SnapshotReader::new(self.axes()))
    }

    /// Reads all words of a snapshot, or of the record of a latch.
    pub(super) fn read_whole(
        &mut self,
        mut reader: SnapshotReader,
    ) -> Result<Snapshot, HostError<L::Error>> {
        loop {
            if let Some(snapshot) = reader.whole(&mut self.ticks) {
                return Ok(snapshot);
            }
            self.listen();
            reader.ask(&mut self.session);
            self.pump(&mut |answer| reader.hear(answer))?;
        }
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

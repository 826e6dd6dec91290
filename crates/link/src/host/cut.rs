//! A cut: drops the segments behind a named one, in all axes that it names or in none.

use super::{Clock, Host, HostError};
use crate::command::CutSlots;
use crate::line::Line;
use crate::registers::MOST_AXES;
use crate::session::WriteError;

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Drops the segments behind the named ones, and waits for the answer. Returns the number of
    /// segments that each axis has dropped; `None` if the gateware has refused, because a named
    /// segment neither waits nor runs any more. Then no axis has dropped any.
    ///
    /// A slot is that of [`AxisState::slot`](super::AxisState::slot): the next segment has the next
    /// slot, modulo the depth of the queue + 1. What is kept must end in a segment that is the last
    /// of its move, or the host must append others in time.
    ///
    /// # Errors
    /// [`HostError::NoSession`] if [`Self::open`] was not called; [`HostError::Fault`] in a stop.
    /// Other errors concern the line.
    pub fn cut(
        &mut self,
        slots: CutSlots,
    ) -> Result<Option<[u8; MOST_AXES as usize]>, HostError<L::Error>> {
        // The host alone appends segments, so the slot of the last one stays until the cut.
        let before = self.snapshot()?;
        loop {
            match self.session.cut(slots) {
                Ok(()) => break,
                Err(WriteError::Full(_)) => self.pump(|_| ())?,
                Err(WriteError::NoSession) => return Err(HostError::NoSession),
                Err(WriteError::NoPower(error)) => return Err(error.into()),
            }
        }
        while self.session.writing() {
            self.pump(|_| ())?;
        }
        if self.session.cut_refused() {
            return Ok(None);
        }
        let answer = self.status.answer;
        if answer.fault {
            return Err(HostError::Fault { cause: answer.cause, culprits: answer.culprits });
        }
        let mut dropped = [0; MOST_AXES as usize];
        for ((dropped, slot), state) in dropped.iter_mut().zip(slots.0).zip(before.axes) {
            if let Some(slot) = slot {
                let last = state.slot().wrapping_add(state.waiting());
                *dropped = last.wrapping_sub(slot) & self.facts.queue_depth as u8;
            }
        }
        Ok(Some(dropped))
    }
}

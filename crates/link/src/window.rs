//! The window of unacknowledged writes. They are executed in order, each exactly once, and are sent
//! again from the first that is missing.

use crate::frame::{Answer, Body, Refusal};
use crate::registers::WINDOW;
use thiserror::Error;

/// Error: there is no room until answers arrive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("no more requests can be on their way")]
pub struct Full;

/// Up to `N` unacknowledged writes; `N` is at most [`WINDOW`].
#[derive(Debug, Clone)]
pub struct Window<const N: usize> {
    slots: [Body; N],
    /// Slot of the first write.
    at: usize,
    /// Number of writes.
    length: usize,
    /// Sequence number of the first write.
    first: u8,
    /// Number of writes sent in this round. A round sends the writes in order from the first.
    sent: usize,
    /// Number of writes that were sent at least once.
    reached: usize,
    /// Time of the latest of these events, ms: a round's first write was sent, a write was
    /// acknowledged, or a refusal ended a round.
    since: u32,
    /// How many writes behind the missing one the last refused write was; 0 is the missing one
    /// itself. `None` if no write was refused since the last acknowledgement or timeout.
    refused: Option<u8>,
    /// Whether the gateware refused the write as busy, so that the next round must wait.
    busy: bool,
}

impl<const N: usize> Default for Window<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Window<N> {
    const FITS: () = assert!(N > 0 && N <= WINDOW as usize, "1 to 127 writes may be on their way");

    /// An empty window; the first write has the sequence number 0.
    pub fn new() -> Self {
        let () = Self::FITS;
        let slots = [Body::Read { address: 0 }; N];
        Self {
            slots,
            at: 0,
            length: 0,
            first: 0,
            sent: 0,
            reached: 0,
            since: 0,
            refused: None,
            busy: false,
        }
    }

    /// Number of unacknowledged writes.
    pub const fn len(&self) -> usize {
        self.length
    }

    /// Whether all writes are acknowledged.
    pub const fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Number of further writes that there is room for.
    pub const fn room(&self) -> usize {
        N - self.length
    }

    /// The sequence number of the next write that is appended.
    pub const fn next(&self) -> u8 {
        self.first.wrapping_add(self.length as u8)
    }

    /// The sequence number of the next write that is sent.
    pub const fn sending(&self) -> u8 {
        self.first.wrapping_add(self.sent as u8)
    }

    /// Appends a write.
    ///
    /// # Errors
    /// [`Full`] if there is no room.
    pub fn push(&mut self, body: Body) -> Result<(), Full> {
        if self.room() == 0 {
            return Err(Full);
        }
        let slot = (self.at + self.length) % N;
        self.slots.get_mut(slot).map(|place| *place = body).ok_or(Full)?;
        self.length += 1;
        Ok(())
    }

    /// Removes the writes that were never sent; `withdrawn` is called with each. Writes that were
    /// sent in any round stay, because the gateware may have executed them.
    pub fn withdraw(&mut self, mut withdrawn: impl FnMut(&Body)) {
        while self.length > self.reached {
            self.length -= 1;
            self.slots.get((self.at + self.length) % N).into_iter().for_each(&mut withdrawn);
        }
    }

    /// Removes all writes; `removed` is called with each. The gateware must have refused the first
    /// of them: then it has executed none, and the next write has the number of that one.
    pub fn clear(&mut self, removed: impl FnMut(&Body)) {
        self.reached = 0;
        self.withdraw(removed);
        self.go_back(None);
    }

    /// The number and the body of the request to be sent at the time `now`, ms. A new round begins
    /// after `resend` ms without progress. If the gateware was busy, it begins after `pause` ms.
    pub fn transmit(&mut self, now: u32, resend: u32, pause: u32) -> Option<(u8, Body)> {
        let waited = now.wrapping_sub(self.since);
        if self.sent > 0 && self.length > 0 && waited >= resend {
            self.go_back(None);
        }
        if self.sent >= self.length || (self.busy && waited < pause) {
            return None;
        }
        if self.sent == 0 {
            self.since = now;
        }
        self.busy = false;
        let body = *self.slots.get((self.at + self.sent) % N)?;
        let sequence = self.sending();
        self.sent += 1;
        self.reached = self.reached.max(self.sent);
        Some((sequence, body))
    }

    /// The unacknowledged write that this answers; `None` if it answers another request.
    pub fn answered(&self, answer: &Answer) -> Option<&Body> {
        let behind = usize::from(answer.sequence.wrapping_sub(self.first));
        let sent = answer.written && behind < self.reached;
        let body = self.slots.get((self.at + behind) % N).filter(|_| sent)?;
        (body.address() == answer.address).then_some(body)
    }

    /// Processes the acknowledgement in an answer: all writes before `next` were executed.
    /// `executed` is called with each of them once, in order. An answer whose `next` this host
    /// cannot have caused is from a time before this session, and is ignored. Returns whether it
    /// was taken.
    pub fn answer(&mut self, answer: &Answer, now: u32, mut executed: impl FnMut(&Body)) -> bool {
        let advance = usize::from(answer.next.wrapping_sub(self.first));
        if advance > self.reached {
            return false;
        }
        let refusal = answer.refusal.filter(|_| self.answered(answer).is_some());
        for _ in 0..advance {
            self.slots.get(self.at).into_iter().for_each(&mut executed);
            self.at = (self.at + 1) % N;
        }
        self.first = answer.next;
        self.length -= advance;
        self.reached -= advance;
        self.sent = self.sent.saturating_sub(advance);
        if advance > 0 {
            self.since = now;
            self.refused = None;
            self.busy = false;
        }
        let behind = answer.sequence.wrapping_sub(answer.next);
        match refusal {
            Some(Refusal::Sequence) => self.refusal(behind, false, now),
            Some(Refusal::Busy) => self.refusal(behind, true, now),
            Some(Refusal::Session | Refusal::SeekEnded | Refusal::Cut | Refusal::Other(_))
            | None => {}
        }
        true
    }

    /// Processes a refusal. The gateware refuses every write behind a missing one, so one loss
    /// causes many refusals with rising numbers. The first of them begins a new round; the others
    /// are only recorded. A refusal whose number does not rise is not one of them: it answers a
    /// write of the new round, and begins another round.
    fn refusal(&mut self, behind: u8, busy: bool, now: u32) {
        if self.refused.is_some_and(|before| behind > before) {
            self.refused = Some(behind);
        } else {
            self.go_back(Some(behind));
            self.busy = busy;
            self.since = now;
        }
    }

    fn go_back(&mut self, refused: Option<u8>) {
        self.sent = 0;
        self.refused = refused;
    }
}

//! The window of unacknowledged writes. They are executed in order, each exactly once, and are sent
//! again from the first that is missing.

use crate::frame::{Answer, Body, Request};
use crate::registers::WINDOW;
use thiserror::Error;

/// Error: the gateware's sequence number is not one that this host can have caused. The gateware
/// was restarted, or another host writes to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "the gateware has lost count: it waits for write {next}, this host has {sent} on their way from {first} on; it was restarted, or another host writes to it"
)]
pub struct OutOfStep {
    /// Sequence number that the gateware expects.
    pub next: u8,
    /// Sequence number of the first write that this host considers missing.
    pub first: u8,
    /// Number of writes sent from there on.
    pub sent: u8,
}

/// Error: an answer to a write that this host has not sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "an answer came to write {sequence} at {address:#04x}, which this host has not sent: another host writes to this board at the same time; end one of the two, then stop and clear"
)]
pub struct Foreign {
    /// Sequence number of the answer.
    pub sequence: u8,
    /// Address of the answer.
    pub address: u8,
}

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

impl<const N: usize> Window<N> {
    const FITS: () = assert!(N > 0 && N <= WINDOW as usize, "1 to 127 writes may be on their way");

    /// An empty window; the next write has the sequence number `first`.
    pub fn new(first: u8) -> Self {
        let () = Self::FITS;
        let slots = [Body::Read { address: 0 }; N];
        Self {
            slots,
            at: 0,
            length: 0,
            first,
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

    /// The request to be sent at the time `now`, ms. A new round begins after `resend` ms without
    /// progress. If the gateware was busy, it begins after `pause` ms.
    pub fn transmit(&mut self, now: u32, resend: u32, pause: u32) -> Option<Request> {
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
        let request = Request {
            sequence: self.first.wrapping_add(self.sent as u8),
            body: *self.slots.get((self.at + self.sent) % N)?,
        };
        self.sent += 1;
        self.reached = self.reached.max(self.sent);
        Some(request)
    }

    /// Checks that this answers a write of this host, as far as that can be known. An answer to a
    /// read passes. Of acknowledged writes only the number is left, so a late answer to one of them
    /// passes here too; [`Self::answer`] may still refuse it.
    ///
    /// # Errors
    /// [`Foreign`] if the number was never sent, or was sent with another address.
    pub fn own(&self, answer: &Answer) -> Result<(), Foreign> {
        let behind = answer.sequence.wrapping_sub(self.first);
        if !answer.written || behind > WINDOW {
            return Ok(());
        }
        let slot = self.slots.get((self.at + usize::from(behind)) % N);
        let sent = usize::from(behind) < self.reached
            && slot.is_some_and(|body| body.address() == answer.address);
        if sent {
            Ok(())
        } else {
            Err(Foreign { sequence: answer.sequence, address: answer.address })
        }
    }

    /// Processes the acknowledgement in an answer: all writes before `next` were executed.
    /// `executed` is called with each of them once, in order.
    ///
    /// # Errors
    /// [`OutOfStep`] if the answer acknowledges writes that were never sent, or if its `next` is
    /// older than the first unacknowledged write.
    pub fn answer(
        &mut self,
        answer: &Answer,
        now: u32,
        mut executed: impl FnMut(&Body),
    ) -> Result<(), OutOfStep> {
        let advance = usize::from(answer.next.wrapping_sub(self.first));
        if advance > self.reached {
            return Err(OutOfStep {
                next: answer.next,
                first: self.first,
                sent: self.reached as u8,
            });
        }
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
        if answer.refused && self.length > 0 {
            self.refusal(answer.sequence.wrapping_sub(answer.next), now);
        }
        Ok(())
    }

    /// Processes a refusal. The gateware refuses every write behind a missing one, so one loss
    /// causes many refusals with rising numbers. The first of them begins a new round; the others
    /// are only recorded. A refusal whose number does not rise is not one of them: it answers a
    /// write of the new round, and begins another round.
    fn refusal(&mut self, behind: u8, now: u32) {
        if self.refused.is_some_and(|before| behind > before) {
            self.refused = Some(behind);
        } else {
            self.go_back(Some(behind));
            self.busy = behind == 0;
            self.since = now;
        }
    }

    fn go_back(&mut self, refused: Option<u8>) {
        self.sent = 0;
        self.refused = refused;
    }
}

//! Writes on their way: in order, each executed once, sent again from the first that is missing.

use crate::frame::{Answer, Body, Request};
use crate::registers::{WINDOW, WRITE};
use thiserror::Error;

/// The gateware's count of writes is none that this host can have caused: it was restarted, or someone else writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "the gateware has lost count: it waits for write {next}, this host has {sent} on their way from {first} on; it was restarted, or another host writes to it"
)]
pub struct OutOfStep {
    /// What the gateware waits for.
    pub next: u8,
    /// The first write that this host believes to be missing.
    pub first: u8,
    /// So many were sent from there on.
    pub sent: u8,
}

/// An answer to a write that this host has not sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "an answer came to write {sequence} at {address:#04x}, which this host has not sent: another host writes to this board at the same time; end one of the two, then stop and clear"
)]
pub struct Foreign {
    /// The number in the answer.
    pub sequence: u8,
    /// The address in the answer.
    pub address: u8,
}

/// There is no more room: first some answers must come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("no more requests can be on their way")]
pub struct Full;

/// Up to `N` writes that were not seen executed yet; `N` is at most [`WINDOW`].
#[derive(Debug, Clone)]
pub struct Window<const N: usize> {
    slots: [Body; N],
    /// Slot of the first write, how many there are, and the number of the first.
    at: usize,
    length: usize,
    first: u8,
    /// Sent in this round, and in any.
    sent: usize,
    reached: usize,
    /// When the round began, or the last write was seen executed.
    since: u32,
    /// How far behind the missing write the refusals of this round have come.
    refused: Option<u8>,
    /// The gateware was busy: wait before the next round.
    busy: bool,
}

impl<const N: usize> Window<N> {
    const FITS: () = assert!(N > 0 && N <= WINDOW as usize, "1 to 127 writes may be on their way");

    /// Empty; the next write has this number.
    pub fn new(first: u8) -> Self {
        let () = Self::FITS;
        let slots = [Body::Read { address: 0 }; N];
        Self { slots, at: 0, length: 0, first, sent: 0, reached: 0, since: 0, refused: None, busy: false }
    }

    /// How many were not seen executed yet.
    pub const fn len(&self) -> usize {
        self.length
    }

    /// Whether all were seen executed.
    pub const fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// How many more there is room for.
    pub const fn room(&self) -> usize {
        N - self.length
    }

    /// One more write, to be sent when its turn comes.
    ///
    /// # Errors
    /// [`Full`].
    pub fn push(&mut self, body: Body) -> Result<(), Full> {
        if self.room() == 0 {
            return Err(Full);
        }
        let slot = (self.at + self.length) % N;
        self.slots.get_mut(slot).map(|place| *place = body).ok_or(Full)?;
        self.length += 1;
        Ok(())
    }

    /// Takes back what was never sent; `withdrawn` sees each.
    pub fn withdraw(&mut self, mut withdrawn: impl FnMut(&Body)) {
        while self.length > self.reached {
            self.length -= 1;
            self.slots.get((self.at + self.length) % N).into_iter().for_each(&mut withdrawn);
        }
    }

    /// What is to be sent at this time, ms; `resend` ms without progress begin a new round, `pause` ms pass where the
    /// gateware was busy.
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

    /// Whether this answers a write that was sent from here, as far as that can be known: of writes that were executed
    /// already only the number is left, so a late answer to one of them is believed.
    ///
    /// # Errors
    /// [`Foreign`]: its number was never sent from here, or with another address.
    pub fn own(&self, answer: &Answer) -> Result<(), Foreign> {
        let behind = answer.sequence.wrapping_sub(self.first);
        if answer.address & WRITE == 0 || behind > WINDOW {
            return Ok(());
        }
        let slot = self.slots.get((self.at + usize::from(behind)) % N);
        let sent = usize::from(behind) < self.reached && slot.is_some_and(|body| body.address() == answer.address);
        if sent { Ok(()) } else { Err(Foreign { sequence: answer.sequence, address: answer.address }) }
    }

    /// Takes what an answer says of the writes before `next`; `executed` sees each, once, in order.
    ///
    /// # Errors
    /// [`OutOfStep`]: the answer counts writes that were never sent.
    pub fn answer(&mut self, answer: &Answer, now: u32, mut executed: impl FnMut(&Body)) -> Result<(), OutOfStep> {
        let advance = usize::from(answer.next.wrapping_sub(self.first));
        if advance > self.reached {
            return Err(OutOfStep { next: answer.next, first: self.first, sent: self.reached as u8 });
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

    /// Everything behind a missing write is refused, so one loss brings many refusals: they come with rising numbers,
    /// and only the first of them begins a new round.
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

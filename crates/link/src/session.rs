//! The session: what to send next, and what an answer means. It has no line and no clock; the
//! caller passes bytes and milliseconds.

use crate::command::{CutSlots, ProgramError};
use crate::feeder::{Feeder, SegmentSource};
use crate::frame::{Answer, Body, Refusal, Request, of_axis};
use crate::registers::{
    ANSWER_BYTES, CONTROL, CONTROL_ENABLE, IDENTITY, MOST_AXES, OPEN, POSITION, SEEK, START, STOP,
};
use crate::singles::Singles;
use crate::slip::{Decoder, Received};
use crate::window::{Full, Window};
use core::num::NonZeroU16;
use under_way::{UnderWay, of_mask};

mod error;
mod timing;
mod under_way;

pub use error::{SessionLost, WriteError};
pub use timing::Timing;

/// Bits of SEEK: the axes that wait for the source.
const SEEK_AXES: u32 = 0xff;

/// The dialogue of one host with one gateware, with up to `N` unacknowledged writes.
#[derive(Debug, Clone)]
pub struct Session<const N: usize> {
    decoder: Decoder<ANSWER_BYTES>,
    window: Window<N>,
    singles: Singles,
    timing: Timing,
    /// Number of the session that this host owns; 0 if it owns none.
    number: u16,
    /// Number of the session that this host has asked for; 0 if it has asked for none.
    opening: u16,
    /// Number of axes of the build.
    axes: u8,
    /// What the unacknowledged writes will do.
    under_way: UnderWay,
    /// Number of further segments that the queue of each axis can hold.
    room: [u8; MOST_AXES as usize],
    /// Whether a write was refused because the seek of one of its axes has ended.
    seek_ended: bool,
    /// Whether the last cut was refused.
    cut_refused: bool,
    /// The sequence number of a cut that was refused, until another write with it is acknowledged.
    refused_cut: Option<u8>,
    /// Whether the last write of SEEK named an axis.
    seeking: bool,
    /// Whether a start is armed in the gateware.
    armed: bool,
    /// Whether the last answer reported drivers without power.
    unpowered: bool,
    /// Whether this host has requested power.
    powering: bool,
    /// Number of damaged frames that were received.
    broken: u32,
}

impl<const N: usize> Session<N> {
    /// A dialogue without a session: registers may be read, and the axes may be stopped.
    pub fn new(timing: Timing) -> Self {
        Self {
            decoder: Decoder::default(),
            window: Window::new(),
            singles: Singles::default(),
            timing,
            number: 0,
            opening: 0,
            axes: 0,
            under_way: UnderWay::default(),
            room: [0; MOST_AXES as usize],
            seek_ended: false,
            cut_refused: false,
            refused_cut: None,
            seeking: false,
            armed: false,
            unpowered: false,
            powering: false,
            broken: 0,
        }
    }

    /// Asks for a session with this number with a build of `axes` axes. It is granted if no axis
    /// moves and no segment waits, or if a stop is complete; otherwise the answer to OPEN is
    /// refused as busy, and may be repeated. Writes of an earlier session are forgotten.
    pub fn open(&mut self, number: NonZeroU16, axes: u8) {
        self.leave();
        self.opening = number.get();
        self.axes = axes.min(MOST_AXES);
        self.singles.write(OPEN, 0);
    }

    /// Takes a session with this number for this host's own, to find out by an owner's read whether
    /// the gateware still keeps it.
    pub(crate) fn assume(&mut self, number: NonZeroU16) {
        self.leave();
        self.begin(number.get());
    }

    /// Forgets the session with its writes, and an OPEN without an answer. Reads are free again.
    pub fn leave(&mut self) {
        self.singles.withdraw(OPEN);
        self.opening = 0;
        self.begin(0);
    }

    fn begin(&mut self, number: u16) {
        self.number = number;
        self.window = Window::new();
        self.under_way = UnderWay::default();
        self.room = [0; MOST_AXES as usize];
        self.seek_ended = false;
        self.cut_refused = false;
        self.refused_cut = None;
        self.seeking = false;
        self.powering = false;
    }

    /// Number of the session that this host owns.
    pub const fn number(&self) -> Option<NonZeroU16> {
        NonZeroU16::new(self.number)
    }

    /// Whether an OPEN has no answer yet.
    pub const fn opening(&self) -> bool {
        self.opening != 0
    }

    /// Whether a STOP has no answer yet.
    pub fn stopping(&self) -> bool {
        self.singles.writing(STOP)
    }

    /// Number of damaged frames that were received.
    pub const fn broken(&self) -> u32 {
        self.broken
    }

    /// Whether any answer is outstanding.
    pub fn waiting(&self) -> bool {
        !self.window.is_empty() || self.singles.waiting()
    }

    /// Whether any write is unacknowledged.
    pub fn writing(&self) -> bool {
        !self.window.is_empty()
    }

    /// Whether a SNAPSHOT is unacknowledged.
    pub const fn capturing(&self) -> bool {
        self.under_way.capturing
    }

    /// Whether the gateware has refused a segment or a START because one of its axes has hit the
    /// source of its seek. That write and all behind it were removed, since none of them can be
    /// executed, and [`Self::feed`] queues nothing until this host writes SEEK.
    pub const fn seek_ended(&self) -> bool {
        self.seek_ended
    }

    /// Queues a CUT. Segments that are queued behind it are executed only if it is granted.
    ///
    /// If a CUT was refused and nothing was written since, a write that changes nothing takes its
    /// number: a copy of that CUT may have been refused as well, and the answer would be taken for
    /// that of the new one.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub fn cut(&mut self, slots: CutSlots) -> Result<(), WriteError> {
        if self.refused_cut == Some(self.window.next()) {
            self.write(Body::Write { address: IDENTITY, word: 0 })?;
        }
        self.write(Body::Cut(slots))?;
        self.cut_refused = false;
        Ok(())
    }

    /// Whether a CUT is unacknowledged.
    pub const fn cutting(&self) -> bool {
        self.under_way.cutting
    }

    /// A CUT that was queued drops so many segments of an axis if it is granted: segments behind it
    /// have their room. If it is refused, they are removed with it, and the room is read again.
    pub(crate) fn drops(&mut self, axis: u8, segments: u8) {
        for (_, room) in of_mask(1 << axis, self.room.iter_mut()) {
            *room = room.saturating_add(segments);
        }
    }

    /// Number of further segments that the queue of an axis can hold, as far as this host knows.
    pub(crate) fn room(&self, axis: u8) -> u8 {
        self.room.get(usize::from(axis)).copied().unwrap_or_default()
    }

    /// Whether the gateware has refused the last cut, because a segment that it names neither waits
    /// nor runs any more. The cut and all writes behind it were removed; none was executed.
    pub const fn cut_refused(&self) -> bool {
        self.cut_refused
    }

    /// Whether this host has begun a seek and has not ended it.
    pub const fn seeking(&self) -> bool {
        self.seeking
    }

    /// Starts to read a register; [`Self::receive`] returns the answer.
    ///
    /// # Errors
    /// [`Full`] if eight registers are being read.
    pub fn read(&mut self, address: u8) -> Result<(), Full> {
        self.singles.read(address)
    }

    /// Stops all axes, each with its ramp; no session is needed. Writes that were never sent are
    /// removed.
    pub fn stop(&mut self) {
        self.withdraw();
        self.singles.write(STOP, 0);
    }

    /// Queues a write; writes are executed in order, each exactly once.
    ///
    /// # Errors
    /// [`WriteError::NoSession`] if no session was granted. [`WriteError::Full`] if the window is
    /// full. [`WriteError::NoPower`] for a START if the last answer reported drivers without power
    /// and this host has not requested it; the gateware would refuse the START, and all writes
    /// behind it, for ever.
    pub fn write(&mut self, body: Body) -> Result<(), WriteError> {
        if self.number == 0 {
            return Err(WriteError::NoSession);
        }
        if matches!(body, Body::Write { address: START, .. }) && !self.may_start() {
            return Err(WriteError::NoPower(ProgramError::NoPower));
        }
        self.window.push(body)?;
        self.under_way.add(&body);
        for (_, room) in of_mask(body.axes(), self.room.iter_mut()) {
            *room = room.saturating_sub(1);
        }
        match body {
            Body::Write { address: SEEK, word } => {
                (self.seek_ended, self.seeking) = (false, word & SEEK_AXES != 0);
            }
            Body::Write { address: CONTROL, word } => self.powering = word & CONTROL_ENABLE != 0,
            _ => {}
        }
        Ok(())
    }

    /// Whether the gateware will accept a START, at once or after a while.
    const fn may_start(&self) -> bool {
        self.powering || !self.unpowered
    }

    /// Removes the writes that were never sent, so that the next one is sent at once.
    pub fn withdraw(&mut self) {
        let Self { window, under_way, .. } = self;
        window.withdraw(|body| under_way.settle(body));
    }

    /// Queues as much of a program as there is room for, and reads the state of axes without room.
    /// Returns whether the whole program was queued.
    ///
    /// # Errors
    /// [`ProgramError`]. After [`ProgramError::NoPower`] the program can continue once CONTROL = 1
    /// was written.
    pub fn feed<S: SegmentSource>(&mut self, feeder: &mut Feeder<S>) -> Result<bool, ProgramError> {
        while self.window.room() > 0 && !self.seek_ended {
            let free = !self.under_way.starting && !self.armed;
            let Some(body) = feeder.next(self.axes, &self.room, free && self.may_start())? else {
                if free && !self.may_start() && feeder.start_is_due(self.axes)? {
                    return Err(ProgramError::NoPower);
                }
                break;
            };
            if self.write(body).is_err() {
                break;
            }
        }
        for axis in 0..self.axes {
            let index = usize::from(axis);
            let silent = self.under_way.segments(axis) == 0;
            let full = self.room.get(index) == Some(&0);
            let armed = axis == 0 && self.armed && feeder.wants_start();
            // An error only means that enough reads are in progress.
            let held_back = self.room.get(index).is_some_and(|&room| feeder.holds_back(axis, room));
            if (silent && (held_back || (full && feeder.wants(axis)))) || armed {
                let _ = self.singles.read(of_axis(POSITION, axis));
            }
        }
        Ok(feeder.is_done(self.axes))
    }

    /// The next request to be sent at the time `now`, ms.
    pub fn transmit(&mut self, now: u32) -> Option<Request> {
        let Timing { resend, pause } = self.timing;
        let single = self.singles.transmit(now, resend, self.window.sending());
        let (sequence, body) = single.or_else(|| self.window.transmit(now, resend, pause))?;
        let opens = matches!(body, Body::Write { address: OPEN, .. });
        let session = if opens { self.opening } else { self.number };
        Some(Request { sequence, session, body })
    }

    /// Processes a byte received at the time `now`, ms. Returns the answer if the byte completes
    /// one.
    ///
    /// # Errors
    /// [`SessionLost`] if the gateware has refused a request of this session; this host owns none
    /// from now on.
    pub fn receive(&mut self, byte: u8, now: u32) -> Result<Option<Answer>, SessionLost> {
        let answer = match self.decoder.push(byte) {
            Received::Nothing => return Ok(None),
            Received::Frame(frame) => Answer::from_bytes(frame).ok(),
            Received::Broken => None,
        };
        let Some(answer) = answer else {
            self.broken = self.broken.saturating_add(1);
            return Ok(None);
        };
        self.unpowered = !answer.ready && !answer.fault;
        self.armed = answer.armed;
        let single = self.singles.answer(&answer);
        if answer.written && !single {
            self.singles.answer_of_write(answer.sequence);
        }
        if answer.is_write_of(OPEN) {
            if single {
                let opening = core::mem::take(&mut self.opening);
                self.begin(if answer.refusal.is_none() { opening } else { 0 });
            }
        } else if answer.refusal == Some(Refusal::Session) {
            if self.number != 0 {
                self.leave();
                return Err(SessionLost { answer });
            }
        } else {
            self.count(&answer, now);
        }
        Ok(Some(answer))
    }

    fn count(&mut self, answer: &Answer, now: u32) {
        let axes = match answer.axis() {
            Some(axis) => 1 << axis,
            None => self.window.answered(answer).map_or(0, Body::axes),
        };
        // Such a write can never be executed.
        let ends = matches!(answer.refusal, Some(Refusal::SeekEnded | Refusal::Cut))
            && self.window.answered(answer).is_some();
        let Self { under_way, .. } = self;
        let mut settled = |body: &Body| under_way.settle(body);
        let unacknowledged = self.window.len();
        if !self.window.answer(answer, now, &mut settled) {
            return;
        }
        if self.window.len() < unacknowledged {
            self.refused_cut = None;
        }
        if ends {
            self.window.clear(settled);
            self.seek_ended |= answer.refusal == Some(Refusal::SeekEnded);
            if answer.refusal == Some(Refusal::Cut) {
                self.cut_refused = true;
                self.refused_cut = Some(answer.next);
                self.room = [0; MOST_AXES as usize];
            }
        }
        // An answer says at least how much room there was, and room only grows until this host
        // sends a segment.
        for (axis, room) in of_mask(axes, self.room.iter_mut()) {
            *room = answer.free.saturating_sub(self.under_way.segments(axis)).max(*room);
        }
    }
}

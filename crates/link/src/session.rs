//! The session: what to send next, and what an answer means. It has no line and no clock; the
//! caller passes bytes and milliseconds.

use crate::command::ProgramError;
use crate::feeder::{Feeder, SegmentSource};
use crate::frame::{Answer, Body, Request, of_axis};
use crate::reads::Reads;
use crate::registers::{ANSWER_BYTES, CONTROL, CONTROL_ENABLE, MOST_AXES, POSITION, START};
use crate::slip::{Decoder, Received};
use crate::window::{Foreign, Full, OutOfStep, Window};
use thiserror::Error;

/// Why a write was not accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum WriteError {
    /// There is no room, or [`Session::adopt`] was not called yet.
    #[error(transparent)]
    Full(#[from] Full),
    /// The write is a START, and the drivers have no power.
    #[error(transparent)]
    NoPower(ProgramError),
}

/// Why this host cannot continue with this gateware.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum SessionError {
    /// The gateware acknowledges writes that were never sent.
    #[error(transparent)]
    OutOfStep(#[from] OutOfStep),
    /// The gateware answers another host.
    #[error(transparent)]
    Foreign(#[from] Foreign),
}

/// Waiting times, in milliseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Timing {
    /// Time without an answer until a request is sent again. It must exceed the delay of the line
    /// and its driver.
    pub resend: u32,
    /// Time until a request is sent again that the gateware refused as busy.
    pub pause: u32,
}

impl Default for Timing {
    /// Times for USB serial bridges, which delay an answer by up to 16 ms.
    fn default() -> Self {
        Self { resend: 40, pause: 2 }
    }
}

/// The dialogue of one host with one gateware, with up to `N` unacknowledged writes.
#[derive(Debug, Clone)]
pub struct Session<const N: usize> {
    decoder: Decoder<ANSWER_BYTES>,
    window: Window<N>,
    reads: Reads,
    timing: Timing,
    /// Number of axes of the build; 0 until the gateware's sequence number was adopted.
    axes: u8,
    /// Number of unacknowledged segments of each axis.
    under_way: [u8; MOST_AXES as usize],
    /// Number of further segments that the queue of each axis can hold.
    room: [u8; MOST_AXES as usize],
    /// Whether a start is unacknowledged.
    starting: bool,
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
    /// A session without a known gateware. Registers may be read, but not written.
    pub fn new(timing: Timing) -> Self {
        Self {
            decoder: Decoder::default(),
            window: Window::new(0),
            reads: Reads::default(),
            timing,
            axes: 0,
            under_way: [0; MOST_AXES as usize],
            room: [0; MOST_AXES as usize],
            starting: false,
            armed: false,
            unpowered: false,
            powering: false,
            broken: 0,
        }
    }

    /// Numbers the following writes from `next`, which an answer reported, for a build with this
    /// number of axes.
    pub fn adopt(&mut self, next: u8, axes: u8) {
        self.window = Window::new(next);
        self.axes = axes.min(MOST_AXES);
        self.under_way = [0; MOST_AXES as usize];
        self.room = [0; MOST_AXES as usize];
        self.starting = false;
        self.powering = false;
    }

    /// Number of axes of the build.
    pub const fn axes(&self) -> u8 {
        self.axes
    }

    /// Number of damaged frames that were received.
    pub const fn broken(&self) -> u32 {
        self.broken
    }

    /// Whether any answer is outstanding.
    pub fn waiting(&self) -> bool {
        !self.window.is_empty() || self.reads.waiting()
    }

    /// Whether any write is unacknowledged.
    pub fn writing(&self) -> bool {
        !self.window.is_empty()
    }

    /// Starts to read a register; [`Self::receive`] returns the answer.
    ///
    /// # Errors
    /// [`Full`] if eight registers are being read.
    pub fn read(&mut self, address: u8) -> Result<(), Full> {
        self.reads.ask(address)
    }

    /// Queues a write; writes are executed in order, each exactly once. [`Self::adopt`] must be
    /// called first.
    ///
    /// # Errors
    /// [`WriteError::Full`] if the window is full. [`WriteError::NoPower`] for a START if the last
    /// answer reported drivers without power and this host has not requested it; the gateware would
    /// refuse the START, and all writes behind it, for ever.
    pub fn write(&mut self, body: Body) -> Result<(), WriteError> {
        if self.axes == 0 {
            return Err(Full.into());
        }
        if matches!(body, Body::Write { address: START, .. }) && !self.may_start() {
            return Err(WriteError::NoPower(ProgramError::NoPower));
        }
        self.window.push(body)?;
        match body {
            Body::Segment { axis, .. } => {
                let axis = usize::from(axis);
                self.under_way.get_mut(axis).into_iter().for_each(|count| *count += 1);
                self.room.get_mut(axis).into_iter().for_each(|room| *room = room.saturating_sub(1));
            }
            Body::Write { address: START, .. } => self.starting = true,
            Body::Write { address: CONTROL, word } => self.powering = word & CONTROL_ENABLE != 0,
            Body::Write { .. } | Body::Read { .. } => {}
        }
        Ok(())
    }

    /// Whether the gateware will accept a START, at once or after a while.
    const fn may_start(&self) -> bool {
        self.powering || !self.unpowered
    }

    /// Removes the writes that were never sent, so that the next one is sent at once.
    pub fn withdraw(&mut self) {
        let (under_way, starting) = (&mut self.under_way, &mut self.starting);
        self.window.withdraw(|body| settle(body, under_way, starting));
    }

    /// Queues as much of a program as there is room for, and reads the state of axes without room.
    /// Returns whether the whole program was queued.
    ///
    /// # Errors
    /// [`ProgramError`]. After [`ProgramError::NoPower`] the program can continue once CONTROL = 1
    /// was written.
    pub fn feed<S: SegmentSource>(&mut self, feeder: &mut Feeder<S>) -> Result<bool, ProgramError> {
        while self.window.room() > 0 {
            let free = !self.starting && !self.armed;
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
            let silent = self.under_way.get(index) == Some(&0);
            let full = self.room.get(index) == Some(&0);
            let armed = axis == 0 && self.armed && feeder.wants_start();
            // An error only means that enough reads are in progress.
            if (silent && full && feeder.wants(axis)) || armed {
                let _ = self.reads.ask(of_axis(POSITION, axis));
            }
        }
        Ok(feeder.is_done(self.axes))
    }

    /// The next request to be sent at the time `now`, ms.
    pub fn transmit(&mut self, now: u32) -> Option<Request> {
        let Timing { resend, pause } = self.timing;
        self.reads.transmit(now, resend).or_else(|| self.window.transmit(now, resend, pause))
    }

    /// Processes a byte received at the time `now`, ms. Returns the answer if the byte completes
    /// one.
    ///
    /// # Errors
    /// [`SessionError`] if the answer shows that this host must not continue.
    pub fn receive(&mut self, byte: u8, now: u32) -> Result<Option<Answer>, SessionError> {
        let answer = match self.decoder.push(byte) {
            Received::Nothing => return Ok(None),
            Received::Frame(frame) => Answer::from_bytes(frame).ok(),
            Received::Broken => None,
        };
        let Some(answer) = answer else {
            self.broken = self.broken.saturating_add(1);
            return Ok(None);
        };
        if self.axes > 0 {
            self.count(&answer, now)?;
        }
        self.unpowered = !answer.ready && !answer.fault;
        self.reads.answer(&answer);
        Ok(Some(answer))
    }

    fn count(&mut self, answer: &Answer, now: u32) -> Result<(), SessionError> {
        self.window.own(answer)?;
        let (under_way, starting) = (&mut self.under_way, &mut self.starting);
        self.window.answer(answer, now, |body| settle(body, under_way, starting))?;
        self.armed = answer.armed;
        if let Some(axis) = answer.axis().map(usize::from)
            && let (Some(room), Some(under_way)) =
                (self.room.get_mut(axis), self.under_way.get(axis))
        {
            *room = answer.free.saturating_sub(*under_way);
        }
        Ok(())
    }
}

/// Updates the counts when a write is acknowledged or withdrawn.
fn settle(body: &Body, under_way: &mut [u8], starting: &mut bool) {
    match *body {
        Body::Segment { axis, .. } => {
            under_way
                .get_mut(usize::from(axis))
                .into_iter()
                .for_each(|count| *count = count.saturating_sub(1));
        }
        Body::Write { address: START, .. } => *starting = false,
        Body::Write { .. } | Body::Read { .. } => {}
    }
}

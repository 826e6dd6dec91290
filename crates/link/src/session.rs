//! What to send next and what an answer means; without a line and without a clock: bytes and milliseconds come from outside.

use crate::command::ProgramError;
use crate::feeder::{Feeder, Source};
use crate::frame::{Answer, Body, Request, axis_of, of_axis};
use crate::reads::Reads;
use crate::registers::{ANSWER_BYTES, CONTROL, CONTROL_ENABLE, MOST_AXES, POSITION, START};
use crate::slip::{Decoder, Received};
use crate::window::{Foreign, Full, OutOfStep, Window};
use thiserror::Error;

/// Why a write is not taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum WriteError {
    /// There is no room, or nothing was adopted yet.
    #[error(transparent)]
    Full(#[from] Full),
    /// A START, and the drivers have no power.
    #[error(transparent)]
    NoPower(ProgramError),
}

/// Why this host cannot go on with this gateware.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum SessionError {
    /// It counts writes that were never sent.
    #[error(transparent)]
    OutOfStep(#[from] OutOfStep),
    /// It answers someone else.
    #[error(transparent)]
    Foreign(#[from] Foreign),
}

/// How long to wait, in milliseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Timing {
    /// For an answer, until the request is sent again: more than the line and its driver ever take.
    pub resend: u32,
    /// Where the gateware was busy, until it is asked again.
    pub pause: u32,
}

impl Default for Timing {
    /// For USB serial bridges, which hold an answer back for up to 16 ms.
    fn default() -> Self {
        Self { resend: 40, pause: 2 }
    }
}

/// One host's talk with one gateware, up to `N` writes on their way.
#[derive(Debug, Clone)]
pub struct Session<const N: usize> {
    decoder: Decoder<ANSWER_BYTES>,
    window: Window<N>,
    reads: Reads,
    timing: Timing,
    /// Axes of the build; 0 until the gateware's count of writes was adopted.
    axes: u8,
    /// Segments on their way to each axis, and how many more it takes.
    under_way: [u8; MOST_AXES as usize],
    room: [u8; MOST_AXES as usize],
    /// A start is on its way, or waits in the gateware.
    starting: bool,
    armed: bool,
    /// The last answer came from drivers without power; this host has asked for power.
    unpowered: bool,
    powering: bool,
    broken: u32,
}

impl<const N: usize> Session<N> {
    /// Nothing known yet: registers may be read, nothing may be written.
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

    /// From here on writes are numbered from `next`, which an answer gave, for a build of so many axes.
    pub fn adopt(&mut self, next: u8, axes: u8) {
        self.window = Window::new(next);
        self.axes = axes.min(MOST_AXES);
        self.under_way = [0; MOST_AXES as usize];
        self.room = [0; MOST_AXES as usize];
        self.starting = false;
        self.powering = false;
    }

    /// Axes of the build.
    pub const fn axes(&self) -> u8 {
        self.axes
    }

    /// Frames from the line that were damaged.
    pub const fn broken(&self) -> u32 {
        self.broken
    }

    /// Whether an answer is still to come.
    pub fn waiting(&self) -> bool {
        !self.window.is_empty() || self.reads.waiting()
    }

    /// Whether writes were not seen executed yet.
    pub fn writing(&self) -> bool {
        !self.window.is_empty()
    }

    /// Reads a register: its answer comes out of [`Self::receive`].
    ///
    /// # Errors
    /// [`Full`] where eight are being read.
    pub fn read(&mut self, address: u8) -> Result<(), Full> {
        self.reads.ask(address)
    }

    /// Writes, in order, once; not before [`Self::adopt`].
    ///
    /// # Errors
    /// [`WriteError::Full`]; [`WriteError::NoPower`] for a START that would be refused for ever, and everything behind
    /// it, because the last answer says that the drivers have no power and this host has not asked for it.
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

    /// Whether a START is taken, at once or after a while.
    const fn may_start(&self) -> bool {
        self.powering || !self.unpowered
    }

    /// Takes back the writes that were never sent, so that the next one goes out at once.
    pub fn withdraw(&mut self) {
        let (under_way, starting) = (&mut self.under_way, &mut self.starting);
        self.window.withdraw(|body| settle(body, under_way, starting));
    }

    /// Hands over as much of a program as there is room for; asks axes that have none. Whether it is all handed over.
    ///
    /// # Errors
    /// [`ProgramError`]; after [`ProgramError::NoPower`] the program may go on once CONTROL = 1 was written.
    pub fn feed<S: Source>(&mut self, feeder: &mut Feeder<S>) -> Result<bool, ProgramError> {
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
            // A refusal only means that enough is being asked already.
            if (silent && full && feeder.wants(axis)) || armed {
                let _ = self.reads.ask(of_axis(POSITION, axis));
            }
        }
        Ok(feeder.is_done(self.axes))
    }

    /// The next request to be put on the line at this time, ms.
    pub fn transmit(&mut self, now: u32) -> Option<Request> {
        let Timing { resend, pause } = self.timing;
        self.reads.transmit(now, resend).or_else(|| self.window.transmit(now, resend, pause))
    }

    /// A byte from the line, at this time, ms; the answer that it completes, where it answers this session.
    ///
    /// # Errors
    /// [`SessionError`].
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
        if let Some(axis) = axis_of(answer.address).map(usize::from)
            && let (Some(room), Some(under_way)) = (self.room.get_mut(axis), self.under_way.get(axis))
        {
            *room = answer.free.saturating_sub(*under_way);
        }
        Ok(())
    }
}

/// A write is no longer on its way.
fn settle(body: &Body, under_way: &mut [u8], starting: &mut bool) {
    match *body {
        Body::Segment { axis, .. } => {
            under_way.get_mut(usize::from(axis)).into_iter().for_each(|count| *count = count.saturating_sub(1));
        }
        Body::Write { address: START, .. } => *starting = false,
        Body::Write { .. } | Body::Read { .. } => {}
    }
}

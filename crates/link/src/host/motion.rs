//! Motion: streams a program until the machine has executed it, and jogs one axis.

use super::{Clock, Host, HostError, Status};
use crate::command::{ProgramError, Segment};
use crate::feeder::{Feeder, SegmentSource};
use crate::frame::{Answer, of_axis};
use crate::line::Line;
use crate::registers::POSITION;

/// Progress of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress<'a> {
    /// State of the machine, from the last answers.
    pub status: &'a Status,
    /// Whether the whole program is in the gateware.
    pub handed_over: bool,
}

/// Decision of the caller who watches a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wish {
    /// Continue.
    GoOn,
    /// Stop all axes by their ramps now.
    Stop,
}

/// How a program ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// The whole program was executed.
    Done,
    /// The caller stopped it. Segments still in the queues were discarded.
    Stopped,
}

/// A program of one move of one axis.
struct Jog<'a> {
    axis: u8,
    segments: core::slice::Iter<'a, Segment>,
    start: Option<u8>,
}

impl SegmentSource for Jog<'_> {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        if axis == self.axis { self.segments.next().copied() } else { None }
    }

    fn start(&mut self) -> Option<u8> {
        self.start.take()
    }
}

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Streams a program to a machine at rest, and waits for its end. `watch` is called after each
    /// exchange with the line.
    ///
    /// # Errors
    /// [`HostError::Fault`] if the machine stops by itself. All axes rest by then, and the
    /// positions are exact. [`ProgramError::NoPower`] if [`Self::enable`] was not called; nothing
    /// was sent. Other errors concern the line.
    pub fn stream(
        &mut self,
        source: impl SegmentSource,
        mut watch: impl FnMut(&Progress<'_>) -> Wish,
    ) -> Result<Ended, HostError<L::Error>> {
        let Answer { idle, fault, ready, .. } = self.read_status()?.answer;
        if !idle && !fault {
            return Err(HostError::NotIdle);
        }
        if !ready && !fault {
            return Err(ProgramError::NoPower.into());
        }
        let mut feeder = Feeder::new(source);
        let mut last_status = self.clock.milliseconds();
        loop {
            let handed_over = match self.session.feed(&mut feeder) {
                Ok(done) => done && !self.session.writing(),
                Err(error) => {
                    // The queues must not run empty in the middle of a move: ramp all axes down
                    // first.
                    self.stop()?;
                    return Err(error.into());
                }
            };
            let mut idle = false;
            self.pump(|answer| idle = answer.idle)?;
            let answer = self.status.answer;
            if answer.fault {
                self.wait("the stop", |answer| answer.halted)?;
                while self.session.writing() {
                    self.pump(|_| ())?;
                }
                self.read_status()?;
                return Err(HostError::Fault { cause: answer.cause, culprits: answer.culprits });
            }
            if handed_over && idle {
                self.read_status()?;
                return Ok(Ended::Done);
            }
            if watch(&Progress { status: &self.status, handed_over }) == Wish::Stop {
                self.stop_while(|status| {
                    // The caller watches the ramps too. Its decision has no effect here, because
                    // the axes already stop.
                    let _ = watch(&Progress { status, handed_over });
                })?;
                return Ok(Ended::Stopped);
            }
            let now = self.clock.milliseconds();
            if now.wrapping_sub(last_status) >= self.patience.status_period {
                last_status = now;
                self.listen();
                for axis in 0..self.session.axes() {
                    // An error only means that enough reads are in progress.
                    let _ = self.session.read(of_axis(POSITION, axis));
                }
            }
        }
    }

    /// Moves one axis by these segments; the last of them is marked `last`. Otherwise as
    /// [`Self::stream`].
    ///
    /// # Errors
    /// As [`Self::stream`].
    pub fn jog(
        &mut self,
        axis: u8,
        segments: &[Segment],
        watch: impl FnMut(&Progress<'_>) -> Wish,
    ) -> Result<Ended, HostError<L::Error>> {
        if axis >= self.session.axes() {
            return Err(ProgramError::Axis { axis, axes: self.session.axes() }.into());
        }
        if !segments.last().is_some_and(|segment| segment.last) {
            return Err(ProgramError::NoEnd { axis }.into());
        }
        self.stream(Jog { axis, segments: segments.iter(), start: Some(1 << axis) }, watch)
    }
}

//! Moving: a program into the queues and to its end, and a jog.

use super::{Clock, Host, HostError, Status};
use crate::command::{ProgramError, Segment};
use crate::feeder::{Feeder, Source};
use crate::frame::{Answer, of_axis};
use crate::line::Line;
use crate::registers::POSITION;

/// How a program goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress<'a> {
    /// The machine as of the last answers.
    pub status: &'a Status,
    /// Whether all of the program is in the gateware.
    pub handed_over: bool,
}

/// What whoever watches a program wants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wish {
    /// Let it run.
    GoOn,
    /// Down by the ramps, now.
    Stop,
}

/// How a program ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// All of it was done.
    Done,
    /// It was stopped, as wished: what was queued is gone.
    Stopped,
}

/// One axis, one move.
struct Jog<'a> {
    axis: u8,
    segments: core::slice::Iter<'a, Segment>,
    start: Option<u8>,
}

impl Source for Jog<'_> {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        if axis == self.axis { self.segments.next().copied() } else { None }
    }

    fn start(&mut self) -> Option<u8> {
        self.start.take()
    }
}

impl<L: Line, C: Clock, const N: usize> Host<L, C, N> {
    /// Streams a program to a machine at rest and waits for its end. `watch` is called after each exchange with the line.
    ///
    /// # Errors
    /// [`HostError::Fault`] where the machine stops by itself: all axes rest by then, and the positions are true.
    /// [`ProgramError::NoPower`] before [`Self::enable`]: nothing was sent. Others.
    pub fn stream(
        &mut self,
        source: impl Source,
        mut watch: impl FnMut(&Progress<'_>) -> Wish,
    ) -> Result<Ended, HostError<L::Error>> {
        let Answer { idle, fault, ready, .. } = self.look()?.answer;
        if !idle && !fault {
            return Err(HostError::NotIdle);
        }
        if !ready && !fault {
            return Err(ProgramError::NoPower.into());
        }
        let mut feeder = Feeder::new(source);
        let mut looked = self.clock.milliseconds();
        loop {
            let handed_over = match self.session.feed(&mut feeder) {
                Ok(done) => done && !self.session.writing(),
                Err(error) => {
                    // What is queued already must not run dry: down by the ramps first.
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
                self.look()?;
                return Err(HostError::Fault { cause: answer.cause, culprits: answer.culprits });
            }
            if handed_over && idle {
                self.look()?;
                return Ok(Ended::Done);
            }
            if watch(&Progress { status: &self.status, handed_over }) == Wish::Stop {
                self.stop_while(|status| {
                    // Whoever watches sees the ramps too; more than a stop there is not to be wished.
                    let _ = watch(&Progress { status, handed_over });
                })?;
                return Ok(Ended::Stopped);
            }
            let now = self.clock.milliseconds();
            if now.wrapping_sub(looked) >= self.patience.look {
                looked = now;
                self.listen();
                for axis in 0..self.session.axes() {
                    // A refusal only means that enough is being asked already.
                    let _ = self.session.read(of_axis(POSITION, axis));
                }
            }
        }
    }

    /// Moves one axis by these segments; the last is marked so. Otherwise as [`Self::stream`].
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

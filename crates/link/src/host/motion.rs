//! Motion: streams a program until the machine has executed it, and jogs one axis.

use super::cancelled::CancelledStart;
use super::cutting::Cutting;
use super::snapshot::SnapshotReader;
use super::{Clock, Host, HostError, Snapshot, Status};
use crate::command::{ProgramError, Segment};
use crate::feeder::{Feeder, SegmentSource};
use crate::frame::{Answer, Body, of_axis};
use crate::line::Line;
use crate::registers::{MOST_AXES, POSITION, SNAPSHOT, STATUS, STATUS_SLOT, TICKS};
use crate::session::Session;

/// TICKS is read once in so many reads of the state, for the comparison of the clocks.
const TICKS_PERIOD: u32 = 16;

/// Progress of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress<'a> {
    /// State of the machine, from the last answers.
    pub status: &'a Status,
    /// Whether the whole program is in the gateware.
    pub handed_over: bool,
    /// The last snapshot that was taken on [`Wish::Snapshot`].
    pub snapshot: Option<&'a Snapshot>,
    /// The queues, if the source may cut them.
    pub queues: Option<Queues>,
}

/// What is known of the queues of a program that may be cut, in segments of each axis since the
/// program began. Segments that were cut off do not count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Queues {
    /// Number of segments that every axis has got.
    pub sent: u32,
    /// Number of segments that have begun to run in the axis that is furthest. It may be further by
    /// now: the state is that of the last answers.
    pub begun: u32,
    /// Number of cuts that were granted.
    pub cuts: u32,
}

/// Decision of the caller who watches a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wish {
    /// Continue.
    GoOn,
    /// Continue, and take a snapshot; it appears in [`Progress::snapshot`] some exchanges later.
    /// Ignored while one is being taken, and by calls other than [`Host::stream`] and
    /// [`Host::jog`].
    Snapshot,
    /// Cut the queues of all axes behind their first `keep` segments, of which the last one should
    /// not end before the cut and the next segments have arrived. The source gives what follows
    /// them from now on; its segments are those of all axes in common, with the same ticks. If the
    /// gateware refuses the cut, it calls [`SegmentSource::cut_refused`]. Ignored by calls other
    /// than [`Host::stream`], and if the source did not say that it may cut.
    Cut {
        /// Number of segments that stay, from 1 to [`Queues::sent`].
        keep: u32,
    },
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
    /// An axis of the program has hit the source of its seek while segments or a start for it were
    /// still to be sent. None of them was executed after that; other axes may still move, and their
    /// queues may hold segments: end the seek, then [`Host::stop`] and [`Host::clear`].
    SeekEnded,
}

/// A snapshot of a program that runs.
#[allow(clippy::large_enum_variant, reason = "there is one, on the stack, and no_std has no boxes")]
enum Capture {
    /// None is being taken.
    None,
    /// SNAPSHOT was written.
    Written,
    /// Its words are being read.
    Read(SnapshotReader),
}

impl Capture {
    /// Sends what comes next.
    fn advance<const N: usize>(&mut self, session: &mut Session<N>, axes: u8) {
        if matches!(self, Self::Written) && !session.capturing() {
            *self = Self::Read(SnapshotReader::new(axes));
        }
        if let Self::Read(reader) = self {
            reader.ask(session);
        }
    }
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
    /// [`HostError::NoSession`] if [`Self::open`] was not called.
    /// [`HostError::Fault`] if the machine stops by itself. All axes rest by then, and the
    /// positions are exact. [`ProgramError::NoPower`] if [`Self::enable`] was not called; nothing
    /// was sent. Other errors concern the line.
    pub fn stream(
        &mut self,
        mut source: impl SegmentSource,
        mut watch: impl FnMut(&Progress<'_>) -> Wish,
    ) -> Result<Ended, HostError<L::Error>> {
        self.stream_watched(&mut source, &mut watch)
    }

    /// [`Self::stream`], compiled once for all sources and callers.
    fn stream_watched(
        &mut self,
        source: &mut dyn SegmentSource,
        watch: &mut dyn FnMut(&Progress<'_>) -> Wish,
    ) -> Result<Ended, HostError<L::Error>> {
        if self.session.number().is_none() {
            return Err(HostError::NoSession);
        }
        let Answer { idle, fault, ready, .. } = self.read_status()?.answer;
        if !idle && !fault {
            return Err(HostError::NotIdle);
        }
        if !ready && !fault {
            return Err(ProgramError::NoPower.into());
        }
        let mut cutting = if source.may_cut() { Some(self.cutting()?) } else { None };
        let depth = self.facts.queue_depth.min(STATUS_SLOT) as u8;
        let mut feeder = Feeder::wide(source).with_queues(depth);
        let mut last_status = self.clock.milliseconds();
        let mut looks = 0_u32;
        let (mut capture, mut snapshot) = (Capture::None, None);
        let axes = self.axes();
        let mut cancelled = CancelledStart::default();
        loop {
            capture.advance(&mut self.session, axes);
            let feeds = cutting
                .as_mut()
                .is_none_or(|cutting| cutting.advance(&mut self.session, &mut feeder));
            let fed = if feeds { self.session.feed(&mut feeder) } else { Ok(false) };
            let handed_over = match fed {
                Ok(done) => done && !self.session.writing(),
                Err(error) => {
                    // The queues must not run empty in the middle of a move: ramp all axes down
                    // first.
                    self.stop()?;
                    return Err(error.into());
                }
            };
            let mut idle = false;
            self.pump(&mut |answer| {
                idle = answer.idle;
                cancelled.hear(answer, axes);
                if let Capture::Read(reader) = &mut capture {
                    reader.hear(answer);
                }
            })?;
            if let Capture::Read(reader) = &capture
                && let Some(whole) = reader.whole(&mut self.ticks)
            {
                (capture, snapshot) = (Capture::None, Some(whole));
            }
            let answer = self.status.answer;
            if answer.fault {
                self.wait("the stop", |answer| answer.halted)?;
                while self.session.writing() {
                    self.pump(&mut |_| ())?;
                }
                self.read_status()?;
                return Err(HostError::Fault { cause: answer.cause, culprits: answer.culprits });
            }
            if self.session.seek_ended() || cancelled.is_certain() {
                self.read_status()?;
                return Ok(Ended::SeekEnded);
            }
            if handed_over && idle {
                self.read_status()?;
                return Ok(Ended::Done);
            }
            let snapshot = snapshot.as_ref();
            let queues = cutting.as_mut().map(|cutting| Queues {
                sent: cutting.sent(&feeder),
                begun: cutting.begun(&self.session, &feeder),
                cuts: cutting.granted(),
            });
            match watch(&Progress { status: &self.status, handed_over, snapshot, queues }) {
                Wish::GoOn => {}
                Wish::Cut { keep } => {
                    cutting.iter_mut().for_each(|cutting| cutting.ask(keep));
                }
                Wish::Snapshot if matches!(capture, Capture::None) => {
                    let write = Body::Write { address: SNAPSHOT, word: 0 };
                    if self.session.write(write).is_ok() {
                        capture = Capture::Written;
                    }
                }
                Wish::Snapshot => {}
                Wish::Stop => {
                    self.stop_while(|status| {
                        // The caller watches the ramps too. Its decision has no effect here,
                        // because the axes already stop.
                        let _ = watch(&Progress { status, handed_over, snapshot, queues });
                    })?;
                    return Ok(Ended::Stopped);
                }
            }
            let now = self.clock.milliseconds();
            if now.wrapping_sub(last_status) >= self.patience.status_period {
                last_status = now;
                self.listen();
                // An error only means that enough reads are in progress.
                if looks.is_multiple_of(TICKS_PERIOD) {
                    let _ = self.session.read(TICKS);
                }
                looks = looks.wrapping_add(1);
                for axis in 0..axes {
                    let _ = self.session.read(of_axis(POSITION, axis));
                }
                if handed_over && self.session.seeking() {
                    cancelled.ask(&mut self.session, axes);
                }
            }
        }
    }

    /// The cuts of a program that begins now, at rest.
    fn cutting(&mut self) -> Result<Cutting, HostError<L::Error>> {
        let axes = self.axes();
        let address = |axis: usize| of_axis(STATUS, (axis as u8).min(axes.saturating_sub(1)));
        let status =
            self.registers(core::array::from_fn::<u8, { MOST_AXES as usize }, _>(address))?;
        let status = status.get(..usize::from(axes)).unwrap_or_default();
        Ok(Cutting::new(status, self.facts.queue_depth))
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
        if axis >= self.axes() {
            return Err(ProgramError::Axis { axis, axes: self.axes() }.into());
        }
        if !segments.last().is_some_and(|segment| segment.last) {
            return Err(ProgramError::NoEnd { axis }.into());
        }
        self.stream(Jog { axis, segments: segments.iter(), start: Some(1 << axis) }, watch)
    }
}

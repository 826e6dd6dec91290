//! Checks a capture while it is made: the axes are shared among threads of their own, so that a
//! simulation and the check of its pulses run side by side.
//!
//! ```text
//!  caller    | batch 1 | batch 2 | batch 3 | batch 4 |        makes pin changes
//!  thread 0            | batch 1 | batch 2 | batch 3 | ...    checks axes 0, 2, 4
//!  thread 1            | batch 1 | batch 2 | batch 3 | ...    checks axes 1, 3, 5 and the lines
//! ```
//!
//! Each axis sees its changes in the order of the capture, and nothing else decides its report; the
//! report is therefore that of [`Checker`], byte for byte.

use crate::axis_check::AxisCheck;
use crate::checker::{Checker, Setup};
use crate::edge::{PinChange, PinSink};
use crate::error::TraceError;
use crate::ideal::Due;
use crate::line_check::LinesCheck;
use crate::origin::{Base, RunningOrigin};
use crate::report::CheckReport;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::{self, ScopedJoinHandle, available_parallelism};

/// The number of batches that may wait for a thread; the caller waits when there are more.
const WAITING: usize = 4;

/// The number of changes that a batch holds, if they come one by one.
const BATCH: usize = 1 << 14;

/// Checks the capture that `make` sends to the sink. Returns what `make` returns, and the report.
pub fn check_beside<R>(
    setup: Setup<'_>,
    make: impl FnOnce(&mut dyn PinSink) -> R,
) -> (R, CheckReport) {
    let (made, checker) = go_on_beside(Checker::new(setup), make);
    (made, checker.finish())
}

/// Lets a checker go on with what `make` sends to the sink. Returns what `make` returns, and the
/// checker.
pub(crate) fn go_on_beside<'a, R>(
    checker: Checker<'a>,
    make: impl FnOnce(&mut dyn PinSink) -> R,
) -> (R, Checker<'a>) {
    let Checker { axes, lines, mut origin, slack_ps, phase_ns } = checker;
    let threads = available_parallelism().map_or(1, usize::from).min(axes.len()).max(1);
    let firsts = axes.iter().map(AxisCheck::first).collect();
    let mut shares: Vec<Share<'_>> = (0..threads).map(|_| Share::default()).collect();
    for (number, axis) in axes.into_iter().enumerate() {
        shares[number % threads].axes.push((number, axis));
    }
    shares[threads - 1].lines = lines;
    let (made, shares) = thread::scope(|scope| {
        let mut senders = Vec::new();
        let mut workers = Vec::new();
        for mut share in shares {
            let (sender, receiver) = sync_channel(WAITING);
            senders.push(sender);
            workers.push(scope.spawn(move || {
                receiver.into_iter().for_each(|message| share.take(&message));
                share
            }));
        }
        let mut sender = Sender { origin: &mut origin, firsts, senders, batch: Vec::new() };
        let made = make(&mut sender);
        sender.flush();
        // The threads end when nobody can send to them any more.
        drop(sender);
        let joined = workers.into_iter().map(ScopedJoinHandle::join);
        let shares = joined.map(|share| share.unwrap_or_else(|panic| resume_unwind(panic)));
        (made, shares.collect::<Vec<_>>())
    });
    let mut axes = Vec::new();
    let mut lines = None;
    for share in shares {
        axes.extend(share.axes);
        lines = lines.or(share.lines);
    }
    axes.sort_by_key(|(number, _)| *number);
    let axes = axes.into_iter().map(|(_, axis)| axis).collect();
    (made, Checker { axes, lines, origin, slack_ps, phase_ns })
}

/// What a thread is sent.
#[derive(Clone)]
enum Message {
    /// The level of a pin at the start of the capture.
    Initial(PinChange),
    /// Changes of all axes in the order of the capture, and the origin, ps.
    Changes(Arc<[PinChange]>, Base),
}

/// What one thread checks.
#[derive(Default)]
struct Share<'a> {
    /// Axes with their numbers.
    axes: Vec<(usize, AxisCheck<'a>)>,
    lines: Option<LinesCheck>,
}

impl Share<'_> {
    fn take(&mut self, message: &Message) {
        match message {
            Message::Initial(level) => {
                self.axes
                    .iter_mut()
                    .filter(|(number, _)| *number == usize::from(level.axis))
                    .for_each(|(_, axis)| axis.initial(level.pin, level.level));
                if let Some(lines) = &mut self.lines {
                    lines.initial(*level);
                }
            }
            Message::Changes(changes, base) => {
                for (number, axis) in &mut self.axes {
                    changes
                        .iter()
                        .filter(|change| usize::from(change.axis) == *number)
                        .for_each(|change| axis.change(*change, *base));
                }
                if let Some(lines) = &mut self.lines {
                    changes.iter().for_each(|change| lines.change(*change));
                }
            }
        }
    }
}

/// Sends a capture to all threads.
struct Sender<'a> {
    origin: &'a mut RunningOrigin,
    /// When the first pulse of each axis is due.
    firsts: Vec<Option<Due>>,
    senders: Vec<SyncSender<Message>>,
    /// Changes that came one by one and are not sent yet.
    batch: Vec<PinChange>,
}

impl Sender<'_> {
    /// A thread that does not listen has panicked; the caller learns it when the thread is joined.
    fn send(&self, message: &Message) {
        for sender in &self.senders {
            let _ = sender.send(message.clone());
        }
    }

    fn flush(&mut self) {
        let batch = std::mem::take(&mut self.batch);
        self.send_all(&batch);
    }

    fn send_all(&mut self, changes: &[PinChange]) {
        for change in changes {
            self.origin.estimate(*change, |axis| *self.firsts.get(axis)?);
        }
        if !changes.is_empty() {
            self.send(&Message::Changes(changes.into(), self.origin.base()));
        }
    }
}

impl PinSink for Sender<'_> {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        self.send(&Message::Initial(level));
        Ok(())
    }

    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        self.batch.push(change);
        if self.batch.len() >= BATCH {
            self.flush();
        }
        Ok(())
    }

    fn changes(&mut self, changes: &[PinChange]) -> Result<(), TraceError> {
        self.flush();
        self.send_all(changes);
        Ok(())
    }
}

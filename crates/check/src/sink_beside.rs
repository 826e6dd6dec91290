//! Lets a sink take pin changes in a thread of its own, while they are made.

use crate::edge::{PinChange, PinSink};
use crate::error::TraceError;
use std::panic::resume_unwind;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;

/// The number of batches that may wait for the thread; the caller waits when there are more.
const WAITING: usize = 4;
/// The number of changes that a batch holds, if they come one by one.
const BATCH: usize = 1 << 13;

/// What the thread is sent.
enum Message {
    Initial(PinChange),
    Changes(Vec<PinChange>),
    Outputs(u64, u8),
    Pwm(Vec<(u64, bool)>),
    End(u64),
}

/// Lets a sink take what `make` sends. Returns what `make` returns, and the sink.
///
/// # Errors
/// The first error of the sink.
pub fn sink_beside<S: PinSink + Send, R>(
    sink: S,
    make: impl FnOnce(&mut dyn PinSink) -> R,
) -> Result<(R, S), TraceError> {
    thread::scope(|scope| {
        let (sender, receiver) = sync_channel(WAITING);
        let worker = scope.spawn(move || -> Result<S, TraceError> {
            let mut sink = sink;
            for message in receiver {
                match message {
                    Message::Initial(level) => sink.initial(level)?,
                    Message::Changes(changes) => sink.changes(&changes)?,
                    Message::Outputs(ps, levels) => sink.outputs(ps, levels)?,
                    Message::Pwm(edges) => {
                        edges.into_iter().try_for_each(|(ps, level)| sink.pwm(ps, level))?;
                    }
                    Message::End(ps) => sink.end(ps)?,
                }
            }
            Ok(sink)
        });
        let mut sender = Sender { sender, batch: Vec::new(), pwm: Vec::new() };
        let made = make(&mut sender);
        sender.flush();
        // The thread ends when nobody can send to it any more.
        drop(sender);
        let sink = worker.join().unwrap_or_else(|panic| resume_unwind(panic))?;
        Ok((made, sink))
    })
}

struct Sender {
    sender: SyncSender<Message>,
    batch: Vec<PinChange>,
    pwm: Vec<(u64, bool)>,
}

impl Sender {
    /// A thread that does not listen has failed; the caller learns it when the thread is joined.
    fn send(&self, message: Message) {
        let _ = self.sender.send(message);
    }

    fn flush(&mut self) {
        if !self.batch.is_empty() {
            let batch = std::mem::replace(&mut self.batch, Vec::with_capacity(BATCH));
            self.send(Message::Changes(batch));
        }
        if !self.pwm.is_empty() {
            let edges = std::mem::replace(&mut self.pwm, Vec::with_capacity(BATCH));
            self.send(Message::Pwm(edges));
        }
    }
}

impl PinSink for Sender {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        self.send(Message::Initial(level));
        Ok(())
    }

    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        self.batch.push(change);
        if self.batch.len() >= BATCH {
            self.flush();
        }
        Ok(())
    }

    fn outputs(&mut self, ps: u64, levels: u8) -> Result<(), TraceError> {
        self.flush();
        self.send(Message::Outputs(ps, levels));
        Ok(())
    }

    fn pwm(&mut self, ps: u64, level: bool) -> Result<(), TraceError> {
        self.pwm.push((ps, level));
        if self.pwm.len() >= BATCH {
            self.flush();
        }
        Ok(())
    }

    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        self.flush();
        self.send(Message::End(ps));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge::Pin;

    #[derive(Default)]
    struct Seen {
        changes: Vec<PinChange>,
        end: u64,
        fails_at: Option<u64>,
    }

    impl PinSink for Seen {
        fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
            if self.fails_at == Some(change.ps) {
                return Err(TraceError::Plot("full".into()));
            }
            self.changes.push(change);
            Ok(())
        }

        fn end(&mut self, ps: u64) -> Result<(), TraceError> {
            self.end = ps;
            Ok(())
        }
    }

    fn send(sink: &mut dyn PinSink) {
        for ps in 0..30_000 {
            let level = ps % 2 == 0;
            sink.change(PinChange { ps, axis: 0, pin: Pin::Step, level }).unwrap();
        }
        sink.end(77).unwrap();
    }

    #[test]
    fn sink_sees_all_changes_in_order_and_the_end() {
        let (made, seen) = sink_beside(Seen::default(), |sink| {
            send(sink);
            5
        })
        .unwrap();
        assert_eq!((made, seen.end), (5, 77));
        let times: Vec<u64> = seen.changes.iter().map(|change| change.ps).collect();
        assert_eq!(times, (0..30_000).collect::<Vec<_>>());
    }

    #[test]
    fn error_of_the_sink_is_returned_and_nobody_waits() {
        let sink = Seen { fails_at: Some(9_000), ..Seen::default() };
        assert!(sink_beside(sink, send).is_err());
    }
}

//! What every consumer of a capture sees: pins that change, in time order.

use crate::error::TraceError;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// A pin of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Pin {
    /// A rising edge is one step.
    Step,
    /// Low is forward, high is backward.
    Dir,
}

impl fmt::Display for Pin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Step => "step",
            Self::Dir => "dir",
        })
    }
}

/// One pin takes a new level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PinChange {
    /// When, in ps from the start of the capture.
    pub ps: u64,
    /// Axis number, from 0.
    pub axis: u8,
    /// Which pin.
    pub pin: Pin,
    /// The level from now on.
    pub level: bool,
}

/// A consumer of pin changes; memory stays bounded however long the capture is.
///
/// Calls come in this order: any number of [`initial`](Self::initial), any number of
/// [`change`](Self::change) with `ps` never falling, one [`end`](Self::end).
pub trait PinSink {
    /// The level that a pin has when the capture begins. It is no edge; a pin not named is low.
    ///
    /// # Errors
    /// The sink cannot write.
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        let _ = level;
        Ok(())
    }

    /// A pin changes its level.
    ///
    /// # Errors
    /// The sink cannot write.
    fn change(&mut self, change: PinChange) -> Result<(), TraceError>;

    /// The capture is over at `ps`.
    ///
    /// # Errors
    /// The sink cannot write.
    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        let _ = ps;
        Ok(())
    }
}

impl<S: PinSink + ?Sized> PinSink for &mut S {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        (**self).initial(level)
    }

    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        (**self).change(change)
    }

    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        (**self).end(ps)
    }
}

/// Keeps every change: for tests and short captures.
impl PinSink for Vec<PinChange> {
    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        self.push(change);
        Ok(())
    }
}

/// Feeds several sinks with the same capture.
#[derive(Default)]
pub struct Tee<'a> {
    sinks: Vec<&'a mut dyn PinSink>,
}

impl<'a> Tee<'a> {
    /// A tee without branches; everything it hears is lost.
    pub fn new() -> Self {
        Self::default()
    }

    /// One branch more.
    pub fn add(&mut self, sink: &'a mut dyn PinSink) {
        self.sinks.push(sink);
    }
}

impl PinSink for Tee<'_> {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        self.sinks.iter_mut().try_for_each(|sink| sink.initial(level))
    }

    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        self.sinks.iter_mut().try_for_each(|sink| sink.change(change))
    }

    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        self.sinks.iter_mut().try_for_each(|sink| sink.end(ps))
    }
}

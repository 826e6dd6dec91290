//! The interface between captures and their consumers: pin changes in order of time.
//!
//! The texts of [`Pin`] are names of signals in captures and may not change.

use crate::error::TraceError;
use schemars::JsonSchema;
use serde::Serialize;
use strum::Display;

/// A pin of an axis.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Display, JsonSchema, Serialize,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Pin {
    /// STEP: a rising edge is one step.
    Step,
    /// DIR: low is forward, high is backward.
    Dir,
}

/// The change of one pin to a new level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PinChange {
    /// Time of the change, ps from the start of the capture.
    pub ps: u64,
    /// Number of the axis, counted from 0.
    pub axis: u8,
    /// The pin that changes.
    pub pin: Pin,
    /// The new level.
    pub level: bool,
}

/// A consumer of pin changes. Its memory stays bounded, however long the capture is.
///
/// The calls come in this order: any number of [`initial`](Self::initial), any number of
/// [`change`](Self::change), [`changes`](Self::changes) and [`outputs`](Self::outputs) in which `ps`
/// never falls, and one [`end`](Self::end); [`pwm`](Self::pwm) says where its calls come.
pub trait PinSink {
    /// Sets the level of a pin at the start of the capture. This is not an edge; a pin without such
    /// a call is low.
    ///
    /// # Errors
    /// A [`TraceError`] if the sink cannot write.
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        let _ = level;
        Ok(())
    }

    /// Takes the change of a pin.
    ///
    /// # Errors
    /// A [`TraceError`] if the sink cannot write.
    fn change(&mut self, change: PinChange) -> Result<(), TraceError>;

    /// Takes several changes of pins, in order.
    ///
    /// # Errors
    /// A [`TraceError`] if the sink cannot write.
    fn changes(&mut self, changes: &[PinChange]) -> Result<(), TraceError> {
        changes.iter().try_for_each(|change| self.change(*change))
    }

    /// Sets the levels of the output pins from `ps` on, one bit each; 1 is active. Before the first
    /// call all are inactive.
    ///
    /// # Errors
    /// A [`TraceError`] if the sink cannot write.
    fn outputs(&mut self, ps: u64, levels: u8) -> Result<(), TraceError> {
        let _ = (ps, levels);
        Ok(())
    }

    /// Sets the level of the PWM's pin from `ps` on; before the first call it is low. The calls are
    /// in order of time, but may come later than those of the other pins.
    ///
    /// # Errors
    /// A [`TraceError`] if the sink cannot write.
    fn pwm(&mut self, ps: u64, level: bool) -> Result<(), TraceError> {
        let _ = (ps, level);
        Ok(())
    }

    /// Ends the capture at `ps`.
    ///
    /// # Errors
    /// A [`TraceError`] if the sink cannot write.
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

    fn changes(&mut self, changes: &[PinChange]) -> Result<(), TraceError> {
        (**self).changes(changes)
    }

    fn outputs(&mut self, ps: u64, levels: u8) -> Result<(), TraceError> {
        (**self).outputs(ps, levels)
    }

    fn pwm(&mut self, ps: u64, level: bool) -> Result<(), TraceError> {
        (**self).pwm(ps, level)
    }

    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        (**self).end(ps)
    }
}

/// Keeps every change in memory, for tests and short captures.
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
    /// A tee without sinks, which discards everything.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a sink.
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

    fn changes(&mut self, changes: &[PinChange]) -> Result<(), TraceError> {
        self.sinks.iter_mut().try_for_each(|sink| sink.changes(changes))
    }

    fn outputs(&mut self, ps: u64, levels: u8) -> Result<(), TraceError> {
        self.sinks.iter_mut().try_for_each(|sink| sink.outputs(ps, levels))
    }

    fn pwm(&mut self, ps: u64, level: bool) -> Result<(), TraceError> {
        self.sinks.iter_mut().try_for_each(|sink| sink.pwm(ps, level))
    }

    fn end(&mut self, ps: u64) -> Result<(), TraceError> {
        self.sinks.iter_mut().try_for_each(|sink| sink.end(ps))
    }
}

/// The output pins of a machine, or those that a capture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct OutputPins {
    /// The outputs, one bit each.
    pub outputs: u8,
    /// Whether there is a PWM.
    pub pwm: bool,
}

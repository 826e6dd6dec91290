//! Sets those parts of an engine whose types are the same for every number of axes and adders.
//!
//! [`Engine`](super::Engine) and [`WideEngine`](super::wide::WideEngine) are made with default parts,
//! and then get the parts of their build. These two types are compiled for each number of axes and
//! adders; what is here is compiled once.

use super::cut_control::CutControl;
use super::edge_latch::EdgeLatch;
use super::output_control::OutputControl;
use super::pulse_width::PulseWidth;
use super::pulser::Pulser;
use super::queue::Queue;
use super::readout::Readout;
use super::store::Store;
use super::supervisor::Supervisor;
use crate::HdlError;
use carrystep_core::EngineBuild;

/// The parts, to be replaced. There is one pulser for each axis, and one store, queue and readout for
/// each adder.
pub(super) struct PartsOfAnySize<'a> {
    pub(super) pulsers: &'a mut [Pulser],
    pub(super) stores: &'a mut [Store],
    pub(super) queues: &'a mut [Queue],
    pub(super) readouts: &'a mut [Readout],
    pub(super) cut_control: &'a mut CutControl,
    pub(super) output_control: &'a mut OutputControl,
    pub(super) pulse_width: &'a mut PulseWidth,
    pub(super) edge_latch: &'a mut EdgeLatch,
    pub(super) supervisor: &'a mut Supervisor,
}

impl PartsOfAnySize<'_> {
    /// Replaces all of them by those of the build.
    ///
    /// # Errors
    /// Returns [`HdlError::PinTiming`] if the pin timing of an axis is out of range.
    pub(super) fn set(self, build: &EngineBuild) -> Result<(), HdlError> {
        for (pulser, pins) in self.pulsers.iter_mut().zip(&build.pins) {
            *pulser = Pulser::new(pins)?;
        }
        let slots = build.slots();
        for store in self.stores {
            *store = Store::new(build.phase, &build.guard.stop, slots);
        }
        for queue in self.queues {
            *queue = Queue::new(slots, build.cuts);
        }
        for readout in self.readouts {
            *readout = Readout::new(slots);
        }
        *self.cut_control = CutControl::new(build.cuts);
        *self.output_control = OutputControl::new(&build.outputs, slots);
        *self.pulse_width = PulseWidth::new(build.outputs.pwm_divider);
        *self.edge_latch = EdgeLatch::new(build.guard.latches.first());
        *self.supervisor = Supervisor::new(&build.guard);
        Ok(())
    }
}

//! What the virtual board and tests ask the engine beyond its outputs.

use super::axis_model::AxisModel;
use super::{Motion, bits};
use carrystep_core::engine::Cause;

impl Motion {
    /// The stop that was called: its first cause, and the axes that caused it (one bit each).
    pub fn fault(&self) -> Option<(Cause, u8)> {
        self.stop.fault
    }

    /// The number of ticks until one of the axes has only `kept` segments waiting beside the
    /// running one; 0 if it has no more than that already. Only axes count whose queue does not
    /// reach the end of their move. The result is `None` if no axis needs the host: every axis is
    /// at rest, or has the end of its move in its queue, or a stop has been called. While a start
    /// is armed, waiting moves count as started.
    pub fn ticks_without_host(&self, kept: usize) -> Option<u64> {
        let armed = self.armed.is_some();
        let of_axis_model = |axis_model: &AxisModel| {
            let all = || axis_model.running.iter().chain(&axis_model.queue);
            let begun = armed || axis_model.running.is_some();
            let ended = if armed {
                all().next_back()?.commit.last
            } else {
                all().any(|segment| segment.commit.last)
            };
            if !begun || ended {
                return None;
            }
            let spare = axis_model.queue.len().saturating_sub(kept);
            Some(all().take(spare).map(|segment| u64::from(segment.left) + 1).sum())
        };
        self.axis_models
            .iter()
            .filter_map(of_axis_model)
            .min()
            .filter(|_| self.stop.fault.is_none())
    }

    /// Number of segments in the queue of an axis, beside the running one.
    pub fn waiting(&self, axis: usize) -> usize {
        self.axis_models[axis].queue.len()
    }

    /// The axes that run a segment which is not the last of its move, one bit each.
    pub fn in_a_move(&self) -> u8 {
        bits(&self.axis_models, |axis_model| {
            axis_model.running.is_some_and(|segment| !segment.commit.last)
        })
    }
}

//! The seek: axes wait for a switch to have a level, and then slow down. It must stay equal to
//! "Seek" in docs/clock-by-clock.md.
//!
//! ```text
//! tick     |     m       |    m + 1    |  ...  |             |             |
//! source   ____|^^ hit
//! waits    ^^^^^^\________________________________________________________
//! slows    ______/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\_______   own switch
//! ramps    ______________/^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\__
//! V        ^^^^^^^^^^^^^^^^^^^^^^^^^^^\__ramp__________ at rest
//! released _______________________________________/^ the host writes a mask
//! ```

use super::Motion;
use super::switches::LAST_BEAT;
use carrystep_core::engine::{Cause, EngineInputs, SeekSource};

/// The seek of one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct AxisSeek {
    /// The axis waits for the source to be hit.
    pub(super) waits: bool,
    /// It has hit the source, until the host ends the seek.
    pub(super) slows: bool,
    /// `slows` at the beginning of this tick: in this tick the axis is in a ramp of its own.
    pub(super) ramps: bool,
    /// The axis has hit its own switch in this tick.
    pub(super) hits: bool,
    /// The limit that the axis has found in this tick is the source, so it triggers no stop.
    pub(super) is_excused: bool,
}

/// The part of the seek that all axes have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Seek {
    pub(super) source: SeekSource,
    /// The host has written a mask since the last hit.
    pub(super) released: bool,
    /// The common source was hit in this tick.
    pub(super) sweeps: bool,
}

impl Motion {
    /// True if an axis waits for this switch.
    pub(super) fn is_awaited(&self, axis: usize, row: u8) -> bool {
        let Seek { source, .. } = self.seek;
        source.is(row, axis as u8)
            && if source.own {
                self.axis_models[axis].seek.waits
            } else {
                self.axis_models.iter().any(|axis_model| axis_model.seek.waits)
            }
    }

    /// Executes the rules of a seek for one cycle.
    pub(super) fn clock_seek(&mut self, inputs: &EngineInputs, strobe: bool) {
        if strobe {
            self.end_tick_of_seek();
        }
        // The axes of several adders end their time slots together: a hit of one of them is no
        // hit before the others end theirs.
        let released = self.seek.released;
        for axis in self.axes_at(LAST_BEAT) {
            self.end_slot_of_seek(axis, released);
        }
        if let Some(mask) = inputs.seek {
            for (axis, axis_model) in self.axis_models.iter_mut().enumerate() {
                axis_model.seek.waits = mask >> axis & 1 == 1;
            }
            self.seek.released = true;
        }
        self.seek.source = inputs.seek_source.unwrap_or(self.seek.source);
    }

    /// The last beat of the time slot of an axis, in a clock that began with this `released`.
    fn end_slot_of_seek(&mut self, axis: usize, released: bool) {
        let sample = self.sample_of(axis);
        let awaited = sample.is_some_and(|sample| self.is_awaited(axis, sample.row));
        let axis_model = &self.axis_models[axis];
        if !(awaited || axis_model.seek.waits || axis_model.seek.slows) {
            return;
        }
        let (next, found) = axis_model.tick(self.tick(), sample);
        let is_source = sample.filter(|sample| self.seek.source.is(sample.row, axis as u8));
        let is_hit = is_source.is_some_and(|sample| {
            let switch = axis_model.switches[usize::from(sample.row)];
            let state = switch.after(sample.pin, self.build.guard.debounce);
            awaited && state == self.seek.source.level
        });
        let hits = is_hit && self.seek.source.own;
        let AxisSeek { waits, slows, ramps, .. } = axis_model.seek;
        let rests = ramps && next.running.is_none();
        self.axis_models[axis].seek = AxisSeek {
            waits: waits && !hits,
            slows: hits || (slows && !(rests && released)),
            ramps,
            hits,
            is_excused: found == Some(Cause::Limit) && is_source.is_some() && (waits || slows),
        };
        self.seek.released &= !hits;
        self.seek.sweeps |= is_hit && !hits;
    }

    /// The strobe, after the axes have executed their tick.
    fn end_tick_of_seek(&mut self) {
        let sweeps = std::mem::take(&mut self.seek.sweeps);
        self.seek.released &= !sweeps;
        for axis_model in &mut self.axis_models {
            let seek = &mut axis_model.seek;
            let slows = seek.slows || (sweeps && seek.waits);
            let waits = seek.waits && !sweeps;
            *seek = AxisSeek { waits, slows, ramps: slows, hits: false, is_excused: false };
        }
    }

    /// Ends the seek of all axes, in a reset.
    pub(super) fn forget_seek(&mut self) {
        self.seek = Seek { source: self.seek.source, ..Seek::default() };
        self.axis_models.iter_mut().for_each(|axis_model| axis_model.seek = AxisSeek::default());
    }
}

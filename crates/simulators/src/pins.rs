//! Converts outputs per clock cycle to pin changes in ps, the input of the checker and of the
//! waveform writers.

use carrystep_check::{Pin, PinChange, PinSink, TraceError};
use carrystep_core::ports::Outputs;
use carrystep_core::{AXES, Timebase};

/// The number of changes that are sent together.
const BATCH: usize = 1 << 14;

/// Sends every change of STEP and DIR of the first `axes` axes to a sink, in batches, and the levels
/// of the outputs and of the PWM.
pub struct PinFeed<'a> {
    timebase: Timebase,
    /// A bit for each axis whose changes are sent.
    shown: u8,
    sink: &'a mut dyn PinSink,
    step: u8,
    dir: u8,
    outputs: u8,
    pwm: bool,
    batch: Vec<PinChange>,
    failed: Option<TraceError>,
}

impl<'a> PinFeed<'a> {
    /// A feed with all pins low, as after configuration.
    pub fn new(timebase: Timebase, axes: usize, sink: &'a mut dyn PinSink) -> Self {
        let shown = (1 << axes.min(AXES)) - 1;
        let batch = Vec::with_capacity(BATCH + 2 * AXES);
        Self { timebase, shown, sink, step: 0, dir: 0, outputs: 0, pwm: false, batch, failed: None }
    }

    /// Processes the outputs of a cycle. A new level of a pin begins with the cycle.
    pub fn observe(&mut self, cycle: u64, outputs: &Outputs) {
        self.pins(cycle, outputs.step, outputs.dir);
    }

    /// Processes the pins of a cycle; bit i is axis i. Otherwise as [`PinFeed::observe`].
    pub fn pins(&mut self, cycle: u64, step: u8, dir: u8) {
        if self.failed.is_some() || (step == self.step && dir == self.dir) {
            return;
        }
        let ps = self.timebase.clock_to_ps(cycle);
        // DIR comes first: if both change in one cycle, the new direction applies to the step.
        for (pin, now, before) in [(Pin::Dir, dir, self.dir), (Pin::Step, step, self.step)] {
            let mut changed = (now ^ before) & self.shown;
            while changed != 0 {
                let axis = changed.trailing_zeros() as u8;
                self.batch.push(PinChange { ps, axis, pin, level: now >> axis & 1 == 1 });
                changed &= changed - 1;
            }
        }
        (self.step, self.dir) = (step, dir);
        if self.batch.len() >= BATCH {
            self.send();
        }
    }

    /// Processes the levels of the output pins in a cycle, one bit each. The axes' pins of the cycle
    /// come first.
    pub fn outputs(&mut self, cycle: u64, levels: u8) {
        if self.failed.is_none() && levels != self.outputs {
            self.outputs = levels;
            self.send_behind(cycle, |sink, ps| sink.outputs(ps, levels));
        }
    }

    /// Processes the level of the PWM's pin in a cycle. The other pins of the cycle come first.
    pub fn pwm(&mut self, cycle: u64, level: bool) {
        if self.failed.is_none() && level != self.pwm {
            self.pwm = level;
            self.send_behind(cycle, |sink, ps| sink.pwm(ps, level));
        }
    }

    /// Sends what waits, and then the change of a cycle.
    fn send_behind(
        &mut self,
        cycle: u64,
        change: impl FnOnce(&mut dyn PinSink, u64) -> Result<(), TraceError>,
    ) {
        self.send();
        if self.failed.is_none() {
            self.failed = change(self.sink, self.timebase.clock_to_ps(cycle)).err();
        }
    }

    fn send(&mut self) {
        self.failed = self.sink.changes(&self.batch).err();
        self.batch.clear();
    }

    /// Whether the sink has failed; it then receives no more changes.
    pub fn has_failed(&self) -> bool {
        self.failed.is_some()
    }

    /// Ends the feed after this number of cycles.
    ///
    /// # Errors
    /// The sink failed, now or before.
    pub fn end(mut self, clocks: u64) -> Result<(), TraceError> {
        if self.failed.is_none() {
            self.send();
        }
        match self.failed {
            Some(error) => Err(error),
            None => self.sink.end(self.timebase.clock_to_ps(clocks)),
        }
    }
}

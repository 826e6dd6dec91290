//! The outputs that change with the motion, and the PWM. It must stay equal to "Outputs" in
//! docs/clock-by-clock.md.
//!
//! ```text
//! tick      |      m      |    m + 1    |    m + 2    |    the segment begins with tick m
//! commit    | begins      | computed    | emitted     |    from strobe to strobe
//! duty      ____________________________/^^^^^^^^^^^^^^    at the strobe
//! outputs   ______________________________/^^^^^^^^^^^^    after the first clock of the tick
//! ```

use super::Motion;
use carrystep_core::OutputChange;
use carrystep_core::engine::{Outputs, PWM_STEPS};

/// The registers of the outputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct OutputState {
    /// The change with the segment with which axis 0 has begun the tick before.
    computed: Option<OutputChange>,
    /// `computed` of the tick before.
    emitted: Option<OutputChange>,
    /// Levels of the outputs, one bit each; 1 is active.
    pub(super) levels: u8,
    duty: u32,
    /// Number of the clock in the period of the PWM, from 0.
    clock: u32,
    /// Level of the PWM's pin.
    pub(super) pwm: bool,
}

impl OutputState {
    /// Advances by one cycle, which is the first one of a tick, a strobe, or neither. `begun` is
    /// the change with the segment with which axis 0 has begun this tick.
    fn clock(&mut self, build: Outputs, off: bool, at: Place, begun: Option<OutputChange>) {
        let before = *self;
        if at == Place::First
            && let Some(OutputChange { mask, levels, .. }) = before.emitted
        {
            let mask = mask & build.exist;
            self.levels = (before.levels & !mask) | (levels & mask);
        }
        if at == Place::Strobe {
            if let Some(duty) = before.computed.and_then(|change| change.duty)
                && build.pwm_divider > 0
            {
                self.duty = (u32::from(duty)) % PWM_STEPS;
            }
            self.emitted = before.computed;
            self.computed = begun;
        }
        self.pwm = before.is_high(build, before.clock);
        if off {
            (self.levels, self.duty, self.pwm) = (0, 0, false);
        }
        self.pass_period(build, 1);
    }

    /// True if the counter of the PWM is below the duty in this clock of the period.
    fn is_high(&self, build: Outputs, clock: u32) -> bool {
        clock.checked_div(build.pwm_divider).is_some_and(|count| count < self.duty)
    }

    /// Advances the counter of the PWM.
    fn pass_period(&mut self, build: Outputs, clocks: u64) {
        let period = u64::from(build.pwm_divider) * u64::from(PWM_STEPS);
        self.clock = (u64::from(self.clock) + clocks).checked_rem(period).unwrap_or(0) as u32;
    }
}

/// What a cycle is in its tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    First,
    Strobe,
    Within,
}

impl Motion {
    /// True if all outputs are turned off in the next cycle.
    fn outputs_are_off(&self) -> bool {
        let ramp = self.stop.fault.is_some() && self.build.outputs.off_at_ramps;
        self.stop.frozen || ramp || !self.supervisor.enabled
    }

    /// Executes the rules of the outputs for one cycle. No register has advanced yet.
    pub(super) fn clock_outputs(&mut self, strobe: bool) {
        let place = match self.clock {
            _ if strobe => Place::Strobe,
            0 => Place::First,
            _ => Place::Within,
        };
        let (off, begun) = (self.outputs_are_off(), self.axis_models[0].begun);
        self.outputs.clock(self.build.outputs, off, place, begun);
    }
}

/// Access for the fast model, which passes many clocks at once.
impl Motion {
    /// Levels of the outputs, one bit each; 1 is active.
    pub(crate) const fn output_levels(&self) -> u8 {
        self.outputs.levels
    }

    /// The duty of the PWM, 0 to 4095 of 4096.
    pub(crate) const fn duty(&self) -> u16 {
        self.outputs.duty as u16
    }

    /// The level of the PWM's pin.
    pub(crate) const fn pwm(&self) -> bool {
        self.outputs.pwm
    }

    /// True if no clock changes anything but the PWM's counter and pin.
    pub(super) fn outputs_are_steady(&self) -> bool {
        let OutputState { computed, emitted, levels, duty, .. } = self.outputs;
        computed.is_none()
            && emitted.is_none()
            && !(self.outputs_are_off() && (levels != 0 || duty != 0 || self.outputs.pwm))
    }

    /// Passes this many clocks in which the outputs are steady.
    pub(super) fn pass_outputs(&mut self, clocks: u64) {
        let build = self.build.outputs;
        if let Some(before) = clocks.checked_sub(1) {
            self.outputs.pass_period(build, before);
            self.outputs.pwm = self.outputs.is_high(build, self.outputs.clock);
            self.outputs.pass_period(build, 1);
        }
    }
}

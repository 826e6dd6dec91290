//! The reset of the engine. It must stay equal to "Reset" in docs/clock-by-clock.md.
//!
//! ```text
//! reset    _/^\\______________________________
//! stage     0                |  1  |  2  | 0      from strobe to strobe
//! ```

use super::Motion;
use super::guard::Stop;

/// How far a reset is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Reset {
    /// A reset was requested and is not complete.
    pub(super) ending: bool,
    stage: u8,
}

impl Reset {
    /// True while the engine returns to its state at configuration.
    pub(super) const fn is_resetting(self) -> bool {
        self.stage != 0
    }

    /// True if the next strobe sets the number of discarded steps to 0 and empties the queues.
    pub(super) const fn forgets(self) -> bool {
        self.ending && self.stage == 2
    }
}

impl Motion {
    /// Executes the rules of a reset that apply in every cycle. `was` is the state before it.
    pub(super) fn clock_reset(&mut self, was: Reset, requested: bool) {
        if was.ending {
            self.supervisor.forget();
        }
        if was.is_resetting() {
            self.supervisor.enabled = false;
            self.interlock = false;
            self.forget_seek();
            self.latch.forget();
            self.cut.withdraw();
        }
        self.reset.ending |= requested;
    }

    /// Executes the rules of a reset that apply at a strobe. `free` means that before the strobe
    /// the stop was settled and the pins were at rest.
    pub(super) fn strobe_reset(&mut self, was: Reset, requested: bool, free: bool) {
        if was.ending && was.stage != 1 {
            self.supervisor.tick_of_round = 0;
        }
        if was.is_resetting() {
            self.cut.refused = false;
        }
        match was.stage {
            _ if !was.ending => {}
            0 => self.reset.stage = u8::from(free),
            1 => self.reset.stage = 2,
            _ => {
                self.empty();
                for axis_model in &mut self.axis_models {
                    axis_model.switches = Default::default();
                    axis_model.shaper.discarded = 0;
                }
                if !requested {
                    self.reset = Reset::default();
                    self.stop = Stop::default();
                    self.rest = 2;
                }
            }
        }
    }
}

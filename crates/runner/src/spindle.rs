//! The duty of the spindle's speed output under an override.

use carrystep_core::OutputChange;
use carrystep_core::engine::PWM_STEPS;

/// What the spindle does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Spindle {
    /// The duty that the program set last, steps of the PWM.
    duty: Option<u16>,
    /// The override with which the output was set last, percent.
    percent: u8,
}

impl Default for Spindle {
    fn default() -> Self {
        Self { duty: None, percent: 100 }
    }
}

impl Spindle {
    /// A change of outputs with the override: a duty is multiplied by it, and a new override sets the
    /// duty again. The greatest duty is one step short of 1.
    pub fn turns(&mut self, change: OutputChange, percent: u8) -> OutputChange {
        let is_new = self.percent != percent || change.duty.is_some();
        self.duty = change.duty.or(self.duty);
        self.percent = percent;
        let scaled = |duty: u16| {
            let duty = (u32::from(duty) * u32::from(percent) + 50) / 100;
            duty.min(PWM_STEPS - 1) as u16
        };
        OutputChange { duty: self.duty.filter(|_| is_new).map(scaled), ..change }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn duty(duty: Option<u16>) -> OutputChange {
        OutputChange { duty, ..OutputChange::NONE }
    }

    #[test]
    fn duty_is_multiplied_and_set_again_where_the_override_changes() {
        let mut spindle = Spindle::default();
        let mut turns = |change, percent| spindle.turns(duty(change), percent).duty;
        assert_eq!(turns(None, 100), None);
        assert_eq!(turns(None, 50), None);
        assert_eq!(turns(Some(2048), 50), Some(1024));
        assert_eq!(turns(None, 50), None);
        assert_eq!(turns(None, 110), Some(2253));
        assert_eq!(turns(None, 200), Some(4095));
        assert_eq!(turns(Some(0), 200), Some(0));
        assert_eq!(turns(None, 100), Some(0));
    }

    #[test]
    fn without_an_override_nothing_changes() {
        let mut spindle = Spindle::default();
        for change in [duty(None), duty(Some(4095)), duty(Some(1)), duty(None)] {
            assert_eq!(spindle.turns(change, 100), change);
        }
    }
}

//! A home switch at a general input, as a user writes it: LinuxCNC homes on it.
//!
//! ```text
//! x,input=0,toward=min,seek_speed=20,slow_speed=2,pull_off=5,position=0
//! ```

use super::Homing;
use carrystep_files::{Axis, Machine, decimal};
use std::str::FromStr;
use thiserror::Error;

/// A home switch. The keys are those of the `home` table of a machine file.
#[derive(Debug, Clone, PartialEq)]
pub struct HomeSwitch {
    /// Name of the axis in the machine file.
    pub axis: String,
    /// Number of the general input in the machine file's list, from 0.
    pub input: u8,
    /// Whether the switch is at the low end of the axis.
    pub at_low_end: bool,
    /// Speed of the search, units/s.
    pub seek_speed: f64,
    /// Speed of the last approach, units/s.
    pub slow_speed: f64,
    /// Distance from the switch at which the axis rests afterwards, units.
    pub pull_off: f64,
    /// Machine coordinate of the place where the switch closes, units.
    pub position: f64,
}

/// Why a home switch cannot be.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("home switch of axis '{axis}': {why}")]
pub struct SwitchRefused {
    /// The name that was given.
    pub axis: String,
    /// What is wrong.
    pub why: String,
}

/// The keys, all of which are required.
const KEYS: [&str; 6] = ["input", "toward", "seek_speed", "slow_speed", "pull_off", "position"];

impl FromStr for HomeSwitch {
    type Err = SwitchRefused;

    fn from_str(text: &str) -> Result<Self, SwitchRefused> {
        let mut words = text.split(',');
        let axis = words.next().unwrap_or_default().to_owned();
        let refused = |why: String| SwitchRefused { axis: axis.clone(), why };
        let mut values: [Option<&str>; KEYS.len()] = [None; KEYS.len()];
        for word in words {
            let (key, value) = word.split_once('=').unwrap_or((word, ""));
            let known = KEYS.iter().position(|known| *known == key);
            let slot = known.and_then(|known| values.get_mut(known));
            let slot = slot.ok_or_else(|| {
                refused(format!("no key '{key}'; the keys are {}", KEYS.join(", ")))
            })?;
            if slot.replace(value).is_some() {
                return Err(refused(format!("two values of {key}")));
            }
        }
        let text = |key: usize| values[key].ok_or_else(|| refused(format!("no {}", KEYS[key])));
        let number = |key: usize, least: f64| {
            let value: f64 = text(key)?.parse().unwrap_or(f64::NAN);
            if value.is_finite() && value > least {
                return Ok(value);
            }
            let range = if least == 0.0 { " over 0" } else { "" };
            Err(refused(format!("{} is not a number{range}", KEYS[key])))
        };
        let input = text(0)?.parse().map_err(|_| refused("input is not a number from 0".into()))?;
        let at_low_end = match text(1)? {
            "min" => true,
            "max" => false,
            _ => return Err(refused("toward is min or max".to_owned())),
        };
        let (seek_speed, slow_speed) = (number(2, 0.0)?, number(3, 0.0)?);
        if slow_speed > seek_speed {
            return Err(refused("slow_speed is over seek_speed".to_owned()));
        }
        let (pull_off, position) = (number(4, 0.0)?, number(5, f64::NEG_INFINITY)?);
        let axis = axis.clone();
        Ok(Self { axis, input, at_low_end, seek_speed, slow_speed, pull_off, position })
    }
}

impl HomeSwitch {
    /// The pin of the component that shows the switch, without `carrystep.0.`.
    pub fn pin(&self) -> String {
        format!("in-{}-{}", 1 + self.input / 2, self.input % 2)
    }

    /// How LinuxCNC homes on it.
    ///
    /// # Errors
    /// [`SwitchRefused`] if the machine lacks the input, or the axis cannot move so.
    pub fn homing(&self, machine: &Machine, axis: &Axis) -> Result<Homing, SwitchRefused> {
        let refused = |why: String| Err(SwitchRefused { axis: self.axis.clone(), why });
        let row = machine.guard.inputs[usize::from(self.input % 2)].exist;
        if row.checked_shr(u32::from(1 + self.input / 2)).unwrap_or(0) & 1 == 0 {
            return refused(format!("the machine has no general input {}", self.input));
        }
        let scale = decimal::to_f64(&axis.steps_per_unit);
        if self.seek_speed > axis.speed_limit.float / scale {
            return refused("seek_speed is over speed_limit".to_owned());
        }
        let sign = if self.at_low_end { -1.0 } else { 1.0 };
        let rest = self.position - sign * self.pull_off;
        if let Some([low, high]) = axis.travel
            && !(low as f64 / scale..=high as f64 / scale).contains(&rest)
        {
            return refused(format!("{rest}, where the axis would rest, is outside of travel"));
        }
        Ok(Homing::Switch {
            pin: self.pin(),
            search: sign * self.seek_speed,
            latch: sign * self.slow_speed,
            at: self.position,
            rest,
            index: false,
        })
    }
}

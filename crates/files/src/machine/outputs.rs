//! `[machine.outputs]`: the outputs of the engine that change with the motion, and its PWM.

use crate::error::{InputError, SourceText};
use carrystep_core::engine::{MAX_PWM_DIVIDER, Outputs};
use serde::Deserialize;
use toml::Spanned;

/// Greatest speed of a spindle, in turns per minute.
const MAX_RPM: u32 = 1_000_000;

/// Greatest number of outputs.
const MOST_OUTPUTS: u8 = 8;

/// The table as it is written.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, expecting = "a [machine.outputs] table")]
pub(super) struct RawOutputs {
    count: Option<Spanned<u8>>,
    pwm_divider: Option<Spanned<u32>>,
    #[serde(default)]
    at_ramps: AtRamps,
    spindle: Option<Spanned<u8>>,
    spindle_reverse: Option<Spanned<u8>>,
    mist: Option<Spanned<u8>>,
    flood: Option<Spanned<u8>>,
    spindle_rpm: Option<Spanned<u32>>,
    laser: Option<Spanned<bool>>,
}

/// What a G-code program does with the outputs. Each is the number of an output, from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct OutputUses {
    /// Active while the spindle turns (M3, M4).
    pub spindle: Option<u8>,
    /// Active while the spindle turns anticlockwise (M4).
    pub spindle_reverse: Option<u8>,
    /// Active while mist is on (M7).
    pub mist: Option<u8>,
    /// Active while flood is on (M8).
    pub flood: Option<u8>,
    /// The speed in turns per minute at which the duty of the PWM would be 1; `None` if the PWM is
    /// not the spindle's.
    pub spindle_rpm: Option<u32>,
    /// Whether the spindle is a laser, whose duty follows the motion.
    pub laser: bool,
}

impl OutputUses {
    /// The names of the uses in machine files, and their outputs.
    pub fn named(&self) -> [(&'static str, Option<u8>); 4] {
        let Self { spindle, spindle_reverse, mist, flood, .. } = *self;
        named([spindle, spindle_reverse, mist, flood])
    }
}

/// The keys that give an output a use, each with its value of these.
fn named<T>([spindle, spindle_reverse, mist, flood]: [T; 4]) -> [(&'static str, T); 4] {
    [("spindle", spindle), ("spindle_reverse", spindle_reverse), ("mist", mist), ("flood", flood)]
}

/// What a stop by ramps does to the outputs.
#[derive(Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum AtRamps {
    #[default]
    Off,
    Stay,
}

impl RawOutputs {
    /// Checks what programs do with these outputs.
    pub(super) fn uses(
        &self,
        source: &SourceText,
        outputs: Outputs,
    ) -> Result<OutputUses, InputError> {
        let mut taken = 0_u8;
        let all = [&self.spindle, &self.spindle_reverse, &self.mist, &self.flood];
        for (key, number) in named(all) {
            let Some(number) = number else { continue };
            let bit = 1_u8.checked_shl((*number.as_ref()).into()).unwrap_or(0);
            let wrong = |message: String, help: &str| {
                Err(InputError::at(source, number.span(), message).help(help.to_owned()))
            };
            let number = number.as_ref();
            if outputs.exist & bit == 0 {
                let count = outputs.exist.count_ones();
                let message = format!("{key} = {number}: `count` gives {count} outputs");
                return wrong(message, "outputs are numbered from 0; a greater count has more");
            }
            if taken & bit != 0 {
                let message = format!("{key} = {number}: another key has this output");
                return wrong(message, "each use needs an output of its own");
            }
            taken |= bit;
        }
        if let Some(rpm) = &self.spindle_rpm {
            let wrong = |message: String, help: &str| {
                Err(InputError::at(source, rpm.span(), message).help(help.to_owned()))
            };
            let value = rpm.as_ref();
            if outputs.pwm_divider == 0 {
                let message = format!("spindle_rpm = {value}: the machine has no PWM");
                return wrong(message, "pwm_divider gives it one");
            }
            if !(1..=MAX_RPM).contains(value) {
                let message = format!("spindle_rpm = {value}: it is from 1 to {MAX_RPM}");
                return wrong(message, "it is the speed at the greatest duty of the PWM");
            }
        }
        let laser = self.laser.as_ref().is_some_and(|laser| *laser.as_ref());
        if let Some(key) = self.laser.as_ref().filter(|_| laser) {
            let wrong = |message: &str, help: &str| {
                Err(InputError::at(source, key.span(), message.to_owned()).help(help.to_owned()))
            };
            if self.spindle_rpm.is_none() {
                let help = "spindle_rpm is the S word at the greatest duty of the laser";
                return wrong("laser = true: spindle_rpm is missing", help);
            }
            if self.at_ramps != AtRamps::Off {
                let help = "a laser must be off where a stop ends the motion: at_ramps = \"off\"";
                return wrong("laser = true: at_ramps is \"stay\"", help);
            }
            if self.spindle_reverse.is_some() {
                let help = "M4 is the power that follows the speed; leave out spindle_reverse";
                return wrong("laser = true: a laser does not turn", help);
            }
        }
        let number = |key: &Option<Spanned<u8>>| key.as_ref().map(|number| *number.as_ref());
        Ok(OutputUses {
            spindle: number(&self.spindle),
            spindle_reverse: number(&self.spindle_reverse),
            mist: number(&self.mist),
            flood: number(&self.flood),
            spindle_rpm: self.spindle_rpm.as_ref().map(|rpm| *rpm.as_ref()),
            laser,
        })
    }

    /// Checks the table.
    pub(super) fn check(&self, source: &SourceText) -> Result<Outputs, InputError> {
        if let Some(count) = self.count.as_ref().filter(|count| *count.as_ref() > MOST_OUTPUTS) {
            let message =
                format!("count = {}: an engine has at most {MOST_OUTPUTS}", count.as_ref());
            return Err(InputError::at(source, count.span(), message)
                .help("it is the number of outputs besides the PWM"));
        }
        let range = 1..=MAX_PWM_DIVIDER;
        if let Some(divider) = self.pwm_divider.as_ref().filter(|one| !range.contains(one.as_ref()))
        {
            let message =
                format!("pwm_divider = {}: it is from 1 to {MAX_PWM_DIVIDER}", divider.as_ref());
            return Err(InputError::at(source, divider.span(), message).help(
                "the PWM has 4096 times as many clocks in a period; leave it out for no PWM",
            ));
        }
        let count = u32::from(self.count.as_ref().map_or(0, |count| *count.as_ref()));
        Ok(Outputs {
            exist: ((1_u32 << count) - 1) as u8,
            pwm_divider: self.pwm_divider.as_ref().map_or(0, |divider| *divider.as_ref()),
            off_at_ramps: self.at_ramps == AtRamps::Off
                && (count > 0 || self.pwm_divider.is_some()),
        })
    }
}

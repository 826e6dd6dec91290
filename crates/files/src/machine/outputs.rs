//! `[machine.outputs]`: the outputs of the engine that change with the motion, and its PWM.

use crate::error::{InputError, SourceText};
use carrystep_core::engine::{MAX_PWM_DIVIDER, Outputs};
use serde::Deserialize;
use toml::Spanned;

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

//! `[machine.inputs]`: the inputs of the engine besides e-stop and limits, which are the probe, the
//! interlock, general inputs and the latch.
//!
//! The engine samples them in rows, in the time slots of the axes: the probe and every other
//! general input in row 2, the interlock and the general inputs between them in row 3. A row has
//! room for one input of each axis.

use super::guard::Active;
use crate::error::{InputError, SourceText};
use carrystep_core::engine::{InputRow, Latch, MAX_LOOKS};
use serde::Deserialize;
use toml::Spanned;

/// Greatest number of general inputs.
const MOST_GENERAL: usize = 8;

/// The table as it is written.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, expecting = "a [machine.inputs] table")]
pub(super) struct RawInputs {
    probe: Option<Active>,
    interlock: Option<Active>,
    general: Option<Spanned<Vec<Active>>>,
    latch: Option<Edge>,
    latch_looks: Option<Spanned<u64>>,
}

/// The change at the pin of the latch that it accepts.
#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Edge {
    Rising,
    Falling,
}

impl RawInputs {
    /// Checks the table for a machine with this number of axes: the two rows, and the latch.
    pub(super) fn check(
        self,
        source: &SourceText,
        axes: usize,
    ) -> Result<([InputRow; 2], Option<Latch>), InputError> {
        let mut rows = [InputRow::default(); 2];
        let mut add = |row: usize, input: usize, active: Active| {
            rows[row].exist |= 1 << input;
            rows[row].low |= u8::from(active == Active::Low) << input;
        };
        for (row, active) in [self.probe, self.interlock].into_iter().enumerate() {
            if let Some(active) = active {
                add(row, 0, active);
            }
        }
        if let Some(general) = &self.general {
            let most = MOST_GENERAL.min(2 * axes.saturating_sub(1));
            if general.as_ref().len() > most {
                let message = format!(
                    "{} general inputs: a machine of {axes} {} has at most {most}",
                    general.as_ref().len(),
                    if axes == 1 { "axis" } else { "axes" }
                );
                return Err(InputError::at(source, general.span(), message)
                    .help("each axis but the first has the time for two of them"));
            }
            for (number, active) in general.as_ref().iter().enumerate() {
                add(number % 2, 1 + number / 2, *active);
            }
        }
        Ok((rows, self.latch_of(source)?))
    }

    fn latch_of(&self, source: &SourceText) -> Result<Option<Latch>, InputError> {
        let most = u64::from(MAX_LOOKS);
        match (self.latch, &self.latch_looks) {
            (None, None) => Ok(None),
            (None, Some(looks)) => {
                Err(InputError::at(source, looks.span(), "latch_looks without latch".to_owned())
                    .help("add latch = \"rising\" or \"falling\", or leave latch_looks out"))
            }
            (Some(_), Some(looks)) if !(1..=most).contains(looks.as_ref()) => {
                let message = format!("latch_looks = {}: it is from 1 to {most}", looks.as_ref());
                Err(InputError::at(source, looks.span(), message)
                    .help("it is the number of ticks for which the pin must keep its level"))
            }
            (Some(edge), looks) => {
                let looks = looks.as_ref().map_or(1, |looks| *looks.as_ref()) as u8;
                Ok(Some(Latch { low: edge == Edge::Falling, looks }))
            }
        }
    }
}

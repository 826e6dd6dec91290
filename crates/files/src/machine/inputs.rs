//! `[machine.inputs]`: the inputs of the engine besides e-stop and limits, which are the probe, the
//! interlock, general inputs and the latches.
//!
//! The engine samples them in rows, in the time slots of the axes: the probe and every other
//! general input in row 2, the interlock and the general inputs between them in row 3. A row has
//! room for one input of each axis.

use super::guard::Active;
use crate::error::{InputError, SourceText};
use carrystep_core::engine::{InputRow, Latch, LatchSource, LimitWiring, MAX_LATCHES, MAX_LOOKS};
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
    latches: Option<Spanned<Vec<Spanned<RawLatch>>>>,
}

/// One of several latches, as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a latch, such as { edge = \"rising\" }")]
struct RawLatch {
    #[serde(default)]
    source: Source,
    axis: Option<Spanned<String>>,
    edge: Edge,
    looks: Option<Spanned<u64>>,
}

/// The pin to which a latch is connected.
#[derive(Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Source {
    /// A pin of its own.
    #[default]
    Pin,
    Probe,
    LimitMin,
    LimitMax,
}

/// The change at the pin of the latch that it accepts.
#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Edge {
    Rising,
    Falling,
}

impl RawInputs {
    /// Checks the table for a machine with axes of these names and with this wiring of limits: the
    /// two rows, and the latches.
    pub(super) fn check(
        self,
        source: &SourceText,
        names: &[&str],
        limits: LimitWiring,
    ) -> Result<([InputRow; 2], Vec<Latch>), InputError> {
        let axes = names.len();
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
        let latches = match &self.latches {
            None => self.latch_of(source)?.into_iter().collect(),
            Some(latches) if self.latch.is_some() || self.latch_looks.is_some() => {
                let message = "latches besides latch or latch_looks".to_owned();
                return Err(InputError::at(source, latches.span(), message)
                    .help("give one latch by latch and latch_looks, or all of them by latches"));
            }
            Some(latches) => self.latches_of(source, latches, names, limits)?,
        };
        Ok((rows, latches))
    }

    fn latch_of(&self, source: &SourceText) -> Result<Option<Latch>, InputError> {
        match (self.latch, &self.latch_looks) {
            (None, None) => Ok(None),
            (None, Some(looks)) => {
                Err(InputError::at(source, looks.span(), "latch_looks without latch".to_owned())
                    .help("add latch = \"rising\" or \"falling\", or leave latch_looks out"))
            }
            (Some(edge), looks) => {
                let looks = looks_of(source, "latch_looks", looks.as_ref())?;
                Ok(Some(Latch::of_pin(edge == Edge::Falling, looks)))
            }
        }
    }

    fn latches_of(
        &self,
        source: &SourceText,
        latches: &Spanned<Vec<Spanned<RawLatch>>>,
        names: &[&str],
        limits: LimitWiring,
    ) -> Result<Vec<Latch>, InputError> {
        let count = latches.as_ref().len();
        if !(1..=MAX_LATCHES).contains(&count) {
            let message = format!("{count} latches: a machine has 1 to {MAX_LATCHES}");
            return Err(InputError::at(source, latches.span(), message)
                .help("leave latches out if the machine has none"));
        }
        let one = |latch: &Spanned<RawLatch>| {
            let RawLatch { edge, looks, .. } = latch.as_ref();
            let looks = looks_of(source, "looks", looks.as_ref())?;
            let pin = self.source_of(source, latch, names, limits)?;
            Ok(Latch { source: pin, low: *edge == Edge::Falling, looks })
        };
        latches.as_ref().iter().map(one).collect()
    }

    /// The pin of a latch.
    fn source_of(
        &self,
        source: &SourceText,
        latch: &Spanned<RawLatch>,
        names: &[&str],
        limits: LimitWiring,
    ) -> Result<LatchSource, InputError> {
        let refused = |what: &str, help: &str| {
            Err(InputError::at(source, latch.span(), what.to_owned()).help(help.to_owned()))
        };
        let RawLatch { source: from, axis, .. } = latch.as_ref();
        let named = match axis {
            None => None,
            Some(name) => match names.iter().position(|one| one == name.as_ref()) {
                Some(axis) => Some(axis as u8),
                None => {
                    let message = format!("no axis is called '{}'", name.as_ref());
                    return Err(InputError::at(source, name.span(), message)
                        .help(format!("the axes are {}", names.join(", "))));
                }
            },
        };
        let row = match (from, named) {
            (Source::Pin | Source::Probe, Some(_)) => {
                return refused("a latch with an axis, which is no limit", "leave axis out");
            }
            (Source::Pin, None) => return Ok(LatchSource::Pin),
            (Source::Probe, None) if self.probe.is_none() => {
                return refused(
                    "a latch at the probe of a machine without one",
                    "add probe = \"high\" or \"low\"",
                );
            }
            (Source::Probe, None) => return Ok(LatchSource::Switch { row: 2, axis: 0 }),
            (Source::LimitMin, _) => 0,
            (Source::LimitMax, _) => 1,
        };
        match (limits, row, named) {
            (LimitWiring::One, 0, _) => Ok(LatchSource::Switch { row, axis: 0 }),
            (LimitWiring::Pair, _, Some(axis)) | (LimitWiring::Each, 0, Some(axis)) => {
                Ok(LatchSource::Switch { row, axis })
            }
            (LimitWiring::Pair, ..) | (LimitWiring::Each, 0, None) => {
                refused("a latch at a limit of no axis", "add axis, the name of the axis")
            }
            _ => refused(
                "a latch at a limit that the machine does not have",
                "limits in [machine.guard] says which there are",
            ),
        }
    }
}

/// The number of looks; 1 if it is not given.
fn looks_of(
    source: &SourceText,
    key: &str,
    looks: Option<&Spanned<u64>>,
) -> Result<u8, InputError> {
    let most = u64::from(MAX_LOOKS);
    match looks {
        Some(looks) if !(1..=most).contains(looks.as_ref()) => {
            let message = format!("{key} = {}: it is from 1 to {most}", looks.as_ref());
            Err(InputError::at(source, looks.span(), message)
                .help("it is the number of ticks for which the pin must keep its level"))
        }
        looks => Ok(looks.map_or(1, |looks| *looks.as_ref()) as u8),
    }
}

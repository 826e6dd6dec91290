//! The sweep file: a move file with placeholders, and the values that fill them.
//!
//! Case i depends only on the file, the seed and i. Any change of the order in which values are
//! chosen changes every case.

use crate::error::SweepError;
use carrystep_files::{InputError, MoveFile, SourceText};
use minijinja::{Environment, UndefinedBehavior};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::Path;

/// The values of the placeholders of one case, by name.
pub type Values = BTreeMap<String, Value>;

/// A value of a placeholder.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// A whole number, as in `phases = 16`.
    Integer(i64),
    /// A real number, as in `time = 0.5`.
    Float(f64),
    /// A text, as in `profile = "ranade"`.
    Text(String),
}

/// The values from which a placeholder is filled.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
enum Choice {
    /// One of these values.
    List(Vec<Value>),
    /// A number between `from` and `to`, uniformly distributed on a logarithmic scale; only for
    /// samples.
    Range { from: f64, to: f64 },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Raw {
    move_file: String,
    vary: BTreeMap<String, Choice>,
}

/// A sweep that can create each of its cases.
pub struct SweepFile {
    source: SourceText,
    template: Environment<'static>,
    vary: BTreeMap<String, Choice>,
    sample: Option<u64>,
    seed: u64,
}

/// One case.
#[derive(Debug)]
pub struct Case {
    /// The number of the case, counted from 0.
    pub number: u64,
    /// The values of its placeholders.
    pub values: Values,
    /// The move file, or an error if the values do not give a valid one.
    pub file: Result<MoveFile, InputError>,
    /// The machine file that the move file names: its path from the folder of the sweep file, and
    /// the [`hash`] of its text.
    pub(crate) machine_file: Option<(String, String)>,
}

/// The SHA-256 of these texts, as its first 16 hexadecimal digits.
pub(crate) fn hash(texts: &[&[u8]]) -> String {
    let mut hash = Sha256::new();
    for text in texts {
        // The length keeps texts apart that follow each other.
        hash.update((text.len() as u64).to_le_bytes());
        hash.update(text);
    }
    hash.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect()
}

impl SweepFile {
    /// Reads a sweep. Without a `sample` it is the grid of all lists; with one it consists of that
    /// many random cases, which `seed` determines.
    ///
    /// # Errors
    /// A [`SweepError`] names what is wrong, with the line if there is one.
    pub fn load(path: &Path, sample: Option<u64>, seed: u64) -> Result<Self, SweepError> {
        if sample == Some(0) {
            return Err(SweepError::NothingToTry);
        }
        let source = SourceText::read(path)?;
        let wrong =
            |message: String| SweepError::Format { path: path.display().to_string(), message };
        let raw: Raw = source.parse()?;
        for (name, choice) in &raw.vary {
            match choice {
                Choice::List(list) if list.is_empty() => {
                    return Err(wrong(format!("{name}: an empty list")));
                }
                Choice::List(list) if list.iter().any(Value::is_not_finite) => {
                    return Err(wrong(format!("{name}: a number that is not finite")));
                }
                Choice::Range { .. } if sample.is_none() => {
                    return Err(wrong(format!(
                        "{name}: a range has no grid; give --sample, or a list"
                    )));
                }
                Choice::Range { from, to } if !(*from > 0.0 && from < to && to.is_finite()) => {
                    return Err(wrong(format!("{name}: a range needs 0 < from < to")));
                }
                _ => {}
            }
        }
        let mut template = Environment::new();
        template.set_undefined_behavior(UndefinedBehavior::Strict);
        template
            .add_template_owned("move", raw.move_file)
            .map_err(|error| wrong(error.to_string()))?;
        Ok(Self { source, template, vary: raw.vary, sample, seed })
    }

    /// Number of cases.
    pub fn cases(&self) -> u64 {
        let grid = || {
            self.vary
                .values()
                .map(|choice| if let Choice::List(list) = choice { list.len() as u64 } else { 1 })
        };
        self.sample.unwrap_or_else(|| grid().fold(1, u64::saturating_mul))
    }

    /// The path of the file, as the user gave it.
    pub fn path(&self) -> &Path {
        &self.source.path
    }

    /// The text of the file.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// The number of random cases; `None` for the grid.
    pub fn sample(&self) -> Option<u64> {
        self.sample
    }

    /// The seed of the random cases.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// What two reports must agree on to be of the same sweep on the same core.
    pub fn fingerprint(&self, core: &str) -> String {
        let numbers = [self.seed, self.cases(), u64::from(self.sample.is_some())];
        let numbers = numbers.map(u64::to_le_bytes).concat();
        hash(&[self.source.text.as_bytes(), core.as_bytes(), &numbers])
    }

    /// Case `number`, counted from 0. It is the same on every machine and in every shard.
    pub fn case(&self, number: u64) -> Case {
        let mut rest = number;
        let mut random = mixed(self.seed ^ mixed(number));
        let mut values = Values::new();
        for (name, choice) in &self.vary {
            random = mixed(random);
            let value = match choice {
                Choice::List(list) => {
                    let length = list.len() as u64;
                    let index = if self.sample.is_some() { random % length } else { rest % length };
                    rest /= length;
                    list[index as usize].clone()
                }
                Choice::Range { from, to } => {
                    let part = random as f64 / 2_f64.powi(64);
                    Value::Float(from * (to / from).powf(part))
                }
            };
            values.insert(name.clone(), value);
        }
        let filled = values
            .iter()
            .map(|(name, value)| (name.clone(), minijinja::Value::from(value.to_string())));
        let filled = minijinja::Value::from_pairs(filled);
        let text = self.template.get_template("move").and_then(|template| template.render(filled));
        let file = match text {
            Ok(text) => MoveFile::from_source(SourceText {
                path: self.source.path.clone(),
                text: text.into(),
            }),
            Err(error) => Err(InputError::new(format!("{}: {error}", self.source.path.display()))),
        };
        let machine = file.as_ref().ok().and_then(|file| file.machine_source.as_ref());
        let machine_file = machine.map(|machine| self.named(machine));
        Case { number, values, file, machine_file }
    }

    /// Path and hash of a machine file. The path is relative to the folder of the sweep file, so
    /// that it is the same on machines on which that folder has different names.
    fn named(&self, machine: &SourceText) -> (String, String) {
        let folder = self.source.path.parent().unwrap_or(Path::new(""));
        let path = machine.path.strip_prefix(folder).unwrap_or(&machine.path);
        (path.display().to_string(), hash(&[machine.text.as_bytes()]))
    }
}

impl Value {
    /// Whether JSON has no number for it.
    fn is_not_finite(&self) -> bool {
        matches!(self, Self::Float(number) if !number.is_finite())
    }
}

/// The first number of splitmix64 (G. L. Steele and others, 2014) from this seed: every bit of the
/// seed affects all bits of the result.
fn mixed(seed: u64) -> u64 {
    SplitMix64::seed_from_u64(seed).next_u64()
}

#[cfg(test)]
mod tests {
    use super::mixed;

    /// The first numbers of the authors' own program. Every case depends on them.
    #[test]
    fn mixed_numbers_are_those_of_splitmix64() {
        assert_eq!(mixed(0), 0xe220_a839_7b1d_cdaf);
        assert_eq!(mixed(0x9e37_79b9_7f4a_7c15), 0x6e78_9e6a_a1b9_65f4);
    }
}

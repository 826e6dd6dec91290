//! The files in which slices of a check are kept until they are merged.

use crate::json;
use carrystep_check::Slice;
use carrystep_files::sealed::{SealFault, seal, unseal};
use carrystep_files::{InputFailure, open};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::io::Read as _;
use std::path::Path;
use thiserror::Error;

const NAME: &str = "carrystep-check-slice";

const VERSION: &str = "1";

/// So many missing slices are named.
const NAMED: usize = 10;

/// Why slices cannot be merged.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SliceFault {
    /// A file cannot be read.
    #[error(transparent)]
    Input(#[from] InputFailure),
    /// A file cannot be read.
    #[error("cannot read {path}: {source}")]
    Io {
        /// Its path.
        path: String,
        /// The error of the system.
        source: std::io::Error,
    },
    /// A file does not hold a slice.
    #[error("{path}: no slice of a check (--slice writes one)")]
    NoSlice {
        /// Its path.
        path: String,
    },
    /// A file is damaged or has another version.
    #[error("{path}: {fault}\n  help: check this slice again")]
    Seal {
        /// Its path.
        path: String,
        /// What is wrong with it.
        fault: SealFault,
    },
    /// Two slices do not belong together.
    #[error(
        "{one} and {other} are not of one check: {what} differ\n  help: check all slices in the same way"
    )]
    NotOneCheck {
        /// The first file.
        one: String,
        /// The other file.
        other: String,
        /// What differs, in words.
        what: &'static str,
    },
    /// A slice occurs twice.
    #[error(
        "slice {number} occurs twice: in {one} and in {other}\n  help: each slice is needed once"
    )]
    Twice {
        /// Number of the slice.
        number: u64,
        /// The first file.
        one: String,
        /// The other file.
        other: String,
    },
    /// Slices are missing.
    #[error("each of the {count} slices is needed once; missing: {missing}")]
    Missing {
        /// The number of slices.
        count: u64,
        /// The numbers of those that are missing.
        missing: Numbers,
    },
    /// A slice cannot be written.
    #[error("a slice cannot be written as JSON: {0}")]
    NotMade(#[from] serde_json::Error),
}

/// Some numbers of slices, and how many more there are.
#[derive(Debug, PartialEq, Eq)]
pub struct Numbers(Vec<u64>, u64);

impl fmt::Display for Numbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(numbers, more) = self;
        let named: Vec<String> = numbers.iter().map(u64::to_string).collect();
        f.write_str(&named.join(", "))?;
        if *more > 0 { write!(f, " and {more} more") } else { Ok(()) }
    }
}

/// What must be the same for all slices of a check.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SliceSettings {
    carrystep: String,
    options: Vec<String>,
    moves: String,
}

impl SliceSettings {
    /// `options` are those of the check, as they were given; `moves` tells machine and moves from
    /// others.
    pub fn new(options: Vec<String>, moves: String) -> Self {
        Self { carrystep: env!("CARGO_PKG_VERSION").to_owned(), options, moves }
    }

    /// What differs from others, in words.
    fn difference(&self, other: &Self) -> Option<&'static str> {
        let differences = [
            ("the versions of carrystep", self.carrystep != other.carrystep),
            ("the options", self.options != other.options),
            ("the moves or the machines", self.moves != other.moves),
        ];
        differences.into_iter().find(|(_, differ)| *differ).map(|(what, _)| what)
    }
}

#[derive(Serialize, Deserialize)]
struct Body {
    settings: SliceSettings,
    slice: Slice,
}

/// The slices of a check, which were read from their files.
#[derive(Debug, Default)]
pub struct Slices {
    slices: BTreeMap<u64, (String, SliceSettings, Slice)>,
}

impl Slices {
    /// The file of a slice that was checked with these options.
    ///
    /// # Errors
    /// [`SliceFault::NotMade`].
    pub fn text(slice: Slice, settings: SliceSettings) -> Result<String, SliceFault> {
        Ok(seal(NAME, VERSION, &json::line(&Body { settings, slice })?))
    }

    /// Adds the slice in a file.
    ///
    /// # Errors
    /// The file is none of [`Slices::text`], or its slice does not belong to the others.
    pub fn add(&mut self, file: &Path) -> Result<(), SliceFault> {
        let mut bytes = Vec::new();
        let path = file.display().to_string();
        if let Err(source) = open(file)?.read_to_end(&mut bytes) {
            return Err(SliceFault::Io { path, source });
        }
        let Some(body) = unseal(NAME, VERSION, &bytes) else {
            return Err(SliceFault::NoSlice { path });
        };
        let body = body
            .and_then(|body| serde_json::from_slice::<Body>(body).map_err(|_| SealFault::Damaged));
        let Body { settings, slice } = match body {
            Ok(body) => body,
            Err(fault) => return Err(SliceFault::Seal { path, fault }),
        };
        if let Some((one, first, begun)) = self.slices.values().next() {
            let differs = begun.count != slice.count;
            let count = differs.then_some("the numbers of slices");
            if let Some(what) = count.or_else(|| first.difference(&settings)) {
                return Err(SliceFault::NotOneCheck { one: one.clone(), other: path, what });
            }
        }
        let number = slice.number;
        if let Some((one, ..)) = self.slices.get(&number) {
            return Err(SliceFault::Twice { number, one: one.clone(), other: path });
        }
        self.slices.insert(number, (path, settings, slice));
        Ok(())
    }

    /// All slices in order, if they were checked with these settings.
    ///
    /// # Errors
    /// [`SliceFault::Missing`] or [`SliceFault::NotOneCheck`].
    pub fn in_order(self, settings: &SliceSettings) -> Result<Vec<Slice>, SliceFault> {
        let mut count = 0;
        if let Some((one, own, slice)) = self.slices.values().next() {
            if let Some(what) = own.difference(settings) {
                let (one, other) = (one.clone(), "this merge".to_owned());
                return Err(SliceFault::NotOneCheck { one, other, what });
            }
            count = slice.count;
        }
        let left = count - (self.slices.len() as u64).min(count);
        if left > 0 || count == 0 {
            let missing = (1..=count).filter(|number| !self.slices.contains_key(number));
            let named: Vec<u64> = missing.take(NAMED).collect();
            let more = left - (named.len() as u64).min(left);
            return Err(SliceFault::Missing { count, missing: Numbers(named, more) });
        }
        Ok(self.slices.into_values().map(|(_, _, slice)| slice).collect())
    }
}

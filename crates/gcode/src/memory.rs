//! The parameters of a program: `#1` to `#5602`, and `#<name>`.
//!
//! `#1` to `#30` and names without `_` belong to the running call of a subroutine; all others are
//! global.

use crate::error::ErrorKind;
use crate::evaluate::LAST_PARAMETER;
use std::collections::HashMap;

/// Number of values that a call can pass, in `#1` to `#30`.
pub(crate) const ARGUMENTS: usize = 30;

/// Greatest number of names, global or of one call, so that no file fills the memory.
const MOST_NAMES: usize = 10_000;

/// Names that a program has set.
type Names = HashMap<Box<str>, f64>;

/// What a call puts aside until its return.
#[derive(Debug)]
pub(crate) struct SetAside {
    /// `#1` to `#30`, if the call has its own.
    arguments: Option<[f64; ARGUMENTS]>,
    names: Names,
}

/// All parameters that keep what was last assigned.
#[derive(Debug, Clone)]
pub(crate) struct Memory {
    /// `#n` is at `n`.
    numbered: Box<[f64]>,
    global: Names,
    local: Names,
}

impl Memory {
    /// Everything is 0, and no name is set.
    pub(crate) fn new() -> Self {
        let numbered = vec![0.0; LAST_PARAMETER + 1].into();
        Self { numbered, global: Names::new(), local: Names::new() }
    }

    pub(crate) fn get(&self, number: usize) -> f64 {
        self.numbered.get(number).copied().unwrap_or(0.0)
    }

    pub(crate) fn set(&mut self, number: usize, value: f64) {
        if let Some(place) = self.numbered.get_mut(number) {
            *place = value;
        }
    }

    pub(crate) fn get_name(&self, name: &str) -> Option<f64> {
        let names = if name.starts_with('_') { &self.global } else { &self.local };
        names.get(name).copied()
    }

    /// Sets `#<name>`.
    ///
    /// # Errors
    /// There are [`MOST_NAMES`] others.
    pub(crate) fn set_name(&mut self, name: &str, value: f64) -> Result<(), ErrorKind> {
        let names = if name.starts_with('_') { &mut self.global } else { &mut self.local };
        if let Some(place) = names.get_mut(name) {
            *place = value;
            return Ok(());
        }
        if names.len() >= MOST_NAMES {
            return Err(ErrorKind::TooManyNames(MOST_NAMES));
        }
        names.insert(name.into(), value);
        Ok(())
    }

    /// The numbered parameters that differ by more than this from those of another program.
    pub(crate) fn differing(&self, other: &Self, by: f64) -> impl Iterator<Item = usize> {
        let pairs = self.numbered.iter().zip(&other.numbered).enumerate();
        pairs.filter(move |(_, (a, b))| (*a - *b).abs() > by).map(|(number, _)| number)
    }

    /// Whether a named parameter differs by more than this from that of another program.
    pub(crate) fn names_differ(&self, other: &Self, by: f64) -> bool {
        let differ = |a: f64, b: f64| (a - b).abs() > by;
        let names = |one: &Names, other: &Names| {
            one.len() != other.len()
                || one.iter().any(|(name, &a)| other.get(name).is_none_or(|&b| differ(a, b)))
        };
        names(&self.global, &other.global) || names(&self.local, &other.local)
    }

    /// Begins a call: the values are `#1` and so on, and the other ones up to `#30` are 0.
    pub(crate) fn enter(&mut self, values: &[f64]) -> SetAside {
        let mut arguments = [0.0; ARGUMENTS];
        arguments.copy_from_slice(&self.numbered[1..=ARGUMENTS]);
        for (number, place) in self.numbered[1..=ARGUMENTS].iter_mut().enumerate() {
            *place = values.get(number).copied().unwrap_or(0.0);
        }
        SetAside { arguments: Some(arguments), names: std::mem::take(&mut self.local) }
    }

    /// Begins a call of M98, which has its own names but not its own `#1` to `#30`.
    pub(crate) fn enter_numbered(&mut self) -> SetAside {
        SetAside { arguments: None, names: std::mem::take(&mut self.local) }
    }

    /// Forgets the names of the running call.
    pub(crate) fn forget_names(&mut self) {
        self.local.clear();
    }

    /// Ends a call.
    pub(crate) fn leave(&mut self, aside: SetAside) {
        if let Some(arguments) = aside.arguments {
            self.numbered[1..=ARGUMENTS].copy_from_slice(&arguments);
        }
        self.local = aside.names;
    }
}

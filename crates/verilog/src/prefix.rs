//! The text with which the names of all modules and files begin, so that two configurations can be
//! in one design.

use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// The prefix that is used where no other is asked for.
const USUAL: &str = "carrystep_";

/// The beginning of the names of modules and files: a Verilog identifier.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Prefix(String);

/// Why a text cannot be a prefix.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "module names would begin with '{0}': a prefix has letters of ASCII, digits and _, and does not begin with a digit"
)]
pub struct PrefixError(String);

impl Prefix {
    /// The name that a module or a file with the usual name `usual` has with this prefix.
    pub fn name(&self, usual: &str) -> String {
        format!("{self}{}", usual.strip_prefix(USUAL).unwrap_or(usual))
    }

    /// A text that mentions modules by their usual names, with their names in its place.
    pub(crate) fn in_text(&self, text: &str) -> String {
        text.replace(USUAL, &self.0)
    }
}

impl Default for Prefix {
    fn default() -> Self {
        Self(USUAL.to_owned())
    }
}

impl FromStr for Prefix {
    type Err = PrefixError;

    fn from_str(text: &str) -> Result<Self, PrefixError> {
        let begins = text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
        let is_part = |one: char| one.is_ascii_alphanumeric() || one == '_';
        match begins && text.chars().all(is_part) {
            true => Ok(Self(text.to_owned())),
            false => Err(PrefixError(text.to_owned())),
        }
    }
}

impl fmt::Display for Prefix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefix_is_the_beginning_of_an_identifier() {
        for good in ["carrystep_", "x", "_a1_", "Left_"] {
            assert_eq!(
                good.parse::<Prefix>().unwrap().name("carrystep_link"),
                format!("{good}link")
            );
        }
        for bad in ["", "1x", "a b", "a-", "ä_", "$x", "a/", "../x"] {
            let error = bad.parse::<Prefix>().unwrap_err().to_string();
            assert!(error.contains(&format!("'{bad}'")), "{error}");
        }
    }
}

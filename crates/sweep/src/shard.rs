//! A part of a sweep, for one of several machines.
//!
//! The names of the fields are part of `--json` and may not change.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Shard `number` of `count`. It has every `count`-th case, so that easy and hard cases are spread
/// evenly.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, JsonSchema, Serialize, Deserialize,
)]
pub struct Shard {
    /// The number of the shard, counted from 1.
    pub number: u64,
    /// The number of shards.
    pub count: u64,
}

impl Shard {
    /// The whole sweep as one shard.
    pub const WHOLE: Self = Self { number: 1, count: 1 };

    /// The numbers of the cases in this shard, out of `all` cases.
    pub fn cases(self, all: u64) -> impl Iterator<Item = u64> {
        (self.number - 1..all).step_by(usize::try_from(self.count).unwrap_or(usize::MAX))
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text
            .split_once('/')
            .map(|(number, count)| (number.parse::<u64>(), count.parse::<u64>()));
        match numbers {
            Some((Ok(number), Ok(count))) if (1..=count).contains(&number) => {
                Ok(Self { number, count })
            }
            _ => Err(format!("'{text}' is no shard: 3/16 is the third of sixteen")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_together_have_every_case_once() {
        let mut all: Vec<u64> =
            (1..=3).flat_map(|number| Shard { number, count: 3 }.cases(10)).collect();
        all.sort_unstable();
        assert_eq!(all, (0..10).collect::<Vec<_>>());
        assert_eq!("3/16".parse(), Ok(Shard { number: 3, count: 16 }));
        assert!(
            ["0/3", "4/3", "3", "a/b", "1/0"].iter().all(|text| text.parse::<Shard>().is_err())
        );
    }
}

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

    /// Whether its numbers are those of a shard.
    pub(crate) fn is_valid(self) -> bool {
        (1..=self.count).contains(&self.number)
    }

    /// The number of cases in this shard, out of `all` cases.
    pub fn length(self, all: u64) -> u64 {
        all.checked_sub(self.number).map_or(0, |rest| rest / self.count + 1)
    }

    /// The number of the case that has this place in the shard, counted from 0.
    pub fn case(self, place: u64) -> u64 {
        self.number - 1 + place * self.count
    }

    /// The place of a case in this shard; `None` if the case is in another one.
    pub(crate) fn place(self, case: u64) -> Option<u64> {
        let before = case.checked_sub(self.number - 1)?;
        before.is_multiple_of(self.count).then_some(before / self.count)
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
            _ => Err(format!("'{text}' is not N/OF: 3/16 is the third of sixteen")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_together_have_every_case_once() {
        for all in [0, 1, 2, 3, 10, 12] {
            for count in 1..=5 {
                let mut cases = Vec::new();
                for number in 1..=count {
                    let shard = Shard { number, count };
                    let own: Vec<u64> = (0..shard.length(all)).map(|at| shard.case(at)).collect();
                    for (place, &case) in (0..).zip(&own) {
                        assert_eq!(shard.place(case), Some(place));
                    }
                    cases.extend(own);
                }
                cases.sort_unstable();
                assert_eq!(cases, (0..all).collect::<Vec<_>>());
            }
        }
        assert_eq!(Shard { number: 2, count: 3 }.place(2), None);
        assert_eq!(Shard::WHOLE.length(u64::MAX), u64::MAX);
    }

    #[test]
    fn a_shard_is_a_number_of_a_count() {
        assert_eq!("3/16".parse(), Ok(Shard { number: 3, count: 16 }));
        assert!(
            ["0/3", "4/3", "3", "a/b", "1/0"].iter().all(|text| text.parse::<Shard>().is_err())
        );
    }
}

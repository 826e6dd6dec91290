//! A choice between several, in words.

use alloc::format;
use alloc::string::String;

/// What can be chosen, as in `1, 2 or 6`.
pub fn one_of(choices: &[String]) -> String {
    match choices.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => choices.concat(),
    }
}

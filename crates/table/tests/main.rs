//! All tests of this crate in one program: one for each file would be linked, and generic functions
//! compiled, many times.

#[path = "../../profile/tests/support/pages.rs"]
#[allow(dead_code)]
mod pages;
mod support;

mod bad_input;
mod golden_values;
mod json_has_stable_names;
mod page;
mod planted_bugs_are_caught;
mod player_plays_the_table;
mod properties;

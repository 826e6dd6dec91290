//! All integration tests of this crate, in one program. With a program for each file, what they
//! share would be compiled and linked again for each.

#[path = "../../profile/tests/support/pages.rs"]
mod pages;
#[path = "../../../tests/support/repeats.rs"]
mod repeats;
mod support;

mod bad_input;
mod golden_values;
mod json_has_stable_names;
mod page;
mod planted_bugs_are_caught;
mod player_plays_the_table;
mod properties;

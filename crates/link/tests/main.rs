//! All integration tests of this crate, in one program. With a program for each file, what they
//! share would be compiled and linked again for each.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

#[path = "../../../tests/support/repeats.rs"]
mod repeats;
mod support;

mod clocks_in_c;
mod conversations;
mod faulty_line;
mod frames;
mod host;
mod lines;
mod planted_bugs_are_caught;
mod the_c_library_is_portable;

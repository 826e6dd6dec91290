//! All tests of this crate in one program: one for each file would be linked, and generic functions
//! compiled, many times.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

mod clocks_in_c;
mod conversations;
mod faulty_line;
mod frames;
mod host;
mod lines;
mod planted_bugs_are_caught;
mod the_c_library_is_portable;

//! All integration tests of this crate, in one program. With a program for each file, what they
//! share would be compiled and linked again for each.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod common;
#[path = "../../../tests/support/repeats.rs"]
mod repeats;

mod corexy;
mod from_block;
mod gantries;
mod laser;
mod places_of_outputs;
mod planted_bugs_are_caught;
mod programs_on_machines;
mod rotary_axes;

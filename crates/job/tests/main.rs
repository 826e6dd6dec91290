//! All integration tests of this crate, in one program. With a program for each file, what they
//! share would be compiled and linked again for each.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod common;
#[path = "../../../tests/support/repeats.rs"]
mod repeats;

mod compiled_sizes;
mod holds;
mod motors_at_rest;
mod programs;
mod random_paths;
mod reversals;
mod to_and_fro;

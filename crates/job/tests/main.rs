//! All tests of this crate in one program: one for each file would be linked, and generic functions
//! compiled, many times.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod common;

mod holds;
mod motors_at_rest;
mod programs;
mod random_paths;
mod reversals;
mod to_and_fro;

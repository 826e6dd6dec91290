//! All tests of this crate in one program: one for each file would be linked, and generic functions
//! compiled, many times.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod common;

mod captures;
mod checker;
mod outputs;
mod parts;
mod slices;
mod waveform;

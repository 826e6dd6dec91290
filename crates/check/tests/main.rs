//! All integration tests of this crate, in one program. With a program for each file, what they
//! share would be compiled and linked again for each.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod common;

mod captures;
mod checker;
mod outputs;
mod parts;
mod slices;
mod waveform;

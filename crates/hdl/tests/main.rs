//! All integration tests of this crate, in one program.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod engine;
mod parallel_core;

//! `regex-lite` under the name of `regex`, for crates of others that ask for `regex`.
//!
//! Both crates have the same authors and, for what is used here, the same interface. Rust-HDL asks for
//! `regex` and searches a few short names with it. `regex` takes 14 s of a processor to compile, a
//! twentieth of a clean build of the command, and `regex-lite` takes 2 s. It knows no classes of Unicode
//! and is slower on long texts; `docs/decisions/0118-rust-hdl-gets-small-regular-expressions.md` says
//! what was measured.

pub use regex_lite::{Captures, Error, Match, Regex, Replacer};

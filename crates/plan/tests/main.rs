//! All tests of this crate in one program: one for each file would be linked, and generic functions
//! compiled, many times.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod kept_fits;
mod mutated_move_files;
mod segment_counts;
mod streams;

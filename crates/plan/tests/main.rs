//! All integration tests of this crate, in one program. With a program for each file, what they
//! share would be compiled and linked again for each.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod kept_fits;
mod mutated_move_files;
mod segment_counts;
mod streams;

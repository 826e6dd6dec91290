//! All integration tests of this crate, in one program. With a program for each file, what they
//! share would be compiled and linked again for each.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

#[path = "linuxcnc/random.rs"]
mod random;
mod support;

mod actions;
mod arcs;
mod control;
mod errors;
mod lines;
mod linuxcnc;
mod mutated_programs;
mod page;
mod printed_programs;
mod properties;
mod subroutines;
mod tools;

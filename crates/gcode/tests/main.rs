//! All tests of this crate in one program: one for each file would be linked, and generic functions
//! compiled, many times.
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

//! Building blocks that Rust-HDL does not have, in the form that the exported Verilog needs:
//! registers with a reset value, memories, words of bits, and constants that differ between builds.

pub(crate) mod compiled_once;
pub mod constant;
pub mod formula;
pub mod held_memory;
pub mod memory;
pub mod optional;
pub mod per_axis;
#[macro_use]
pub mod register;
pub mod word;

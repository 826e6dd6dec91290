//! What Rust-HDL lacks, in the form that the exported Verilog needs: registers with their reset value,
//! memories, words of bits, and constants that differ between builds.

pub mod constant;
pub mod formula;
pub mod lanes;
pub mod memory;
pub mod register;
pub mod word;

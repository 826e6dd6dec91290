//! Rung 4: the Rust-HDL simulation is the model: random programs, the demo, every profile and a
//! program in G-code, every output in every clock; the golden vectors to the last edge and phase.

mod engine;
mod parallel;

//! Rung 4: the Rust-HDL simulation is the model: random programs, the demo and every profile, every
//! output in every clock; the golden vectors to the last edge and phase.

mod engine;
mod parallel;

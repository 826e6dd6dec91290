//! A whole board, clocked from its pins: bytes into the UART, pulses out. What the tools make of its Verilog shows on every pin in
//! every cycle what link and engine show in Rust-HDL.
//!
//! A test run does it for the iCEstick and for a Spartan-6, `cargo xtask long equivalence` for every iCE40 board and every family of
//! Spartans, with faults that must be seen.

mod ice40;
mod spartan;

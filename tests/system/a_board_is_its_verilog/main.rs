//! Whole boards, clocked from their pins: bytes go into the UART and pulses come out. In every
//! cycle, every pin of what the tools make from a board's Verilog must equal link and engine in
//! Rust-HDL.
//!
//! A test run covers the iCEstick and a Spartan-6. `cargo xtask long equivalence` covers every iCE40
//! and ECP5 board and every family of Spartans, and `cargo xtask long gowin` every Gowin board, with
//! planted faults that must be detected.

mod ecp5;
mod gowin;
mod ice40;
mod netlist;
mod spartan;

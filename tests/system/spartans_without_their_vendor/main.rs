//! What is shown for Spartan boards without ISE and Vivado.
//!
//! `edif`: the EDIF that yosys writes, read by spydrnet, has the cells and nets that our own reader
//! finds, and each port and net that the board's constraint file names. `clocks`: the checks of
//! `cargo xtask unisims` pass for all boards on small models of the cells, and detect faults. The
//! vendor's own models are in no package, so a person runs them: see `docs/spartans.md`.
//!
//! A test run covers the clock modules of all boards, and faults in a small EDIF file;
//! `a_board_is_its_verilog` reads the EDIF of one board there. `cargo xtask long spartans` reads
//! that of all.

mod clocks;
mod edif;

//! The open tools behind one door: Verilog to netlist, placed design and bitstream, and back to Verilog; and what it costs.
//!
//! ```text
//! Verilog --yosys--> netlist --nextpnr--> placed --icepack--> bitstream
//!                                                                 |
//!    Verilog with the netlist's names <--icebox_vlog-- iceunpack <+
//! ```
//!
//! Nothing here knows the engine but [`resources`], which is the table of what it costs.

pub mod board;
mod cells;
pub mod equivalence;
mod error;
pub mod ice40;
mod inverses;
pub mod kept;
mod read_back;
pub mod resources;
mod tool;
pub mod xilinx;

pub use error::SynthesisError;

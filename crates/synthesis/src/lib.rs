//! An interface to the open tools: from Verilog to netlist, placed design and bitstream, back to
//! Verilog, and the resources used.
//!
//! ```text
//! Verilog --yosys--> netlist --nextpnr--> placed --icepack--> bitstream
//!                                                                 |
//!    Verilog with the netlist's names <--icebox_vlog-- iceunpack <+
//! ```
//!
//! Only [`resources`], the table of the engine's resources, depends on the engine.

pub mod board;
mod cells;
pub mod equivalence;
mod error;
pub mod ice40;
mod inverses;
mod read_back;
pub mod resources;
mod tool;
pub mod xilinx;

pub use error::SynthesisError;

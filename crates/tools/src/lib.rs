//! Programs of others: which there are ([`programs`]), whether they are installed ([`doctor`]), and
//! how they are run, from Verilog to netlist, placed design and bitstream and back to Verilog, with
//! the resources used.
//!
//! ```text
//! Verilog --yosys--> netlist --nextpnr--> placed --icepack--> bitstream
//!                                                                 |
//!    Verilog with the netlist's names <--icebox_vlog-- iceunpack <+
//! ```
//!
//! Only [`resources`], the table of the engine's resources, [`adders`], that of several adders, and the
//! page of [`board`] depend on the engine.

pub mod adders;
pub mod board;
mod cells;
pub mod clock_modules;
pub mod doctor;
pub mod ecp5;
pub mod equivalence;
mod error;
pub mod flow;
pub mod gowin;
pub mod ice40;
pub mod kept;
mod nextpnr_log;
pub mod programs;
mod read_back;
mod registers;
pub mod resources;
pub mod timed;
mod tool;
pub mod xilinx;

pub use error::SynthesisError;

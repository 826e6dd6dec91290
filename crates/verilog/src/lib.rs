//! Generates readable Verilog from Rust-HDL modules, the files of the register map for clients, and
//! the files for a board's toolchain.
//!
//! Rust-HDL's own output names every module by its place in the tree, and makes a module of every
//! flip-flop. This crate reads the same checked tree and the same kernels, but writes one module
//! per kind, with real names, ANSI ports, and registers in clocked blocks.
//!
//! ```text
//! blocks --netlist--> ports, registers, children, kernel --kernel--> wires, blocks, clocked
//!        --module--> text
//! ```

mod board;
mod core;
mod docs;
mod expression;
mod fusesoc;
mod generated;
mod guard;
mod header;
mod instances;
mod kernel;
mod module;
mod names;
mod netlist;
mod parameters;
mod prefix;
mod purposes;
mod registers;
mod synchronizers;
#[cfg(test)]
mod tests;
mod write;

pub use crate::board::{CLOCK_NAME, Design, Gateware, SelfTestGateware, shipped_machine};
pub use crate::core::{
    ENGINE_WAIVERS, PARALLEL_WAIVERS, SELF_TEST_WAIVERS, engine_verilog, line_name, line_verilog,
    link_verilog, parallel_verilog, self_test_verilog, write_engine, write_parallel,
};
pub use crate::generated::{generated_files, write_generated_files};
pub use crate::prefix::{Prefix, PrefixError};
pub use crate::purposes::{ENGINE_NAME, LINK_NAME, SELF_TEST_NAME, parallel_name};
pub use crate::write::{TextFile, write};

use carrystep_boards::BoardError;
use carrystep_core::link::BaudError;
use carrystep_files::{InputError, TooManyAxes};
use carrystep_hdl::HdlError;
use std::path::PathBuf;
use thiserror::Error;

/// Why nothing could be generated.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The modules cannot be built with these parameters.
    #[error(transparent)]
    Hdl(#[from] HdlError),
    /// A module contains a construct that this crate does not translate.
    #[error("module {module}: cannot translate {what}")]
    Unsupported {
        /// Instance name of the module.
        module: String,
        /// The construct.
        what: String,
    },
    /// A module or a port has no description, which the Verilog would repeat.
    #[error("module {module}: {what} has no description")]
    Undescribed {
        /// Instance name of the module.
        module: String,
        /// The module or the port.
        what: String,
    },
    /// Two different modules would have the same name.
    #[error("two different modules would be called {0}")]
    SameName(String),
    /// The board has no pin for a port, or cannot make the clock.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The clock of the machine file cannot make a baud rate that the board supports.
    #[error(transparent)]
    Baud(#[from] BaudError),
    /// The machine file is not valid.
    #[error(transparent)]
    Machine(#[from] InputError),
    /// The parallel core has too few axes for the machine file.
    #[error(transparent)]
    Axes(#[from] TooManyAxes),
    /// A template uses a value that does not exist.
    #[error("a template: {0}")]
    Template(#[from] minijinja::Error),
    /// A file could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// Path of the file.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
}

impl ExportError {
    pub(crate) fn unsupported(module: &str, what: impl Into<String>) -> Self {
        Self::Unsupported { module: module.to_owned(), what: what.into() }
    }

    pub(crate) fn undescribed(module: &str, what: impl Into<String>) -> Self {
        Self::Undescribed { module: module.to_owned(), what: what.into() }
    }
}

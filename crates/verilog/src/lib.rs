//! Rust-HDL modules as readable Verilog, the register map for its clients, and what a board's toolchain needs.
//!
//! Rust-HDL's own output calls every module after its place in the tree and makes a module of every
//! flip-flop. This crate reads the same checked tree and the same kernels, and writes what a person would:
//! one module per kind, real names, ANSI ports, registers under the clock.
//!
//! ```text
//! blocks --netlist--> ports, registers, children, kernel --kernel--> wires, blocks, clocked --module--> text
//! ```

mod board;
mod core;
mod expression;
mod generated;
mod guard;
mod kernel;
mod module;
mod names;
mod netlist;
mod registers;
#[cfg(test)]
mod tests;
mod write;

pub use crate::board::{CLOCK_NAME, Design, Gateware, shipped_machine};
pub use crate::core::{
    CORE_NAME, CORE_WAIVERS, ENGINE_NAME, ENGINE_WAIVERS, LINK_NAME, engine_verilog, line_name, line_verilog,
    link_verilog, six_axis_verilog, write_core, write_engine,
};
pub use crate::generated::{generated_files, write_generated_files};
pub use crate::write::{TextFile, write};

use carrystep_boards::BoardError;
use carrystep_core::link::BaudError;
use carrystep_files::InputError;
use carrystep_hdl::HdlError;
use std::path::PathBuf;
use thiserror::Error;

/// Why there is no Verilog.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The modules cannot be built with these parameters.
    #[error(transparent)]
    Hdl(#[from] HdlError),
    /// A module says something that this crate does not translate.
    #[error("module {module}: cannot translate {what}")]
    Unsupported {
        /// Instance name of the module.
        module: String,
        /// The construct.
        what: String,
    },
    /// Two modules that differ want one name.
    #[error("two different modules would be called {0}")]
    SameName(String),
    /// A board has no pin for a port, or cannot make the clock.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The clock of the machine file makes no baud rate of the board.
    #[error(transparent)]
    Baud(#[from] BaudError),
    /// The machine file is none.
    #[error(transparent)]
    Machine(#[from] InputError),
    /// A template asks for what there is not.
    #[error("a template: {0}")]
    Template(#[from] minijinja::Error),
    /// A file could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

impl ExportError {
    pub(crate) fn unsupported(module: &str, what: impl Into<String>) -> Self {
        Self::Unsupported { module: module.to_owned(), what: what.into() }
    }
}

//! Errors of tools and of their files.

use crate::programs::Tool;
use thiserror::Error;

/// Why a netlist, a bitstream or a measurement could not be made.
#[derive(Debug, Error)]
pub enum SynthesisError {
    /// A program is not installed.
    #[error("{} is not installed: {} installs it", .0.name, .0.ways())]
    Missing(Tool),
    /// A program failed.
    #[error("{tool} failed: {message}")]
    Tool {
        /// Name of the program.
        tool: &'static str,
        /// The last lines of its output.
        message: String,
    },
    /// The output of a program does not have the format of the supported versions.
    #[error("cannot read what {tool} says: {what}")]
    Unread {
        /// Name of the program.
        tool: &'static str,
        /// The text that was not found.
        what: String,
    },
    /// A file could not be read or written.
    #[error("{context}: {source}")]
    Io {
        /// The operation that failed.
        context: String,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// The gateware to be built cannot be generated.
    #[error("{0}")]
    Gateware(String),
}

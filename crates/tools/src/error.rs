//! What can go wrong with tools and their files.

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
        /// Its name.
        tool: &'static str,
        /// The end of what it said.
        message: String,
    },
    /// A program's output is not what it was with the versions that are known.
    #[error("cannot read what {tool} says: {what}")]
    Unread {
        /// Its name.
        tool: &'static str,
        /// What was looked for.
        what: String,
    },
    /// A file could not be read or written.
    #[error("{context}: {source}")]
    Io {
        /// What was tried.
        context: String,
        /// The system's answer.
        source: std::io::Error,
    },
    /// Gateware that is to be built cannot be made.
    #[error("{0}")]
    Gateware(String),
}

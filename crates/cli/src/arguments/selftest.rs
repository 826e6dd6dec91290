//! The arguments of `carrystep selftest`. The docstrings of the fields are the command's help.

use clap::Args;
use std::path::PathBuf;

/// The arguments of `carrystep selftest`.
#[derive(Debug, Args)]
pub struct SelftestArguments {
    /// The board, by its name or by the file of your own board.
    #[arg(long, value_name = "BOARD")]
    pub board: String,
    /// Which of its parts; default: its first.
    #[arg(long, value_name = "PART")]
    pub part: Option<String>,
    /// A host is wired to the SPI. Pins that the SPI shares with other ports are then those of the
    /// SPI; otherwise the self-test would drive one that the host drives.
    #[arg(long)]
    pub spi: bool,
    /// Folder for all files; default: sim/out/BOARD-selftest.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

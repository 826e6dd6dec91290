//! The arguments of `carrystep serve`. The docstrings of the fields are the command's help.

use clap::{ArgGroup, Args};
use std::net::IpAddr;
use std::path::PathBuf;

/// What happens when the sender that drives is gone. The values have no docstrings, because clap
/// would then print the help of all options in its long form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum WhenGone {
    Finish,
    Stop,
}

/// The arguments of `carrystep serve`.
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("board").required(true).args(["port", "virtual_board"])))]
#[command(group(ArgGroup::new("network").multiple(true).args(["tcp", "web"])))]
pub struct ServeArguments {
    /// The machine.
    #[arg(long, value_name = "MACHINE.toml")]
    pub machine: PathBuf,
    /// The serial port of the board; `carrystep doctor` lists them.
    #[arg(long, value_name = "PORT")]
    pub port: Option<String>,
    /// Drive a virtual board, which begins and ends with this command.
    #[arg(long = "virtual")]
    pub virtual_board: bool,
    /// The virtual board runs as fast as possible and not in real time.
    #[arg(long, conflicts_with = "port")]
    pub fast: bool,
    /// A symbolic link to the pseudo-terminal, whose name changes from run to run. A link of this
    /// name is replaced; it is removed at the end.
    #[arg(long, value_name = "PATH")]
    pub link: Option<PathBuf>,
    /// Listen for senders on this TCP port, too; 0 takes a free one. There is no password: whoever
    /// reaches the port moves the machine.
    #[arg(long, value_name = "PORT")]
    pub tcp: Option<u16>,
    /// Show a web page on this TCP port; 0 takes a free one. The link that is printed holds a token:
    /// without it, the page only watches and stops.
    #[arg(long, value_name = "PORT")]
    pub web: Option<u16>,
    /// The address of the TCP ports. With another one than that of this computer itself, others
    /// reach the machine.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1", requires = "network")]
    pub listen: IpAddr,
    /// When the sender that drives is gone: `finish` executes the lines that have come, `stop`
    /// brings the machine to rest on its path and drops them. A jog is always cancelled.
    #[arg(long, value_enum, value_name = "WHAT", default_value = "finish")]
    pub when_gone: WhenGone,
    /// Greatest distance from the programmed path, mm, instead of that of G64: greater than 0.
    #[arg(long, value_name = "MM", value_parser = super::program::tolerance)]
    pub tolerance: Option<f64>,
}

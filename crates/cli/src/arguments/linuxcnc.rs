//! The arguments of `carrystep linuxcnc`. The docstrings of the fields are the command's help.

use carrystep_linuxcnc::HomeSwitch;
use clap::Args;
use std::path::PathBuf;

/// The arguments of `carrystep linuxcnc`.
#[derive(Debug, Args)]
pub struct LinuxcncArguments {
    /// The machine.
    #[arg(long, value_name = "MACHINE.toml")]
    pub machine: PathBuf,
    /// Folder for the files: NAME.ini, NAME.hal and NAME.tbl, where NAME is that of the machine
    /// file.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// The serial port of the board, or its spidev where the machine file has an SPI; it can be
    /// changed in the INI file. Default: /dev/ttyUSB1, or /dev/spidev0.0.
    #[arg(long, value_name = "PORT")]
    pub port: Option<String>,
    /// Time from a command to its pulses, ms: so late may the computer be. Default: 40, or five
    /// segments if they are longer.
    #[arg(long, value_name = "MS", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub horizon_ms: Option<u32>,
    /// LinuxCNC's user interface.
    #[arg(long, value_name = "PROGRAM", default_value = "axis")]
    pub display: String,
    /// LinuxCNC homes this axis on a general input of the machine file, by its number from 0. The
    /// other keys are those of a `home` table. Repeat for each axis.
    #[arg(
        long = "home-switch",
        value_name = "AXIS,input=N,toward=END,seek_speed=V,slow_speed=V,pull_off=X,position=X"
    )]
    pub switches: Vec<HomeSwitch>,
    /// Also write the sources of the HAL component to DIR/component; `make` builds it there.
    #[arg(long)]
    pub component: bool,
    /// Replace existing files.
    #[arg(long)]
    pub force: bool,
    /// One JSON document instead of the text.
    #[arg(long)]
    pub json: bool,
}

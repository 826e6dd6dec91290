//! The arguments of the commands that change where the tool is, and how its place is called: `jog`
//! and `offset`. The docstrings of the fields are the command's help.

use super::port::PortArguments;
use super::program::place;
use crate::work::Target;
use clap::Args;
use std::path::PathBuf;

/// The arguments of `carrystep jog`.
#[derive(Debug, Args)]
pub struct Jog {
    /// The axis, by its name.
    #[arg(value_name = "AXIS", requires = "distance", required_unless_present = "axes")]
    pub axis: Option<String>,
    /// Distance in units of the axis; negative is backward.
    #[arg(value_name = "DISTANCE", allow_negative_numbers = true)]
    pub distance: Option<f64>,
    /// Several axes at once, on a straight line, by their names: x=1.5,z=-0.2.
    #[arg(
        long = "axis",
        value_name = "AXIS=DISTANCE",
        value_delimiter = ',',
        value_parser = distance,
        conflicts_with = "axis"
    )]
    pub axes: Vec<(String, f64)>,
    /// Greatest speed along the line, units of the axes per minute; default: as fast as the axes'
    /// limits allow.
    #[arg(long, value_name = "UNITS", value_parser = feed, conflicts_with = "time")]
    pub feed: Option<f64>,
    /// The machine.
    #[arg(long, value_name = "MACHINE.toml")]
    pub machine: PathBuf,
    /// Duration of the move; default: as fast as the axis' limits allow.
    #[arg(long, value_name = "SECONDS")]
    pub time: Option<f64>,
    /// Jog further toward a limit that the axis has just met, although the gateware may not detect
    /// the closed switch.
    #[arg(long)]
    pub into_limit: bool,
    #[command(flatten)]
    pub port: PortArguments,
    /// One JSON document instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// Reads the distance of an axis.
fn distance(text: &str) -> Result<(String, f64), String> {
    let read = text.split_once('=').and_then(|(name, value)| {
        let value = value.parse::<f64>().ok().filter(|value| value.is_finite())?;
        (!name.is_empty()).then(|| (name.to_owned(), value))
    });
    read.ok_or_else(|| "expected an axis and a distance: x=1.5".to_owned())
}

/// Reads a feed, units per minute.
fn feed(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "expected units per minute".to_owned())?;
    if (1e-6..=1e9).contains(&value) {
        Ok(value)
    } else {
        Err("expected a feed from 0.000001 to 1000000000 units per minute".to_owned())
    }
}

/// The arguments of `carrystep offset`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct OffsetArguments {
    /// The coordinate system in which the machine place gets the values: G54 to G59, G59.1 to
    /// G59.3; G92 for all of them; or G43.1, the length of the tool.
    #[arg(long, value_name = "SYSTEM")]
    pub set: Option<Target>,
    /// Coordinates in mm or degrees: x=0,z=1.5.
    #[arg(value_name = "AXIS=VALUE", value_delimiter = ',', value_parser = place, requires = "set")]
    pub values: Vec<(usize, f64)>,
    /// Set all work offsets, stored places and the tool length to zero.
    #[arg(long, conflicts_with = "set")]
    pub clear: bool,
    /// The machine.
    #[arg(long, value_name = "MACHINE.toml")]
    pub machine: PathBuf,
    #[command(flatten)]
    pub port: PortArguments,
    /// One JSON document instead of the text.
    #[arg(long)]
    pub json: bool,
}

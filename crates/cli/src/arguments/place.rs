//! The arguments of the commands that change where the tool is, and how its place is called: `jog`,
//! `probe` and `offset`. The docstrings of the fields are the command's help.

use super::port::PortArguments;
use super::program::place;
use crate::jog::SetWord;
use crate::work::Target;
use clap::{ArgGroup, Args};
use std::path::PathBuf;

/// The arguments of `carrystep jog`.
#[derive(Debug, Args)]
pub struct Jog {
    /// The axis, by its name.
    #[arg(
        value_name = "AXIS",
        requires = "distance",
        required_unless_present_any = ["axes", "set"]
    )]
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
    /// Then set a work offset: the place where the axes rest gets these coordinates, in mm or
    /// degrees, in G54 to G59.3 or G92: --set G54 x=0,z=1.5. Without axes, those of the jog get 0;
    /// without a jog, nothing moves. G43.1 is the length of the tool.
    #[arg(long, value_names = ["SYSTEM", "AXIS=VALUE"], num_args = 1.., value_delimiter = ',')]
    pub set: Vec<SetWord>,
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

/// The arguments of `carrystep probe`.
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("sets").args(["set", "tool"])))]
pub struct ProbeArguments {
    /// The axis, by its name.
    #[arg(value_name = "AXIS")]
    pub axis: String,
    /// How far it moves at most, in units of the axis; negative is backward.
    #[arg(value_name = "DISTANCE", allow_negative_numbers = true)]
    pub distance: f64,
    /// Greatest speed, units of the axis per minute. The slower, the truer the place.
    #[arg(long, value_name = "UNITS", value_parser = feed)]
    pub feed: f64,
    /// Move until the probe opens, and not until it closes.
    #[arg(long)]
    pub away: bool,
    /// Then go back this far from the touched place, in units of the axis, but not beyond the place
    /// where the move began.
    #[arg(
        long,
        value_name = "UNITS",
        value_parser = length,
        allow_negative_numbers = true,
        conflicts_with = "away"
    )]
    pub retract: Option<f64>,
    /// Set the work offset of G54 to G59.3, or G92, so that the touched place is 0, or on a plate
    /// the work below it.
    #[arg(long, value_name = "SYSTEM", value_parser = system_or_g92)]
    pub set: Option<Target>,
    /// Set the length of the tool (G43.1) so that the touched place is 0, or on a plate the work
    /// below it, in G54 to G59.3, which stays as it is.
    #[arg(long, value_name = "SYSTEM", value_parser = tool_in)]
    pub tool: Option<Target>,
    /// How thick the plate is that the tool touches, in units of the axis.
    #[arg(
        long,
        value_name = "UNITS",
        value_parser = length,
        default_value_t = 0.0,
        allow_negative_numbers = true,
        requires = "sets"
    )]
    pub plate: f64,
    /// Probe although the machine has limit switches and is not homed, and ignore `travel`. The
    /// place where it begins is zero, so nothing can be set.
    #[arg(long, conflicts_with = "sets")]
    pub unhomed: bool,
    /// The machine.
    #[arg(long, value_name = "MACHINE.toml")]
    pub machine: PathBuf,
    #[command(flatten)]
    pub port: PortArguments,
    /// One JSON document instead of the text.
    #[arg(long)]
    pub json: bool,
}

/// Reads a coordinate system, or G92.
fn system_or_g92(text: &str) -> Result<Target, String> {
    match text.parse()? {
        Target::Tool | Target::ToolIn(_) => {
            Err("--tool G54 sets the length of the tool so that this place is 0 in G54".to_owned())
        }
        target @ (Target::System(_) | Target::All) => Ok(target),
    }
}

/// Reads the coordinate system that a tool is measured in.
fn tool_in(text: &str) -> Result<Target, String> {
    match text.parse() {
        Ok(Target::System(number)) => Ok(Target::ToolIn(number)),
        _ => Err("expected the coordinate system of the touched place: G54 to G59, G59.1 to G59.3"
            .to_owned()),
    }
}

/// Reads a length that is not negative.
fn length(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|value| (0.0..=1e6).contains(value));
    value.ok_or_else(|| "expected a length from 0 to 1000000".to_owned())
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

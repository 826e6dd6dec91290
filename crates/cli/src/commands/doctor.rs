//! `carrystep doctor`: checks tools, serial ports and permissions.

use crate::arguments::Doctor;
use crate::commands::boards;
use crate::failure::Failure;
use crate::output;
use carrystep_tools::doctor::{Computer, DoctorReport, PortAccess};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct Examined {
    passed: bool,
    #[serde(flatten)]
    report: DoctorReport,
}

/// Prints the report. Fails with status 3 if a tool is missing and with status 1 if a device cannot
/// be used.
pub fn run(arguments: &Doctor) -> Result<(), Failure> {
    let board = arguments.board.as_deref().map(boards::find).transpose()?;
    let report = DoctorReport::of(&Computer::this(), board.as_deref());
    let missing: Vec<&str> =
        report.tools.iter().filter(|tool| tool.path.is_none()).map(|tool| tool.name).collect();
    let missing = missing.join(", ");
    let (has_tools, has_access) = (report.has_all_tools(), report.has_all_access());
    if arguments.json {
        output::print_json(&Examined { passed: has_tools && has_access, report })?;
    } else {
        output::print(&told(&report))?;
    }
    match (has_tools, has_access) {
        (false, _) => Err(Failure::Tool(format!("missing: {missing}"))),
        (true, false) => Err(Failure::Check),
        (true, true) => Ok(()),
    }
}

fn told(report: &DoctorReport) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    for tool in &report.tools {
        let _ = match (&tool.path, &tool.version) {
            (None, _) => {
                writeln!(text, "{:<14}  MISSING, for {}: {}", tool.name, tool.purpose, tool.install)
            }
            (Some(_), Some(version)) => writeln!(text, "{:<14}  {version}", tool.name),
            (Some(_), None) => writeln!(text, "{:<14}  there", tool.name),
        };
    }
    let mut device = |path: &Path, usb: Option<&str>, maybe: &[String], access: &PortAccess| {
        let usb = usb.map_or_else(String::new, |usb| format!(" ({usb})"));
        let maybe = if maybe.is_empty() {
            String::new()
        } else {
            format!("; a board like {}", maybe.join(", "))
        };
        let _ = writeln!(text, "{}{usb}  {access}{maybe}", path.display());
    };
    for port in &report.serial_ports {
        device(&port.path, port.usb.as_deref(), &port.maybe, &port.access);
    }
    for found in &report.usb_devices {
        device(&found.path, Some(&found.usb), &found.maybe, &found.access);
    }
    if report.serial_ports.is_empty() {
        text += "no serial port (/dev/ttyUSB*, /dev/ttyACM*): is a board plugged in, by a cable that carries data?\n";
    }
    if report.usb_devices.is_empty() {
        text += "no USB device of a known board\n";
    }
    text
}

//! Finds what prevents this machine from using a board: missing tools, ports that may not be
//! opened, and the reasons.
//!
//! Nothing is opened and nothing is changed. Opening a serial port would change its control lines,
//! and some boards react to them, for example by a reset.

mod access;
mod host;
mod ports;
mod tools;

pub use access::{AccessRefusal, PortAccess, obstacle};
pub use host::{Computer, User};
pub use ports::{SerialPort, UsbDevice, serial_ports, usb_devices};
pub use tools::{FoundTool, tools};

use carrystep_boards::Board;
use schemars::JsonSchema;
use serde::Serialize;

/// What was found.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct DoctorReport {
    /// The tools that are needed, installed or not.
    pub tools: Vec<FoundTool>,
    /// Serial ports of USB devices.
    pub serial_ports: Vec<SerialPort>,
    /// USB devices whose vendor and product id are those of a board.
    pub usb_devices: Vec<UsbDevice>,
}

impl DoctorReport {
    /// Inspects this machine. With a board, it looks for what that board needs.
    pub fn of(host: &Computer, board: Option<&Board>) -> Self {
        Self {
            tools: tools(host, board),
            serial_ports: serial_ports(host),
            usb_devices: usb_devices(host),
        }
    }

    /// Whether no tool is missing.
    pub fn has_all_tools(&self) -> bool {
        self.tools.iter().all(|tool| tool.path.is_some())
    }

    /// Whether every port and device may be opened.
    pub fn has_all_access(&self) -> bool {
        let serial = self.serial_ports.iter().map(|port| &port.access);
        serial
            .chain(self.usb_devices.iter().map(|device| &device.access))
            .all(|access| *access == PortAccess::Granted)
    }
}

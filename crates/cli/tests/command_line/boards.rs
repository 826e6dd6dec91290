//! `run`, `jog`, `home`, `status` and `stop` with any peer on the port: nothing, another device,
//! another build, or a stopped machine. The message names each of them before a single write is
//! sent.

use crate::command::{Folder, GOOD, Ran};
use crate::device::{Device, Done};
use carrystep_files::{Machine, SourceText};
use serialport::{SerialPort as _, TTYPort};
use std::io::{ErrorKind, Read as _, Write as _};
use std::sync::mpsc::{Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// The homing of axis x, which is not part of the build.
const HOME: &str = "travel = [0, 300]\nhome = { toward = \"min\", seek_speed = 20, slow_speed = 2, pull_off = 2, position = 0 }\n";

/// The move of [`GOOD`], whose machine is in a file of its own with a tick that the engine can
/// keep.
const MOVE: &str =
    "machine_file = \"machine.toml\"\n[[move]]\nprofile = \"ranade\"\nto = { x = 2 }\n";

fn machine() -> String {
    GOOD.split("[[move]]").next().unwrap().replace("tick_ns = 1000", "tick_ns = 2000") + HOME
}

fn build_id() -> [u32; 2] {
    let source = SourceText { path: "machine.toml".into(), text: machine().into() };
    let machine = Machine::from_source(&source).unwrap();
    machine.line().unwrap().build_id(&machine.engine()).halves()
}

/// The peer behind a port.
pub enum Peer {
    Device(Box<Device>),
    Chatter,
    Nobody,
}

impl Peer {
    /// A board with the gateware of that machine.
    pub fn board() -> Device {
        let mut device = Device::new(1, 77);
        [device.facts[2], device.facts[3]] = build_id();
        device
    }
}

/// A port, and the peer behind it.
pub struct Port {
    pub name: String,
    end: Sender<()>,
    behind: JoinHandle<Peer>,
}

impl Port {
    pub fn new(mut peer: Peer) -> Self {
        let (mut ours, theirs) = TTYPort::pair().unwrap();
        let name = theirs.name().unwrap();
        ours.set_timeout(Duration::from_millis(2)).unwrap();
        let (end, ended) = channel();
        let behind = std::thread::spawn(move || {
            let mut bytes = [0; 256];
            while ended.try_recv().is_err() {
                let come = match ours.read(&mut bytes) {
                    Ok(come) => come,
                    // The other end is not open.
                    Err(error) if error.kind() != ErrorKind::TimedOut => {
                        std::thread::sleep(Duration::from_millis(1));
                        0
                    }
                    Err(_) => 0,
                };
                if let Peer::Device(device) = &mut peer {
                    device.elapse(1000);
                }
                let answers: Vec<u8> = match &mut peer {
                    Peer::Device(device) => {
                        bytes[..come].iter().flat_map(|&byte| device.byte(byte)).collect()
                    }
                    Peer::Chatter => b"ok T:21\r\n".to_vec(),
                    Peer::Nobody => Vec::new(),
                };
                // Answers that a client leaves unread when it ends are lost.
                let _ = ours.write_all(&answers);
            }
            peer
        });
        drop(theirs);
        Self { name, end, behind }
    }

    pub fn end(self) -> Peer {
        self.end.send(()).unwrap();
        self.behind.join().unwrap()
    }
}

pub fn folder() -> Folder {
    let folder = Folder::with_move(MOVE);
    folder.write("machine.toml", machine());
    folder
}

/// Every command that may move an axis, run on this port.
fn movers(folder: &Folder, port: &str) -> [Ran; 3] {
    ["run move.toml", "home x --machine machine.toml", "jog x 1.5 --machine machine.toml"]
        .map(|command| folder.run(&format!("{command} --port {port}")))
}

#[test]
fn wrong_peer_on_the_port_is_named() {
    let folder = folder();
    for (peer, says) in [
        (Peer::Nobody, "nothing has answered for"),
        (Peer::Chatter, "something answers"),
        (
            Peer::Device(Box::new(Device::new(1, 0))),
            "the gateware is build 0123456789abcdef, this machine needs build",
        ),
    ] {
        let port = Port::new(peer);
        for ran in movers(&folder, &port.name) {
            ran.refuses(&format!("error: {}: {says}", port.name));
        }
        folder.run(&format!("status --port {} --machine machine.toml", port.name)).refuses(says);
        if let Peer::Device(device) = port.end() {
            assert_eq!(device.log, []);
        }
    }
}

#[test]
fn a_port_that_is_absent_busy_or_no_port_is_named() {
    let folder = folder();
    for ran in movers(&folder, "/dev/carrystep-none") {
        ran.refuses("error: there is no serial port /dev/carrystep-none: is the board plugged in?");
    }
    for ran in movers(&folder, "move.toml") {
        ran.refuses("error: move.toml is no serial port.");
    }
    let port = Port::new(Peer::Nobody);
    let other = TTYPort::open(&serialport::new(&port.name, 921_600)).unwrap();
    for ran in movers(&folder, &port.name) {
        // The message names the process if the system reports it.
        assert_eq!((ran.status, ran.stdout.as_str()), (2, ""), "{}", ran.stderr);
        let begin = format!("error: serial port {} ", port.name);
        assert!(
            ran.stderr.starts_with(&begin) && ran.stderr.contains("in use by"),
            "{}",
            ran.stderr
        );
        assert!(ran.stderr.contains("close that first"), "{}", ran.stderr);
    }
    drop(other);
    port.end();
}

#[test]
fn impossible_moves_are_refused_before_the_port_is_opened() {
    let folder = folder();
    let refused = |text: &str, says: &str| {
        folder.write("bad.toml", text);
        folder.run("run bad.toml --port /dev/carrystep-none").refuses(says);
    };
    refused(&MOVE.replace("x = 2", "z = 2"), "the machine has no axis \"z\"");
    refused(
        &MOVE.replace("to =", "time = 0.001\nto ="),
        "over speed_limit 1000 units/s (5000 steps/s); at least",
    );
    // A curve that is fitted closely needs many segments.
    folder.write("slow.toml", format!("[machine.link]\nbaud = 1200\n{}", machine()));
    let wavy = MOVE
        .replace("machine.toml", "slow.toml")
        .replace("ranade", "sine")
        .replace("to =", "fit_ns = 1\nto =");
    refused(&wavy, "1200 baud are too slow for this move: axis 0 would run dry");
    folder.write("odd.toml", format!("[machine.link]\nbaud = 5_600_000\n{}", machine()));
    refused(&MOVE.replace("machine.toml", "odd.toml"), "the next ones that it makes are");

    let jog = |arguments: &str| {
        folder.run(&format!("jog {arguments} --machine machine.toml --port /dev/carrystep-none"))
    };
    jog("y 1").refuses("the machine has no axis \"y\"");
    jog("x inf").refuses("not a usable number");
    jog("x 1 --time 1e-9").refuses("move 1, axis x");
    let home =
        |arguments: &str| folder.run(&format!("home {arguments} --port /dev/carrystep-none"));
    home("y --machine machine.toml").refuses("no axis is called 'y'");
    folder.write("homeless.toml", machine().replace(HOME, ""));
    home("--machine homeless.toml").refuses("no axis of the machine has a home table");
}

#[test]
fn stopped_machine_does_not_move_until_the_stop_is_cleared() {
    let folder = folder();
    let mut device = Peer::board();
    device.stop(6);
    let port = Port::new(Peer::Device(Box::new(device)));
    let name = port.name.clone();
    for ran in movers(&folder, &name) {
        assert_eq!((ran.status, ran.stdout.as_str()), (1, ""), "{}", ran.stderr);
        assert_eq!(
            ran.stderr,
            "error: the machine has stopped: underrun; `carrystep stop --clear`, plan anew from the positions, and relieve the computer or raise the baud rate\n"
        );
    }
    let status = folder.run(&format!("status --port {name}"));
    assert!(status.stdout.contains("STOPPED: underrun; drivers "), "{}", status.stdout);
    assert!(
        status.stdout.contains("to do: `carrystep stop --clear`, plan anew"),
        "{}",
        status.stdout
    );
    let stop = folder.run(&format!("stop --clear --off --port {name} --json"));
    assert_eq!(stop.status, 0, "{}", stop.stderr);
    let found: serde_json::Value = serde_json::from_str(&stop.stdout).unwrap();
    assert_eq!((&found["fault"], &found["cause"]), (&false.into(), &serde_json::Value::Null));
    assert_eq!(found["axes"][0]["axis"], "0");
    let Peer::Device(device) = port.end() else { unreachable!("a device was put there") };
    assert_eq!(device.log, [Done::Write(0x22, 0), Done::Write(0x20, 0)]);
}

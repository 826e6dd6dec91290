//! The component at an SPI: its own thread opens, locks and sets a spidev, and moves a board of
//! models; what is wrong with the device or the line is named. A stand-in takes the place of the
//! kernel's spidev (`bench/spidev_stand_in.c`).
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_virtual_board::ModelBoard;
use rustix::fs::{FlockOperation, flock};
use std::fs::File;
use std::io::{ErrorKind, Read as _, Write as _};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};
use support::loader::{Loader, SANITIZERS, said};
use support::world::{CLOCK_HZ, build};
use tempfile::TempDir;

const SCK_HZ: u64 = 4_000_000;
/// What makes a regular file a spidev.
const STAND_IN: [&str; 2] = ["spidev_stand_in.c", "-Wl,--wrap=ioctl"];

fn loader(sanitizer: &str) -> Loader {
    Loader::new(&[STAND_IN[0], STAND_IN[1], sanitizer, "-fno-sanitize-recover=all"])
}

/// What is at the bus.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Bus {
    Board,
    /// Nothing: MISO is pulled up.
    Nothing,
}

/// A spidev, with what is at its bus in a thread of its own until it is dropped.
struct Spidev {
    folder: TempDir,
    end: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Spidev {
    fn new(bus: Bus) -> Self {
        let folder = TempDir::new().unwrap();
        File::create(folder.path().join("spidev0.0")).unwrap();
        let listener = UnixListener::bind(folder.path().join("socket")).unwrap();
        listener.set_nonblocking(true).unwrap();
        let end = Arc::new(AtomicBool::new(false));
        let ends = Arc::clone(&end);
        let thread = Some(thread::spawn(move || serve(&listener, bus, &ends)));
        Self { folder, end, thread }
    }

    fn port(&self) -> PathBuf {
        self.folder.path().join("spidev0.0")
    }

    /// The loader with this device.
    fn command(&self, loader: &Loader) -> Command {
        let mut command = Command::new(&loader.program);
        command.env("CARRYSTEP_SPI", self.folder.path().join("socket"));
        command
    }

    /// Loads the component for two and a half seconds with this parameter, and returns what it says.
    fn load(&self, loader: &Loader, parameter: &str) -> String {
        let port = format!("port={}", self.port().display());
        let words = ["load", &port, "wait=2500", parameter];
        said(&self.command(loader).args(words).output().unwrap())
    }
}

impl Drop for Spidev {
    fn drop(&mut self) {
        self.end.store(true, Ordering::Relaxed);
        let _ = self.thread.take().unwrap().join();
    }
}

/// A board in real time, until `end` is set.
fn serve(listener: &UnixListener, bus: Bus, end: &AtomicBool) {
    let (mut board, begun) = (ModelBoard::on_spi(&build(), SCK_HZ), Instant::now());
    let mut host: Option<UnixStream> = None;
    while !end.load(Ordering::Relaxed) {
        let now = begun.elapsed().as_micros() as u64 * (CLOCK_HZ / 1_000_000);
        if board.cycle() < now {
            board.run(now, &mut ());
        }
        let Some(stream) = &mut host else {
            host = listener.accept().ok().map(|(stream, _)| stream);
            if let Some(stream) = &host {
                stream.set_nonblocking(false).unwrap();
                stream.set_read_timeout(Some(Duration::from_millis(1))).unwrap();
            }
            thread::sleep(Duration::from_millis(1));
            continue;
        };
        match transfer(stream, |out| exchange(&mut board, bus, out)) {
            Ok(()) => {}
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Err(_) => host = None,
        }
    }
}

/// One transfer, if one comes within a millisecond.
fn transfer(
    stream: &mut UnixStream,
    exchange: impl FnOnce(&[u8]) -> Vec<u8>,
) -> std::io::Result<()> {
    let mut length = [0];
    stream.read_exact(&mut length)?;
    // The rest of a transfer that has begun comes for sure, but perhaps late.
    let [first] = length;
    stream.set_read_timeout(Some(Duration::from_secs(20)))?;
    let mut rest = [0; 3];
    stream.read_exact(&mut rest)?;
    let length = u32::from_ne_bytes([first, rest[0], rest[1], rest[2]]);
    let mut out = vec![0; length as usize];
    stream.read_exact(&mut out)?;
    stream.set_read_timeout(Some(Duration::from_millis(1)))?;
    stream.write_all(&exchange(&out))
}

fn exchange(board: &mut ModelBoard, bus: Bus, out: &[u8]) -> Vec<u8> {
    if bus == Bus::Nothing {
        return vec![0xff; out.len()];
    }
    out.iter().for_each(|&byte| board.say(byte));
    while board.unsaid() > 0 {
        board.run(board.cycle() + CLOCK_HZ / 1_000_000, &mut ());
    }
    let heard: Vec<u8> = std::iter::from_fn(|| board.next_byte()).collect();
    assert_eq!(heard.len(), out.len());
    heard
}

#[test]
fn sanitizers_find_nothing_while_a_board_at_an_spi_moves() {
    for sanitizer in SANITIZERS {
        let (loader, spidev) = (loader(sanitizer), Spidev::new(Bus::Board));
        let port = spidev.port().display().to_string();
        let words = ["run", &port, "500"];
        let said = said(&spidev.command(&loader).args(words).output().unwrap());
        assert!(said.contains("connected 1"), "{said}");
    }
}

#[test]
fn what_is_wrong_with_an_spi_is_named() {
    let loader = loader(SANITIZERS[0]);
    let says = |bus, parameter: &str| Spidev::new(bus).load(&loader, parameter);
    for (bus, parameter, words) in [
        (Bus::Board, "speed=9999", "the parameter speed must be 10000 to 50000000 Hz"),
        (Bus::Board, "speed=50000001", "the parameter speed must be 10000 to 50000000 Hz"),
        (Bus::Board, "build=1234", "fault 4: the board has another gateware"),
        (Bus::Nothing, "speed=4000000", "fault 3: no board answers at the port"),
    ] {
        let said = says(bus, parameter);
        assert!(said.contains(words), "{parameter}: {said}");
    }
    // Another program has the device, or it is not there.
    let spidev = Spidev::new(Bus::Board);
    let holder = File::open(spidev.port()).unwrap();
    flock(&holder, FlockOperation::NonBlockingLockExclusive).unwrap();
    let said = spidev.load(&loader, "joints=3");
    assert!(said.contains("fault 2: another program has the port"), "{said}");
    std::fs::remove_file(spidev.port()).unwrap();
    let said = spidev.load(&loader, "joints=3");
    assert!(said.contains("fault 1: the port cannot be opened"), "{said}");
}

#[test]
fn controller_without_mode_0_and_files_that_are_no_line_are_refused() {
    let (loader, spidev) = (loader(SANITIZERS[0]), Spidev::new(Bus::Board));
    let load = |port: &Path, refuses: &str| {
        let port = format!("port={}", port.display());
        let mut command = spidev.command(&loader);
        said(&command.args(["load", &port]).env("CARRYSTEP_SPI_REFUSES", refuses).output().unwrap())
    };
    for (port, refuses) in [(spidev.port(), "mode"), (PathBuf::from("/dev/null"), "")] {
        let said = load(&port, refuses);
        assert!(said.contains("fault 1: the port cannot be opened"), "{said}");
    }
}

/// The device fails in motion, as when its driver is unbound.
#[test]
fn spidev_that_goes_away_in_motion_is_named() {
    let (loader, spidev) = (loader(SANITIZERS[0]), Spidev::new(Bus::Board));
    let port = spidev.port().display().to_string();
    let mut command = spidev.command(&loader);
    command.args(["run", &port, "3000"]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let running = command.spawn().unwrap();
    thread::sleep(Duration::from_millis(1500));
    drop(spidev);
    let said = said(&running.wait_with_output().unwrap());
    assert!(said.contains("fault 1: ") && said.contains("connected 0"), "{said}");
}

//! Measures the time from `carrystep stop` in a second terminal to its frame on the wire. A spy
//! sits between the driving command and the board.

use crate::stops::{drives, moving, stop};
use crate::virtual_boards::{Board, document, folder, passed};
use serialport::{SerialPort as _, TTYPort};
use std::io::{Read as _, Write as _};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Forwards a host's bytes to a board, and reports when STOP was among them.
struct Spy {
    port: String,
    stops: Receiver<Instant>,
    ends: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Spy {
    fn new(board: &Board) -> Self {
        let (mut host, other) = TTYPort::pair().unwrap();
        let port = other.name().unwrap();
        // The name remains valid after this end is closed; the host opens it again.
        drop(other);
        host.set_timeout(Duration::from_millis(1)).unwrap();
        let mut line = serialport::new(&board.port, 3_000_000)
            .timeout(Duration::from_millis(1))
            .open()
            .unwrap();
        let (tell, stops) = mpsc::channel();
        let ends = Arc::new(AtomicBool::new(false));
        let over = Arc::clone(&ends);
        let thread = std::thread::spawn(move || {
            let (mut bytes, mut frame) = ([0; 512], Vec::new());
            while !over.load(Ordering::Relaxed) {
                let waits =
                    |port: &dyn serialport::SerialPort| port.bytes_to_read().unwrap_or(0) > 0;
                let (from_host, from_board) = (waits(&host), waits(&*line));
                if from_host {
                    let count = host.read(&mut bytes).unwrap_or(0);
                    for &byte in &bytes[..count] {
                        if byte != 0xc0 {
                            frame.push(byte);
                        } else if let [_, 0xa6, _, ..] = std::mem::take(&mut frame)[..] {
                            tell.send(Instant::now()).unwrap();
                        }
                    }
                    line.write_all(&bytes[..count]).unwrap();
                }
                if from_board {
                    let count = line.read(&mut bytes).unwrap_or(0);
                    let _ = host.write_all(&bytes[..count]);
                }
                if !from_host && !from_board {
                    std::thread::sleep(Duration::from_micros(200));
                }
            }
        });
        Self { port, stops, ends, thread: Some(thread) }
    }
}

impl Drop for Spy {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// A test in crates/link/tests/host.rs asserts without a clock how many exchanges a stop takes at
/// most. This test covers the whole path from a second command to the wire. The best of several
/// tries counts, because the computer may be busy.
#[test]
fn a_stop_from_a_second_terminal_is_on_the_wire_within_100_ms() {
    let folder = folder();
    let board = Board::new(&folder, "");
    let spy = Spy::new(&board);
    let mut took = Vec::new();
    for _ in 0..5 {
        let mut child = drives(&folder, "run long.toml", &spy.port);
        moving(&folder, &mut child, &spy.port);
        // A stop whose answer was late was sent again; these repetitions are removed.
        while spy.stops.try_recv().is_ok() {}
        let asked = Instant::now();
        passed(&stop(&folder, &spy.port, ""));
        took.push(spy.stops.recv_timeout(Duration::from_secs(10)).unwrap() - asked);
        let report = document(child);
        assert_eq!(report["stopped_by"], "stop", "{report}");
    }
    println!("from the start of the command to its frame on the wire: {took:?}");
    assert!(took.iter().min().unwrap() <= &Duration::from_millis(100), "{took:?}");
}

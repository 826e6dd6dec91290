//! Connections of `carrystep serve` that send as fast as they can and never read: the machine comes
//! to the end of what was taken, other connections are answered, and memory stays bounded.

use crate::command::Folder;
use crate::sender::{Sender, Served};
use crate::serve_streams::folder;
use crate::stops::stop;
use crate::web_sockets::Page;
use rustix::fs::OFlags;
use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read as _, Write};
use std::net::TcpStream;
use std::os::unix::fs::OpenOptionsExt as _;
use std::time::Duration;

/// A part of a program, of about a second, and its end.
const PART: &str = "G21 G90 F1500\nG1 X4 Y3\nG3 X2 Y5 I-2\nG1 Z0.5\nG1 X7 Y-2\n";
const END: [f64; 3] = [7.0, -2.0, 0.5];

/// A program that goes on while its sender sends more.
fn program() -> String {
    PART.repeat(10)
}

/// Looks of the command at its connections in which nothing is taken of a connection, until it
/// counts as one that is read no further.
const LOOKS: u32 = 100;

/// Most bytes that the memory of the command may grow by: up to 1 MiB is kept of what the driver
/// sends, and an empty line that waits has 8 bytes besides its own, in a queue that grows by
/// doubling.
const MOST_MEMORY: u64 = 24 << 20;

/// The greatest memory that a command has had, bytes.
fn peak(served: &Served) -> u64 {
    let text = std::fs::read_to_string(format!("/proc/{}/status", served.child.id())).unwrap();
    let peak = text.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    peak.trim().strip_suffix(" kB").unwrap().parse::<u64>().unwrap() << 10
}

/// A command, and the memory that it had before anybody sent anything.
struct Watched {
    served: Served,
    before: u64,
}

impl Watched {
    fn new(folder: &Folder, options: &str) -> Self {
        let served = Served::with(folder, &format!("--virtual --fast {options}"));
        let before = peak(&served);
        Self { served, before }
    }

    #[track_caller]
    fn is_bounded(&self) {
        let grown = peak(&self.served) - self.before;
        assert!(grown < MOST_MEMORY, "{grown} bytes more");
    }

    /// Sends the same text again and again, until nothing more is taken while the command answers
    /// another connection. Returns how many bytes were sent; ends with the error of a connection
    /// that the command closes.
    #[track_caller]
    fn stuffs(&self, to: &mut impl Write, text: &str, other: &mut Sender) -> io::Result<usize> {
        let text = text.repeat(4096 / text.len());
        let (mut sent, mut looks) = (0, 0);
        while looks < LOOKS {
            match to.write(&text.as_bytes()[sent % text.len()..]) {
                Ok(count) => (sent, looks) = (sent + count, 0),
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    other.report();
                    looks += 1;
                }
                Err(error) => return Err(error),
            }
            self.is_bounded();
        }
        Ok(sent)
    }
}

fn tcp(served: &Served) -> TcpStream {
    let stream = TcpStream::connect(served.tcp).unwrap();
    stream.set_nonblocking(true).unwrap();
    stream
}

/// Opens the pseudo-terminal, and waits for the first bytes of the welcome.
fn terminal(served: &Served) -> File {
    let flags = (OFlags::NONBLOCK | OFlags::NOCTTY).bits().cast_signed();
    let mut options = OpenOptions::new();
    let mut file = options.read(true).write(true).custom_flags(flags).open(&served.pty).unwrap();
    while let Err(error) = file.read(&mut [0; 2]) {
        assert_eq!(error.kind(), ErrorKind::WouldBlock);
        std::thread::sleep(Duration::from_millis(1));
    }
    file
}

/// A sender that watches; so another one drives.
fn watcher(served: &Served) -> Sender {
    let mut watcher = Sender::tcp(served);
    watcher.until(|line| line.starts_with("[MSG:another sender drives"));
    watcher
}

/// Waits until a byte has come, and does not read it.
fn is_greeted(stream: &TcpStream) {
    stream.set_nonblocking(false).unwrap();
    stream.peek(&mut [0]).unwrap();
    stream.set_nonblocking(true).unwrap();
}

#[test]
fn driver_by_tcp_that_never_reads_gets_its_program_done() {
    let folder = folder();
    let watched = Watched::new(&folder, "");
    let mut driver = tcp(&watched.served);
    is_greeted(&driver);
    let mut watcher = watcher(&watched.served);
    driver.write_all(program().as_bytes()).unwrap();
    watcher.state("Run");
    // A thousand bytes of answer for three.
    let sent = watched.stuffs(&mut driver, "$$\n?", &mut watcher).unwrap();
    assert!(sent > 1 << 20, "{sent}");
    assert_eq!(watcher.place(), END);
    // It still drives, and Ctrl-C ends the command.
    assert_eq!(watcher.ask("G0 X0").last().unwrap(), "error:8");
    assert_eq!(watched.served.interrupt().0, 0);
}

#[test]
fn driver_on_the_terminal_that_never_reads_gets_its_program_done_and_loses_no_answer() {
    let folder = folder();
    let watched = Watched::new(&folder, "");
    let mut driver = terminal(&watched.served);
    let mut watcher = watcher(&watched.served);
    // As soon as so much waits that it counts as slow, no further line is taken.
    driver.write_all(program().as_bytes()).unwrap();
    watcher.state("Run");
    let sent = watched.stuffs(&mut driver, "\n?", &mut watcher).unwrap();
    assert!(sent > 1 << 20, "{sent}");
    assert_eq!(watcher.place(), END);
    // Now it reads: every line has its answer, in the order of the lines.
    let mut lines = program().lines().count() + sent.div_ceil(2);
    let (mut bytes, mut rest) = ([0; 4096], Vec::new());
    while lines > 0 {
        match driver.read(&mut bytes) {
            Ok(count) => rest.extend(&bytes[..count]),
            Err(error) if error.kind() == ErrorKind::WouldBlock => drop(watcher.report()),
            Err(error) => panic!("{error}"),
        }
        while let Some(end) = rest.iter().position(|&byte| byte == b'\n') {
            let line: Vec<u8> = rest.drain(..=end).collect();
            lines -= usize::from(line.starts_with(b"ok"));
        }
    }
    // The virtual board ends with the command, and is not found any more then.
    stop(&folder, &watched.served.board, "");
    assert_eq!(watched.served.end().0, 0);
}

#[test]
fn watcher_by_tcp_that_never_reads_is_closed_and_the_driver_does_not_notice() {
    let folder = folder();
    let watched = Watched::new(&folder, "");
    let mut driver = Sender::tcp(&watched.served);
    let mut other = watcher(&watched.served);
    driver.simple(&program());
    let mut deaf = tcp(&watched.served);
    let closed = watched.stuffs(&mut deaf, "?\n", &mut other).unwrap_err();
    assert!(
        matches!(closed.kind(), ErrorKind::ConnectionReset | ErrorKind::BrokenPipe),
        "{closed}"
    );
    assert_eq!(driver.place(), END);
    driver.simple("G1 X0 Y0 Z0");
    assert_eq!(driver.place(), [0.0; 3]);
    watched.is_bounded();
    assert_eq!(watched.served.interrupt().0, 0);
}

#[test]
fn page_that_never_reads_is_closed_and_the_driver_does_not_notice() {
    let folder = folder();
    let watched = Watched::new(&folder, "--web 0");
    let mut driver = Sender::tcp(&watched.served);
    driver.simple(&program());
    // For the state it is answered only as long as it reads; it stays.
    let mut deaf = Page::new(&watched.served);
    (0..20_000).for_each(|_| deaf.say("?"));
    assert_eq!(driver.place(), END);
    watched.is_bounded();
    // Each other word is answered.
    while deaf.try_say("x").is_ok() {
        watched.is_bounded();
    }
    driver.simple("G1 X0 Y0 Z0");
    assert_eq!(driver.place(), [0.0; 3]);
    assert_eq!(Page::new(&watched.served).state()["state"], "Idle");
    assert_eq!(watched.served.interrupt().0, 0);
}

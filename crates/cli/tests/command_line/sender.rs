//! A sender, as Grbl's documentation describes it: line by line, or by counting characters; and a
//! running `carrystep serve`.

use crate::command::Folder;
use rustix::fs::OFlags;
use std::collections::VecDeque;
use std::fs::OpenOptions;
use std::io::{BufRead as _, BufReader, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::os::unix::fs::OpenOptionsExt as _;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

/// Longest time in which something has to happen; the computer may be busy.
const PATIENCE: Duration = Duration::from_secs(60);

/// A running `carrystep serve`, with TCP.
pub struct Served {
    pub child: Child,
    said: BufReader<ChildStdout>,
    pub pty: String,
    pub tcp: SocketAddr,
    pub board: String,
    /// The link to the page; empty without one.
    pub web: String,
}

impl Served {
    /// Serves a virtual board of its own, which is fast.
    pub fn new(folder: &Folder, options: &str) -> Self {
        Self::with(folder, &format!("--virtual --fast {options}"))
    }

    pub fn with(folder: &Folder, options: &str) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
        command.args(["serve", "--machine", "machine.toml", "--tcp", "0"]);
        command.args(options.split_whitespace()).env("CARRYSTEP_STATE", folder.state());
        command.current_dir(folder.path("")).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut said = BufReader::new(child.stdout.take().unwrap());
        let mut field = |name: &str| {
            let mut line = String::new();
            said.read_line(&mut line).unwrap();
            let rest = line.strip_prefix(name).unwrap_or_else(|| panic!("{name}: {line:?}"));
            rest.trim().split(", also ").next().unwrap().to_owned()
        };
        let (pty, tcp, board) = (field("pty "), field("tcp "), field("board "));
        let web = if options.contains("--web") { field("web ") } else { String::new() };
        Self { child, said, pty, tcp: tcp.parse().unwrap(), board, web }
    }

    /// Address and port of the page.
    pub fn web_address(&self) -> String {
        let (address, _) = self.web.split_once("/#").unwrap();
        address.strip_prefix("http://").unwrap().to_owned()
    }

    /// The token of the page.
    pub fn token(&self) -> &str {
        self.web.split_once("#token=").unwrap().1
    }

    /// Waits for the end. Returns the status and the output.
    pub fn end(mut self) -> (i32, String) {
        let mut said = String::new();
        self.said.read_to_string(&mut said).unwrap();
        self.child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        (self.child.wait().unwrap().code().unwrap_or(-1), said)
    }

    /// Ends it by Ctrl-C, and returns the same.
    pub fn interrupt(self) -> (i32, String) {
        crate::stops::signal(&self.child, "-INT");
        self.end()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // If the test has come so far, it has ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A connection that does not block.
trait Stream: Read + Write {}

impl<S: Read + Write> Stream for S {}

/// A connected sender.
pub struct Sender {
    stream: Box<dyn Stream>,
    /// What has come of a line.
    bytes: Vec<u8>,
    /// Lines that have come and were not looked at.
    seen: VecDeque<String>,
    is_closed: bool,
}

impl Sender {
    fn new(stream: impl Stream + 'static) -> Self {
        let (bytes, seen) = (Vec::new(), VecDeque::new());
        Self { stream: Box::new(stream), bytes, seen, is_closed: false }
    }

    /// Waits for the welcome.
    fn welcomed(mut self) -> Self {
        self.until(|line| line.starts_with("Grbl 1.1"));
        self
    }

    /// Connects by TCP, and waits for the welcome.
    pub fn tcp(served: &Served) -> Self {
        Self::at(served.tcp)
    }

    /// Connects to this address, and waits for the welcome.
    pub fn at(address: SocketAddr) -> Self {
        let stream = TcpStream::connect(address).unwrap();
        stream.set_nodelay(true).unwrap();
        stream.set_nonblocking(true).unwrap();
        Self::new(stream).welcomed()
    }

    /// Opens the pseudo-terminal, and waits for the welcome.
    pub fn pty(served: &Served) -> Self {
        let flags = (OFlags::NONBLOCK | OFlags::NOCTTY).bits().cast_signed();
        let mut options = OpenOptions::new();
        options.read(true).write(true).custom_flags(flags);
        loop {
            let mut this = Self::new(options.open(&served.pty).unwrap());
            let begin = Instant::now();
            while this.seen.is_empty() && begin.elapsed() < Duration::from_secs(2) {
                this.read();
            }
            if !this.seen.is_empty() {
                return this.welcomed();
            }
            // The command has not noticed that the sender before was gone.
            drop(this);
            std::thread::sleep(Duration::from_millis(300));
        }
    }

    /// Reads what has come.
    fn read(&mut self) {
        let mut bytes = [0; 4096];
        match self.stream.read(&mut bytes) {
            Ok(0) => self.is_closed = true,
            Ok(count) => self.bytes.extend(&bytes[..count]),
            Err(error) if error.kind() == ErrorKind::WouldBlock => {
                std::thread::sleep(Duration::from_micros(200));
            }
            Err(_) => self.is_closed = true,
        }
        while let Some(end) = self.bytes.iter().position(|&byte| byte == b'\n') {
            let line: Vec<u8> = self.bytes.drain(..=end).collect();
            let line = String::from_utf8(line).unwrap();
            let line = line.trim_end();
            if !line.is_empty() {
                self.seen.push_back(line.to_owned());
            }
        }
    }

    /// Sends bytes; reads meanwhile if there is no room for them.
    pub fn send(&mut self, text: impl AsRef<[u8]>) {
        let mut rest = text.as_ref();
        let begin = Instant::now();
        while !rest.is_empty() {
            match self.stream.write(rest) {
                Ok(count) => rest = &rest[count..],
                Err(error) if error.kind() == ErrorKind::WouldBlock => self.read(),
                Err(error) => panic!("{error}"),
            }
            assert!(begin.elapsed() < PATIENCE, "nothing is read");
        }
    }

    /// The next line; `None` if the connection was closed.
    pub fn next(&mut self) -> Option<String> {
        let begin = Instant::now();
        while self.seen.is_empty() && !self.is_closed {
            self.read();
            assert!(begin.elapsed() < PATIENCE, "nothing comes");
        }
        self.seen.pop_front()
    }

    /// The lines that have come and were not looked at.
    pub fn taken(&mut self) -> Vec<String> {
        self.seen.drain(..).collect()
    }

    /// Waits for such a line, and returns it. Lines before it are dropped.
    #[track_caller]
    pub fn until(&mut self, is_it: impl Fn(&str) -> bool) -> String {
        loop {
            let line = self.next().expect("the connection was closed");
            if is_it(&line) {
                return line;
            }
        }
    }

    /// Sends a line, and returns what comes up to its answer.
    #[track_caller]
    pub fn ask(&mut self, line: &str) -> Vec<String> {
        self.send(format!("{line}\n"));
        let mut said = Vec::new();
        loop {
            let line = self.next().expect("the connection was closed");
            said.push(line.clone());
            if is_answer(&line) {
                return said;
            }
        }
    }

    /// Sends a line that must be done.
    #[track_caller]
    pub fn done(&mut self, line: &str) {
        let said = self.ask(line);
        assert_eq!(said.last().map(String::as_str), Some("ok"), "{line}: {said:?}");
    }

    /// Sends lines one by one, each behind the answer to the one before.
    #[track_caller]
    pub fn simple(&mut self, program: &str) {
        program.lines().for_each(|line| self.done(line));
    }

    /// Sends lines by counting characters: at most so many bytes have no answer.
    #[track_caller]
    pub fn counted(&mut self, program: &str, buffer: usize) {
        let mut open: VecDeque<usize> = VecDeque::new();
        for line in program.lines() {
            let bytes = line.len() + 1;
            while open.iter().sum::<usize>() + bytes > buffer {
                let line = self.until(is_answer);
                assert_eq!(line, "ok");
                open.pop_front();
            }
            self.send(format!("{line}\n"));
            open.push_back(bytes);
        }
        for _ in open {
            assert_eq!(self.until(is_answer), "ok");
        }
    }

    /// A status report. Answers that come meanwhile are kept.
    #[track_caller]
    pub fn report(&mut self) -> String {
        self.send("?");
        let mut kept = VecDeque::new();
        loop {
            let line = self.next().expect("the connection was closed");
            if line.starts_with('<') {
                kept.extend(self.seen.drain(..));
                self.seen = kept;
                return line;
            }
            kept.push_back(line);
        }
    }

    /// Asks for the state until it is this one, and returns the report.
    #[track_caller]
    pub fn state(&mut self, state: &str) -> String {
        let begin = Instant::now();
        loop {
            let report = self.report();
            if report.starts_with(&format!("<{state}|")) {
                return report;
            }
            assert!(begin.elapsed() < PATIENCE, "wanted {state}: {report} {:?}", self.seen);
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Waits until the machine rests, and returns its machine place.
    #[track_caller]
    pub fn place(&mut self) -> Vec<f64> {
        place(&self.state("Idle"))
    }
}

/// Whether a line answers a line.
pub fn is_answer(line: &str) -> bool {
    line == "ok" || line.starts_with("error:")
}

/// The machine place of a report.
pub fn place(report: &str) -> Vec<f64> {
    let (_, rest) = report.split_once("MPos:").unwrap();
    let end = rest.find(['|', '>']).unwrap();
    rest[..end].split(',').map(|value| value.parse().unwrap()).collect()
}

//! The client end of the socket: a command that sends a request to the command that drives the
//! board.

use super::{Holder, SocketRequest, claim, folder};
use std::io::{self, BufRead as _, BufReader, Write as _};
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

/// A connection to the command that drives a board.
pub struct Caller {
    stream: BufReader<UnixStream>,
    /// That command.
    pub holder: Holder,
}

/// The result of a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Reply {
    /// The answer, one line.
    Line(String),
    /// The command has ended and released the port.
    Ended,
    /// No answer came within the time. The request remains in the socket: if the command resumes,
    /// it reads it.
    Silent,
}

/// Connects to the command that drives the board at this port; `None` if no command of this user
/// does.
pub fn call(port: &str) -> Option<Caller> {
    let holder = claim::holder(port).filter(|holder| holder.listens)?;
    let name = claim::device(port)?;
    let sockets =
        folder::all().into_iter().map(|folder| folder.join(&name).with_extension("socket"));
    let stream = sockets.into_iter().find_map(|path| UnixStream::connect(path).ok())?;
    Some(Caller { stream: BufReader::new(stream), holder })
}

impl Caller {
    /// As [`Caller::ask`], with a text of one line behind the word.
    pub fn ask_with(&mut self, request: SocketRequest, text: &str, wait: Duration) -> Reply {
        match writeln!(self.stream.get_mut(), "{} {text}", request.word()) {
            Ok(()) => self.line(wait),
            Err(_) => Reply::Ended,
        }
    }

    /// Sends a request and waits up to `wait` for the answer.
    pub fn ask(&mut self, request: SocketRequest, wait: Duration) -> Reply {
        match writeln!(self.stream.get_mut(), "{}", request.word()) {
            Ok(()) => self.line(wait),
            Err(_) => Reply::Ended,
        }
    }

    /// Waits up to `wait` for the command to end; returns true if it has ended.
    pub fn ends(&mut self, wait: Duration) -> bool {
        let begin = Instant::now();
        loop {
            let left = wait.saturating_sub(begin.elapsed());
            match self.line(left) {
                Reply::Ended => return true,
                Reply::Silent => return false,
                Reply::Line(_) => {}
            }
        }
    }

    fn line(&mut self, wait: Duration) -> Reply {
        // A time-out of zero would mean no time-out.
        let wait = wait.max(Duration::from_millis(1));
        let mut line = String::new();
        if self.stream.get_ref().set_read_timeout(Some(wait)).is_err() {
            return Reply::Ended;
        }
        match self.stream.read_line(&mut line) {
            Ok(1..) => Reply::Line(line.trim_end().to_owned()),
            Err(error)
                if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) =>
            {
                Reply::Silent
            }
            Ok(0) | Err(_) => Reply::Ended,
        }
    }
}

//! The socket of a command that drives a board: lines in, lines out, never waiting.

use super::Request;
use std::io::{self, Read as _, Write as _};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::PathBuf;

/// Most callers at once; further ones wait in the system's queue.
const CALLERS: usize = 16;
/// Most bytes of a request.
const LONGEST: usize = 64;

/// The socket, and who has called.
pub struct Door {
    listener: UnixListener,
    path: PathBuf,
    callers: Vec<Caller>,
}

struct Caller {
    stream: UnixStream,
    line: Vec<u8>,
}

impl Door {
    /// Listens at this path. Only the holder of the port's lock calls this, so a socket that is there already is a
    /// dead process' own.
    pub fn open(path: PathBuf) -> io::Result<Self> {
        match std::fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        let listener = UnixListener::bind(&path)?;
        listener.set_nonblocking(true)?;
        Ok(Self { listener, path, callers: Vec::new() })
    }

    /// Answers what has been asked since the last look; whether a stop was among it. Takes microseconds.
    pub fn poll(&mut self, answer: &mut dyn FnMut(Request) -> String) -> bool {
        while self.callers.len() < CALLERS {
            let Ok((stream, _)) = self.listener.accept() else { break };
            if stream.set_nonblocking(true).is_ok() {
                self.callers.push(Caller { stream, line: Vec::new() });
            }
        }
        let mut stop = false;
        self.callers.retain_mut(|caller| {
            let (requests, stays) = caller.take();
            for request in requests {
                stop |= request == Request::Stop;
                // A caller that does not take its answer loses it.
                let _ = caller.stream.write_all(format!("{}\n", answer(request)).as_bytes());
            }
            stays
        });
        stop
    }
}

impl Caller {
    /// What this caller asks for, and whether it may ask for more.
    fn take(&mut self) -> (Vec<Request>, bool) {
        let mut bytes = [0; LONGEST];
        let stays = match self.stream.read(&mut bytes) {
            Ok(0) => false,
            Ok(count) => {
                self.line.extend(bytes.iter().take(count));
                true
            }
            Err(error) => matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted),
        };
        let mut requests = Vec::new();
        while let Some(end) = self.line.iter().position(|&byte| byte == b'\n') {
            let line: Vec<u8> = self.line.drain(..=end).collect();
            let asked = |request: &Request| line.strip_suffix(b"\n") == Some(request.word().as_bytes());
            requests.extend([Request::Status, Request::Stop].into_iter().find(asked));
        }
        (requests, stays && self.line.len() < LONGEST)
    }
}

impl Drop for Door {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

//! The socket of a command that drives a board: it reads requests and writes answers, one line
//! each, and never blocks.

use super::SocketRequest;
use std::io::{self, Read as _, Write as _};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::PathBuf;

/// The greatest number of callers kept between two polls. The oldest are dropped first, so that
/// idle callers block nobody.
const CALLERS: usize = 16;
/// The greatest number of callers accepted in one poll, which is what the system queues.
const QUEUE: usize = 128;
/// The greatest length of a request in bytes.
const LONGEST: usize = 1024;

/// The socket and its callers.
pub struct ControlSocket {
    listener: UnixListener,
    path: PathBuf,
    callers: Vec<Caller>,
}

struct Caller {
    stream: UnixStream,
    line: Vec<u8>,
}

impl ControlSocket {
    /// Listens at this path. Only the holder of the port's lock may call this, so an existing
    /// socket belongs to a dead process.
    pub fn open(path: PathBuf) -> io::Result<Self> {
        match std::fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        let listener = UnixListener::bind(&path)?;
        listener.set_nonblocking(true)?;
        Ok(Self { listener, path, callers: Vec::new() })
    }

    /// Answers the requests since the last poll. Returns true if one of them was a stop. It takes
    /// microseconds.
    pub fn poll(&mut self, answer: &mut dyn FnMut(SocketRequest, &str) -> String) -> bool {
        for _ in 0..QUEUE {
            let Ok((stream, _)) = self.listener.accept() else { break };
            if stream.set_nonblocking(true).is_ok() {
                self.callers.push(Caller { stream, line: Vec::new() });
            }
        }
        let mut stop = false;
        self.callers.retain_mut(|caller| {
            let (requests, stays) = caller.take();
            for (request, text) in requests {
                stop |= request == SocketRequest::Stop;
                // A caller that does not read its answer loses it.
                let _ = caller.stream.write_all(format!("{}\n", answer(request, &text)).as_bytes());
            }
            stays
        });
        let idle = self.callers.len().saturating_sub(CALLERS);
        self.callers.drain(..idle);
        stop
    }
}

impl Caller {
    /// The complete requests of this caller with the text behind their words, and whether its
    /// connection stays open.
    fn take(&mut self) -> (Vec<(SocketRequest, String)>, bool) {
        let mut bytes = [0; LONGEST];
        let stays = match self.stream.read(&mut bytes) {
            Ok(0) => false,
            Ok(count) => {
                self.line.extend(bytes.iter().take(count));
                true
            }
            Err(error) => {
                matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted)
            }
        };
        let mut requests = Vec::new();
        while let Some(end) = self.line.iter().position(|&byte| byte == b'\n') {
            let line: Vec<u8> = self.line.drain(..=end).collect();
            let word = std::str::from_utf8(&line).ok().and_then(|line| line.strip_suffix('\n'));
            let (word, text) =
                word.map_or(("", ""), |line| line.split_once(' ').unwrap_or((line, "")));
            requests.extend(word.parse::<SocketRequest>().ok().map(|word| (word, text.to_owned())));
        }
        (requests, stays && self.line.len() < LONGEST)
    }
}

impl Drop for ControlSocket {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Programs that connect and never hang up must not prevent another one from stopping the axes.
    #[test]
    fn idle_callers_do_not_block_a_stop() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("door");
        let mut control_socket = ControlSocket::open(path.clone()).unwrap();
        let mut answer = |_: SocketRequest, _: &str| "yes".to_owned();
        let idle: Vec<UnixStream> =
            (0..3 * CALLERS).map(|_| UnixStream::connect(&path).unwrap()).collect();
        assert!(!control_socket.poll(&mut answer));
        let mut caller = UnixStream::connect(&path).unwrap();
        caller.write_all(b"stop\n").unwrap();
        assert!(control_socket.poll(&mut answer));
        let mut said = [0; 4];
        caller.read_exact(&mut said).unwrap();
        assert_eq!((&said, control_socket.callers.len()), (b"yes\n", CALLERS));
        drop(idle);
        assert!(!control_socket.poll(&mut answer));
        assert_eq!(control_socket.callers.len(), 1);
    }
}

//! A connection until it is answered: it reads the head of one request, and writes one answer.

use super::request::{Asked, LONGEST_HEAD, judge};
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::{Shutdown, SocketAddr, TcpStream};
use std::time::{Duration, Instant};
use tungstenite::handshake::derive_accept_key;

/// The page.
const PAGE: &str = include_str!("page.html");
/// Longest time until a connection has its answer.
const PATIENCE: Duration = Duration::from_secs(5);
/// Longest time until the other end has read an answer and closes.
const LINGER: Duration = Duration::from_secs(1);
/// Bytes that are read at once.
const READ: usize = 2048;
/// Most reads in one look: bytes that come behind an answer are dropped.
const READS: usize = 8;

/// A connection that is not answered yet.
#[derive(Debug)]
pub struct Opening {
    stream: TcpStream,
    at: SocketAddr,
    until: Instant,
    head: Vec<u8>,
    answer: Option<Answer>,
}

/// An answer that is being written.
#[derive(Debug)]
struct Answer {
    bytes: Vec<u8>,
    written: usize,
    /// Whether a WebSocket begins behind it.
    opens: bool,
}

/// How a connection goes on.
#[derive(Debug)]
pub enum Progress {
    /// It waits.
    Waits(Opening),
    /// It is closed.
    Ends,
    /// It is a WebSocket from now on. The bytes were read behind the head.
    Opens(TcpStream, Vec<u8>),
}

impl Opening {
    /// A connection that was accepted.
    ///
    /// # Errors
    /// It is closed already, or cannot be made non-blocking.
    pub fn new(stream: TcpStream) -> io::Result<Self> {
        stream.set_nonblocking(true)?;
        stream.set_nodelay(true)?;
        let at = stream.local_addr()?;
        let until = Instant::now() + PATIENCE;
        Ok(Self { stream, at, until, head: Vec::new(), answer: None })
    }

    /// Goes on as far as nothing has to be waited for.
    pub fn poll(mut self) -> Progress {
        if Instant::now() > self.until || !self.reads() {
            return Progress::Ends;
        }
        let Some(answer) = &mut self.answer else { return Progress::Waits(self) };
        while answer.written < answer.bytes.len() {
            match self.stream.write(&answer.bytes[answer.written..]) {
                Ok(0) => return Progress::Ends,
                Ok(count) => answer.written += count,
                Err(error) if is_late(&error) => return Progress::Waits(self),
                Err(_) => return Progress::Ends,
            }
            if answer.written < answer.bytes.len() {
                continue;
            }
            if answer.opens {
                return Progress::Opens(self.stream, self.head);
            }
            // A connection that is closed with bytes that nobody has read is reset, and the answer
            // may be lost: what comes is read until the other end closes.
            if self.stream.shutdown(Shutdown::Write).is_err() {
                return Progress::Ends;
            }
            self.until = Instant::now() + LINGER;
        }
        Progress::Waits(self)
    }

    /// Reads what has come; false if the connection has ended.
    fn reads(&mut self) -> bool {
        let mut bytes = [0; READ];
        for _ in 0..READS {
            if self.answer.as_ref().is_some_and(|answer| answer.opens) {
                return true;
            }
            match self.stream.read(&mut bytes) {
                Ok(0) => return false,
                Ok(_) if self.answer.is_some() => {}
                Ok(count) => {
                    self.head.extend_from_slice(&bytes[..count]);
                    self.answer = self.answered();
                }
                Err(error) => return is_late(&error),
            }
        }
        true
    }

    /// The answer to what has come, if it is whole.
    fn answered(&mut self) -> Option<Answer> {
        debug_assert!(self.head.len() < LONGEST_HEAD + READ);
        let (bytes, opens) = match judge(&self.head, self.at) {
            Asked::More => return None,
            Asked::Page => (answer("200 OK", "text/html", PAGE), false),
            Asked::Refused(status, why) => (answer(status, "text/plain", &(why + "\n")), false),
            Asked::Socket { key, head } => {
                self.head.drain(..head);
                (switch(&key), true)
            }
        };
        Some(Answer { bytes: bytes.into_bytes(), written: 0, opens })
    }
}

fn switch(key: &str) -> String {
    let accept = derive_accept_key(key.as_bytes());
    format!(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
         Sec-WebSocket-Accept: {accept}\r\n\r\n"
    )
}

/// An answer behind which the connection is closed. The page may load nothing from elsewhere, and
/// no other page may show it in a frame, where its buttons could be covered.
fn answer(status: &str, kind: &str, body: &str) -> String {
    let length = body.len();
    format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {length}\r\n\
         Connection: close\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n\
         Referrer-Policy: no-referrer\r\nContent-Security-Policy: default-src 'none'; \
         script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; connect-src 'self'; \
         base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n\r\n{body}"
    )
}

fn is_late(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

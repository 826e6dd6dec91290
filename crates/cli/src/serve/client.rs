//! One connection: what it is made of, what has come of it, and what waits for its reader.

use super::http::{Beginning, Judged};
use super::pty::Pty;
use super::web::{Said, Socket};
use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::TcpStream;

/// Bytes that are read of a connection by TCP at once.
const READ: usize = 4096;

/// The number of a connection.
pub type Id = u64;

/// What a connection is made of.
pub enum Stream {
    Terminal,
    Tcp(TcpStream, Beginning),
    Page(Box<Socket>),
}

/// A connection.
pub struct Client {
    pub id: Id,
    stream: Stream,
    pub out: VecDeque<u8>,
    pub is_gone: bool,
}

impl Client {
    pub const fn new(id: Id, stream: Stream) -> Self {
        Self { id, stream, out: VecDeque::new(), is_gone: false }
    }

    pub const fn is_terminal(&self) -> bool {
        matches!(self.stream, Stream::Terminal)
    }

    pub const fn is_tcp(&self) -> bool {
        matches!(self.stream, Stream::Tcp(..))
    }

    pub const fn is_page(&self) -> bool {
        matches!(self.stream, Stream::Page(_))
    }

    /// Whether it is a page that has the token.
    pub fn may(&self) -> bool {
        matches!(&self.stream, Stream::Page(socket) if socket.may())
    }

    /// Reads what has come by TCP; nothing if it is no such connection.
    pub fn read_stream(&mut self) -> Vec<u8> {
        let Stream::Tcp(stream, beginning) = &mut self.stream else { return Vec::new() };
        let mut bytes = [0; READ];
        if !self.is_gone {
            match stream.read(&mut bytes) {
                Ok(0) => self.is_gone = true,
                Ok(count) => match beginning.judge(&bytes[..count]) {
                    Judged::Http => self.is_gone = true,
                    Judged::Fine(bytes) => return bytes,
                },
                Err(error) if is_late(&error) => {}
                Err(_) => self.is_gone = true,
            }
        }
        Vec::new()
    }

    /// Reads what a page says; nothing if it is none.
    pub fn read_page(&mut self) -> Vec<Said> {
        let mut said = Vec::new();
        if let Stream::Page(socket) = &mut self.stream
            && !self.is_gone
        {
            self.is_gone = socket.read(&mut said).is_err();
        }
        said
    }

    /// Sends what waits, as far as there is room.
    ///
    /// # Errors
    /// The pseudo-terminal has failed.
    pub fn flush(&mut self, pty: &mut Pty) -> io::Result<()> {
        while !self.out.is_empty() {
            let (bytes, _) = self.out.as_slices();
            let written = match &mut self.stream {
                Stream::Terminal => Ok(pty.write(bytes)?),
                Stream::Tcp(stream, _) => stream.write(bytes),
                Stream::Page(socket) => socket.write(bytes),
            };
            match written {
                Ok(0) => break,
                Ok(count) => drop(self.out.drain(..count)),
                Err(error) => {
                    self.is_gone |= !is_late(&error);
                    break;
                }
            }
        }
        Ok(())
    }
}

fn is_late(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

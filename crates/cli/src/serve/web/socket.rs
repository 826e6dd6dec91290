//! A WebSocket of a page: who has the token, and what a page may say.

use super::TokenHash;
use super::words::{Word, refused};
use std::io::{self, ErrorKind};
use std::net::TcpStream;
use std::time::{Duration, Instant};
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Error, Message, WebSocket};

/// Longest message of a page, bytes.
const LONGEST: usize = 4096;
/// Most messages that are read in one look.
const MESSAGES: usize = 16;
/// Most bytes that the library keeps for a slow reader. What comes above waits outside.
const BUFFER: usize = 1 << 14;
/// A page that is open asks for the state several times in a second, and once in a minute if it
/// is in the background. One that says nothing for so long is closed.
const SILENCE: Duration = Duration::from_secs(150);
/// The first message of a page that has the token: this, and the token.
const TOKEN: &str = "token ";

/// What has come from a page.
#[derive(Debug)]
pub enum Said {
    /// A word.
    Word(Word),
    /// Bytes of the dialect.
    Bytes(Vec<u8>),
    /// Something that is answered by this line, and does nothing.
    Answered(String),
}

/// A WebSocket.
#[derive(Debug)]
pub struct Socket {
    socket: WebSocket<TcpStream>,
    token: TokenHash,
    /// Whether the page may do more than watch and stop.
    may: bool,
    /// Whether the first message has come.
    begun: bool,
    heard: Instant,
}

impl Socket {
    /// A WebSocket whose handshake is done. `read` came behind it.
    pub fn new(stream: TcpStream, read: Vec<u8>, token: TokenHash) -> Self {
        let config = WebSocketConfig::default()
            .read_buffer_size(LONGEST)
            .write_buffer_size(0)
            .max_write_buffer_size(BUFFER)
            .max_message_size(Some(LONGEST))
            .max_frame_size(Some(LONGEST));
        let socket = WebSocket::from_partially_read(stream, read, Role::Server, Some(config));
        Self { socket, token, may: false, begun: false, heard: Instant::now() }
    }

    /// Whether the page has the token.
    pub const fn may(&self) -> bool {
        self.may
    }

    /// What has come. `Err` if the connection has ended.
    pub fn read(&mut self, said: &mut Vec<Said>) -> Result<(), Closed> {
        for _ in 0..MESSAGES {
            let message = match self.socket.read() {
                Ok(message) => message,
                Err(error) if is_late(&error) => break,
                Err(_) => return Err(Closed),
            };
            self.heard = Instant::now();
            match message {
                Message::Text(text) => said.push(self.text(&text)),
                Message::Binary(bytes) => {
                    self.begun = true;
                    said.push(if self.may {
                        Said::Bytes(bytes.into())
                    } else {
                        Said::Answered(refused("lines", NEEDED))
                    });
                }
                Message::Close(_) => return Err(Closed),
                // The library answers pings.
                Message::Ping(_) | Message::Pong(_) | Message::Frame(_) => {}
            }
        }
        if self.heard.elapsed() > SILENCE { Err(Closed) } else { Ok(()) }
    }

    fn text(&mut self, text: &str) -> Said {
        let first = !std::mem::replace(&mut self.begun, true);
        if let Some(token) = text.strip_prefix(TOKEN) {
            self.may = first && TokenHash::of(token) == self.token;
            return Said::Answered(if self.may {
                "web may\n".to_owned()
            } else {
                refused("token", "it is not that of this run, or not the first message")
            });
        }
        match Word::of(text) {
            Some(word) if word.is_free() || self.may => Said::Word(word),
            Some(_) => Said::Answered(refused(text, NEEDED)),
            None => Said::Answered(refused(text, "unknown")),
        }
    }

    /// Sends bytes. Returns how many were taken: all, or none if the reader is slow.
    ///
    /// # Errors
    /// The connection has ended.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let ended = |_: &Error| io::Error::from(ErrorKind::BrokenPipe);
        match self.socket.flush() {
            Ok(()) => {}
            Err(error) if is_late(&error) => return Ok(0),
            Err(error) => return Err(ended(&error)),
        }
        let count = bytes.len().min(BUFFER / 2);
        match self.socket.send(Message::Binary(bytes[..count].to_vec().into())) {
            Ok(()) => Ok(count),
            // It is kept, and sent by the next flush.
            Err(error) if is_late(&error) => Ok(count),
            Err(error) => Err(ended(&error)),
        }
    }
}

/// Why a page without the token is refused.
const NEEDED: &str = "only a page with the token may";

/// The connection has ended.
#[derive(Debug)]
pub struct Closed;

fn is_late(error: &Error) -> bool {
    matches!(error, Error::Io(error)
        if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted))
}

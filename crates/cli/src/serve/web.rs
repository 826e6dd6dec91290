//! The web page of `serve --web`, and the WebSockets of the pages that are open.
//!
//! ```text
//! request  the head of an HTTP request: what it asks for, or why it is refused
//! opening  a connection until it is answered: it reads one head, and writes one answer
//! socket   a WebSocket: who has the token, what a page may say
//! words    what a page can say
//! page     the page itself, with its style and its script
//! ```
//!
//! Any web page can make a browser connect to a port of this computer. So each request is refused
//! whose Host is not the address of the connection, or whose Origin is not this page. Nothing
//! blocks; the number of connections, their requests and messages are bounded.

mod opening;
mod request;
mod socket;
mod words;

use opening::{Opening, Progress};
use sha2::{Digest as _, Sha256};
pub use socket::{Said, Socket};
use std::io;
use std::net::TcpListener;
pub use words::Word;

/// Most connections that are not answered yet. A further one takes the place of the oldest, so
/// that silent ones keep nobody out.
const MOST_OPENING: usize = 16;
/// Bytes of the token's randomness.
const TOKEN: usize = 16;

/// The hash of a token. Hashes are compared, and not tokens, so that the time of a comparison tells
/// nothing of the token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TokenHash([u8; 32]);

impl TokenHash {
    /// The hash of this text.
    fn of(text: &str) -> Self {
        Self(Sha256::digest(text.as_bytes()).into())
    }
}

/// The listener for pages.
#[derive(Debug)]
pub struct Web {
    listener: TcpListener,
    token: TokenHash,
    opening: Vec<Opening>,
}

impl Web {
    /// Pages at this listener. Returns the token, too, which is for whoever may do all.
    ///
    /// # Errors
    /// The listener cannot be made non-blocking, or the system has no random numbers.
    pub fn new(listener: TcpListener) -> io::Result<(Self, String)> {
        listener.set_nonblocking(true)?;
        let mut bytes = [0; TOKEN];
        getrandom::fill(&mut bytes).map_err(io::Error::other)?;
        let token: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok((Self { listener, token: TokenHash::of(&token), opening: Vec::new() }, token))
    }

    /// Goes on with the connections, and returns the WebSockets that are open now.
    pub fn poll(&mut self) -> Vec<Socket> {
        while let Ok((stream, _)) = self.listener.accept() {
            if self.opening.len() == MOST_OPENING {
                self.opening.remove(0);
            }
            self.opening.extend(Opening::new(stream).ok());
        }
        let mut sockets = Vec::new();
        for opening in std::mem::take(&mut self.opening) {
            match opening.poll() {
                Progress::Waits(opening) => self.opening.push(opening),
                Progress::Ends => {}
                Progress::Opens(stream, read) => {
                    sockets.push(Socket::new(stream, read, self.token));
                }
            }
        }
        sockets
    }
}

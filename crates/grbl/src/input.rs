//! The stream of a sender: real-time characters at once, and lines in their order.
//!
//! A line is kept as Grbl keeps it: without blanks, comments and `/`, in capitals. What waits is
//! counted in the bytes that the sender has sent, comments and ends of lines included, because a
//! sender that counts characters counts these.

use crate::realtime::{Realtime, Received};
use std::collections::VecDeque;

/// Size of the receive buffer that reports name, bytes. A sender that counts characters has at most
/// so many of them unanswered.
pub const RECEIVE_BUFFER: usize = 1024;

/// Most bytes that wait in lines. A sender that counts nothing is to be read no further then
/// ([`Input::is_full`]).
pub const INPUT_BOUND: usize = 1 << 20;

/// Longest line in characters, without blanks and comments.
pub const LONGEST_LINE: usize = 256;

/// A line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Line {
    /// Its text, in ASCII.
    Text(String),
    /// It was longer than [`LONGEST_LINE`].
    TooLong,
}

/// In which comment the stream is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Comment {
    #[default]
    None,
    /// `(`, up to `)`.
    Parenthesis,
    /// `;`, up to the end of the line.
    Rest,
}

/// A line that waits: the bytes that were sent for it, and those of its text in [`Input::text`]. It
/// has 8 bytes, because [`INPUT_BOUND`] of them may wait, all empty.
#[derive(Debug, Clone, Copy)]
struct Waiting {
    sent: u32,
    kept: u16,
    too_long: bool,
}

/// The stream of a sender.
#[derive(Debug, Default)]
pub struct Input {
    lines: VecDeque<Waiting>,
    /// The text of all lines that wait, and then that of the line that is not whole.
    text: VecDeque<u8>,
    /// The line that is not whole.
    kept: usize,
    sent: u32,
    too_long: bool,
    comment: Comment,
    /// Bytes of the lines that wait.
    waiting: usize,
}

impl Input {
    /// Takes a byte. Returns a real-time character, which is to act now.
    pub fn take(&mut self, byte: u8) -> Option<Realtime> {
        match Received::of(byte) {
            Received::Realtime(realtime) => return Some(realtime),
            Received::Unknown => return None,
            Received::Text(b'\n' | b'\r') => self.end_line(),
            Received::Text(byte) => self.text(byte),
        }
        None
    }

    fn text(&mut self, byte: u8) {
        self.sent = self.sent.saturating_add(1);
        match (self.comment, byte) {
            (Comment::None, b'(') => self.comment = Comment::Parenthesis,
            (Comment::None, b';') => self.comment = Comment::Rest,
            (Comment::Parenthesis, b')') => self.comment = Comment::None,
            // Grbl ignores `/`: it executes the line.
            (Comment::Parenthesis | Comment::Rest, _) | (Comment::None, ..=b' ' | b'/') => {}
            (Comment::None, _) if self.kept >= LONGEST_LINE => self.too_long = true,
            (Comment::None, byte) => {
                self.text.push_back(byte.to_ascii_uppercase());
                self.kept += 1;
            }
        }
    }

    fn end_line(&mut self) {
        let sent = std::mem::take(&mut self.sent).saturating_add(1);
        let (kept, too_long) = (std::mem::take(&mut self.kept) as u16, self.too_long);
        self.waiting = self.waiting.saturating_add(sent as usize);
        self.lines.push_back(Waiting { sent, kept, too_long });
        (self.too_long, self.comment) = (false, Comment::None);
    }

    /// The next whole line, which then waits no longer.
    pub fn next_line(&mut self) -> Option<Line> {
        let Waiting { sent, kept, too_long } = self.lines.pop_front()?;
        self.waiting = self.waiting.saturating_sub(sent as usize);
        let text: Vec<u8> = self.text.drain(..usize::from(kept).min(self.text.len())).collect();
        if too_long {
            return Some(Line::TooLong);
        }
        // The stream keeps only bytes below 0x80.
        Some(Line::Text(text.into_iter().map(char::from).collect()))
    }

    /// Whether a whole line waits.
    pub fn has_line(&self) -> bool {
        !self.lines.is_empty()
    }

    /// Free bytes of the receive buffer, as reports name them. A sender that counts nothing may
    /// have sent more: then it is 0, and nothing is lost.
    pub fn free(&self) -> usize {
        RECEIVE_BUFFER.saturating_sub(self.waiting.saturating_add(self.sent as usize))
    }

    /// Whether nothing should be read any more until a line is taken. Real-time characters behind
    /// these bytes act later.
    pub fn is_full(&self) -> bool {
        self.waiting >= INPUT_BOUND
    }

    /// Forgets all that waits: a soft reset, or the end of a connection.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

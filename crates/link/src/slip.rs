//! Frames on the line, as in RFC 1055: END around them, END and ESC inside them as two bytes.

use crate::registers::{END, ESC, ESC_END, ESC_ESC};
use core::iter::once;

/// Most bytes that a frame of so many can take on the line.
pub const fn line_bytes(frame: usize) -> usize {
    2 * frame + 2
}

/// The bytes of a frame on the line.
pub fn encode(frame: &[u8]) -> impl Iterator<Item = u8> + '_ {
    let escaped = frame.iter().flat_map(|&byte| {
        let (first, second) = match byte {
            END => (ESC, Some(ESC_END)),
            ESC => (ESC, Some(ESC_ESC)),
            _ => (byte, None),
        };
        once(first).chain(second)
    });
    once(END).chain(escaped).chain(once(END))
}

/// What a byte from the line has ended.
#[derive(Debug, PartialEq, Eq)]
pub enum Received<'a> {
    /// Nothing yet.
    Nothing,
    /// A frame; its CRC is not looked at yet.
    Frame(&'a [u8]),
    /// Something that is no frame: too long, or an ESC before the wrong byte.
    Broken,
}

/// Takes frames of at most `N` bytes from a line, byte by byte.
#[derive(Debug, Clone)]
pub struct Decoder<const N: usize> {
    bytes: [u8; N],
    length: usize,
    escaped: bool,
    broken: bool,
}

impl<const N: usize> Default for Decoder<N> {
    fn default() -> Self {
        Self { bytes: [0; N], length: 0, escaped: false, broken: false }
    }
}

impl<const N: usize> Decoder<N> {
    /// The next byte of the line. Empty frames are nothing.
    pub fn push(&mut self, byte: u8) -> Received<'_> {
        if byte == END {
            let (length, broken) = (self.length, self.broken || self.escaped);
            (self.length, self.escaped, self.broken) = (0, false, false);
            return match self.bytes.get(..length) {
                _ if broken => Received::Broken,
                Some(frame) if length > 0 => Received::Frame(frame),
                _ => Received::Nothing,
            };
        }
        let meant = match (self.escaped, byte) {
            (false, ESC) => {
                self.escaped = true;
                return Received::Nothing;
            }
            (true, ESC_END) => END,
            (true, ESC_ESC) => ESC,
            (true, _) => {
                self.broken = true;
                byte
            }
            (false, _) => byte,
        };
        self.escaped = false;
        match self.bytes.get_mut(self.length) {
            Some(place) => {
                *place = meant;
                self.length += 1;
            }
            None => self.broken = true,
        }
        Received::Nothing
    }
}

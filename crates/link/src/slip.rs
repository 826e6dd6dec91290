//! Framing as in RFC 1055: END before and behind a frame; END and ESC within it are escaped to two
//! bytes. By hand, because it is short, needs no `std`, says which frames are broken, and decodes
//! byte by byte as the gateware and the C library do.

use crate::registers::{END, ESC, ESC_END, ESC_ESC};
use core::iter::once;

/// Greatest number of bytes on the line for a frame of this length.
pub const fn line_bytes(frame: usize) -> usize {
    2 * frame + 2
}

/// The bytes of a frame as they are sent on the line.
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

/// Result of a received byte.
#[derive(Debug, PartialEq, Eq)]
pub enum Received<'a> {
    /// No frame has ended.
    Nothing,
    /// A frame has ended. Its CRC has not been checked.
    Frame(&'a [u8]),
    /// An invalid frame has ended: it was too long, or had a wrong byte after an ESC.
    Broken,
}

/// Decodes frames of at most `N` bytes, byte by byte.
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
    /// Processes the next byte of the line. Empty frames are ignored.
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

//! Requests and answers, written from docs/protocol.md and independent of the clients.

use carrystep_core::engine::{CAUSES, Cause};
use carrystep_core::link::{END, ESC, ESC_END, ESC_ESC};

/// A complete request with its CRC.
pub fn frame(sequence: u8, address: u8, words: &[u32]) -> Vec<u8> {
    let head = [sequence, address];
    let words = words.iter().flat_map(|word| word.to_le_bytes());
    let frame: Vec<u8> = head.into_iter().chain(words).collect();
    let sum = crc(&frame).to_le_bytes();
    [frame, sum.to_vec()].concat()
}

/// A frame between ENDs, escaped.
pub fn on_the_line(frame: &[u8]) -> Vec<u8> {
    let escaped = frame.iter().flat_map(|&byte| match byte {
        END => vec![ESC, ESC_END],
        ESC => vec![ESC, ESC_ESC],
        _ => vec![byte],
    });
    std::iter::once(END).chain(escaped).chain([END]).collect()
}

/// A frame without its escapes and its CRC; `None` if the CRC or an escape is wrong.
pub fn unframe(line: &[u8]) -> Option<Vec<u8>> {
    let mut frame = Vec::new();
    let mut bytes = line.iter();
    while let Some(&byte) = bytes.next() {
        frame.push(match byte {
            ESC => match *bytes.next()? {
                ESC_END => END,
                ESC_ESC => ESC,
                _ => return None,
            },
            END => return None,
            byte => byte,
        });
    }
    let sum = frame.split_off(frame.len().checked_sub(4)?);
    (crc(&frame).to_le_bytes()[..] == sum).then_some(frame)
}

/// The CRC-32, computed bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    let shift = |sum: u32| sum >> 1 ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 };
    !bytes
        .iter()
        .fold(u32::MAX, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), |sum, _| shift(sum)))
}

/// An answer, divided into its fields according to the page and independent of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "docs/protocol.md, \"The answer\"")]
pub struct Said {
    pub sequence: u8,
    pub address: u8,
    pub next: u8,
    pub fault: Option<Cause>,
    pub halted: bool,
    pub idle: bool,
    pub ready: bool,
    pub armed: bool,
    pub free: u8,
    pub refused: bool,
    pub written: bool,
    pub culprits: u8,
    pub homing: u8,
    pub data: u32,
}

impl Said {
    /// Decodes a frame without its CRC.
    pub fn of(frame: &[u8]) -> Self {
        let &[sequence, address, next, state, room, culprits, homing, a, b, c, d] = frame else {
            panic!("{frame:02x?} is not as long as an answer")
        };
        let bit = |bit: u8| state >> bit & 1 == 1;
        let number = state >> 5 | (room & 0x10) >> 1;
        let cause = CAUSES[usize::from(number)];
        assert!(bit(0) || number == 0, "a cause without a fault");
        Self {
            sequence,
            address,
            next,
            fault: bit(0).then_some(cause),
            halted: bit(1),
            idle: bit(2),
            ready: bit(3),
            armed: bit(4),
            free: room & 7,
            refused: room & 8 != 0,
            written: room & 0x80 != 0,
            culprits,
            homing,
            data: u32::from_le_bytes([a, b, c, d]),
        }
    }
}

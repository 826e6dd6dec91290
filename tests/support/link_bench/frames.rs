//! Requests and answers, written from docs/protocol.md and independent of the clients.

use carrystep_core::engine::{CAUSES, Cause};
use carrystep_core::link::{END, ESC, ESC_END, ESC_ESC};

/// A read of anyone, with its CRC.
pub fn read(sequence: u8, address: u8) -> Vec<u8> {
    summed(vec![sequence, address])
}

/// A read of the owner of this session.
pub fn owners_read(sequence: u8, address: u8, session: u16) -> Vec<u8> {
    request(sequence, address, session, &[])
}

/// A write of words to a register.
pub fn write(sequence: u8, register: u8, session: u16, words: &[u32]) -> Vec<u8> {
    request(sequence, 0x80 | register, session, words)
}

/// The words of a SEGMENTS frame: the same ticks for all axes, and V, A, J of each axis of the
/// mask, in ascending order.
pub fn wide(mask: u8, ticks: u32, axes: &[[i64; 3]], last: bool) -> Vec<u32> {
    let halves = |number: &i64| [*number as u32, (*number >> 32) as u32];
    let numbers = axes.iter().flatten().flat_map(halves);
    [mask.into(), ticks.wrapping_sub(1)].into_iter().chain(numbers).chain([last.into()]).collect()
}

fn request(sequence: u8, address: u8, session: u16, words: &[u32]) -> Vec<u8> {
    let head = [sequence, address].into_iter().chain(session.to_le_bytes());
    let words = words.iter().flat_map(|word| word.to_le_bytes());
    summed(head.chain(words).collect())
}

/// A frame with its CRC.
pub fn summed(frame: Vec<u8>) -> Vec<u8> {
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
    pub cut_refused: bool,
    pub free: u8,
    /// The reason of a refusal; 0 if the request was not refused.
    pub reason: u8,
    pub written: bool,
    pub culprits: u8,
    pub seeking: u8,
    pub data: u32,
}

impl Said {
    /// Decodes a frame without its CRC.
    pub fn of(frame: &[u8]) -> Self {
        let &[sequence, address, next, flags, free, culprits, seeking, why, a, b, c, d] = frame
        else {
            panic!("{frame:02x?} is not as long as an answer")
        };
        let bit = |bit: u8| flags >> bit & 1 == 1;
        let number = why & 15;
        let cause = CAUSES[usize::from(number)];
        assert!(bit(0) || (number, culprits) == (0, 0), "a cause without a fault");
        assert_eq!(flags & 0x20, 0, "a bit without a meaning");
        Self {
            sequence,
            address,
            next,
            fault: bit(0).then_some(cause),
            ready: bit(1),
            armed: bit(2),
            cut_refused: bit(4),
            written: bit(3),
            idle: bit(6),
            halted: bit(7),
            free,
            reason: why >> 4,
            culprits,
            seeking,
            data: u32::from_le_bytes([a, b, c, d]),
        }
    }
}

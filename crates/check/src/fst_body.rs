//! The value changes of an FST file, in blocks.
//!
//! ```text
//! block:  8, length, first and last time, memory that a reader needs
//!         frame      the values of all signals before the block
//!         changes    of each signal that has any, compressed with LZ4
//!         places     where the changes of each signal begin, relative to those before
//!         times      of all changes, each relative to the one before, compressed with zlib
//! ```
//!
//! A *varint* is a number in LEB128; other numbers are big-endian, and floats little-endian. The
//! format is that of GTKWave's `fstapi` (T. Bybell, 2009). The tests compare the blocks with those of
//! the library `fst-writer`, byte for byte. The library itself is not used for them, because it takes
//! each value as text, a character for each bit, which takes three times as long (decision 116).

use std::io::{self, Write};

/// The kind of a block of value changes (`FST_BL_VCDATA_DYN_ALIAS2`).
pub(crate) const CHANGES: u8 = 8;
/// The changes are compressed with LZ4.
const LZ4: u8 = b'4';
/// Shorter changes of a signal in a block are not compressed.
const SHORT: usize = 32;
/// The level of zlib: 3 of 10.
const ZLIB_LEVEL: u8 = 3;
/// A block is written when its changes and times have more than so many bytes, before compression.
const BLOCK: usize = 1 << 19;

/// The values that a signal can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A number of so many bits, 1 to 64.
    Bits(u32),
    /// A float.
    Real,
}

/// A signal in the block that is being put together.
struct Signal {
    kind: Kind,
    /// The last value, a float by its bits; `None` if it is unknown.
    value: Option<u64>,
    /// The number of the time of its last change in the block.
    time: u64,
    /// Its changes in the block.
    changes: Vec<u8>,
}

/// The changes of all signals.
pub(crate) struct Body {
    signals: Vec<Signal>,
    /// The values before the first time of the block.
    frame: Vec<u8>,
    /// The times of the block, as varints.
    times: Vec<u8>,
    /// The number of times in the block.
    count: u64,
    /// The time at which the block begins, ps.
    begin: u64,
    /// The last time, ps.
    now: u64,
    /// Bytes of changes in the block.
    size: usize,
    /// Number of blocks that are complete.
    blocks: u64,
}

impl Body {
    /// No changes of signals of these kinds.
    pub fn new(kinds: impl IntoIterator<Item = Kind>) -> Self {
        let signal = |kind| Signal { kind, value: None, time: 0, changes: Vec::new() };
        Self {
            signals: kinds.into_iter().map(signal).collect(),
            frame: Vec::new(),
            times: Vec::new(),
            count: 0,
            begin: 0,
            now: 0,
            size: 0,
            blocks: 0,
        }
    }

    /// The last time, ps, and the number of blocks that are complete: what the header says of them.
    pub const fn end(&self) -> (u64, u64) {
        (self.now, self.blocks)
    }

    /// Whether the block should be completed before the next time.
    pub fn is_full(&self) -> bool {
        self.size + self.times.len() > BLOCK
    }

    /// Sets the time of the changes that follow, ps. Changes before the first time over 0 are the
    /// values with which the file begins.
    ///
    /// # Errors
    /// The time is before the last one.
    pub fn time(&mut self, ps: u64) -> io::Result<()> {
        if ps < self.now {
            let message = format!("{ps} ps after {} ps", self.now);
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        if ps == self.now {
            return Ok(());
        }
        if self.count == 0 {
            self.frame = self.values();
        }
        let since = if self.count == 0 { 0 } else { self.now };
        varint(&mut self.times, ps - since);
        self.count += 1;
        self.now = ps;
        Ok(())
    }

    /// Adds a change of a signal; a float is given by its bits.
    ///
    /// # Errors
    /// There is no signal of this number.
    pub fn change(&mut self, signal: usize, value: u64) -> io::Result<()> {
        let signal = self.signals.get_mut(signal).ok_or(io::ErrorKind::InvalidInput)?;
        signal.value = Some(value);
        let Some(time) = self.count.checked_sub(1) else { return Ok(()) };
        let before = signal.changes.len();
        let later = time - signal.time;
        signal.time = time;
        match signal.kind {
            Kind::Bits(1) => varint(&mut signal.changes, later << 2 | (value & 1) << 1),
            Kind::Bits(bits) => {
                varint(&mut signal.changes, later << 1);
                let bytes = (value << (u64::BITS - bits)).to_be_bytes();
                signal.changes.extend_from_slice(&bytes[..bits.div_ceil(8) as usize]);
            }
            Kind::Real => {
                varint(&mut signal.changes, later << 1 | 1);
                signal.changes.extend_from_slice(&value.to_le_bytes());
            }
        }
        self.size += signal.changes.len() - before;
        Ok(())
    }

    /// The values of all signals as the frame has them: a character for each bit, the bytes of a
    /// float.
    fn values(&self) -> Vec<u8> {
        let mut frame = Vec::new();
        for &Signal { kind, value, .. } in &self.signals {
            match (kind, value) {
                (Kind::Real, value) => {
                    let bits = value.unwrap_or_else(|| f64::NAN.to_bits());
                    frame.extend_from_slice(&bits.to_le_bytes());
                }
                (Kind::Bits(bits), None) => frame.extend((0..bits).map(|_| b'x')),
                (Kind::Bits(bits), Some(value)) => {
                    frame.extend((0..bits).rev().map(|bit| b'0' + (value >> bit & 1) as u8));
                }
            }
        }
        frame
    }

    /// Completes the block and writes it. The next one begins with the next time.
    ///
    /// # Errors
    /// The error of the system if the file cannot be written.
    pub fn write_block(&mut self, out: &mut impl Write) -> io::Result<()> {
        if self.count == 0 {
            self.frame = self.values();
        }
        let signals = self.signals.len() as u64;
        let memory: usize = self.signals.iter().map(|signal| signal.changes.len()).sum();
        let mut block = Vec::new();
        for number in [self.begin, self.now, memory as u64] {
            block.extend_from_slice(&number.to_be_bytes());
        }
        // Twice the same length: the frame is not compressed.
        for number in [self.frame.len() as u64, self.frame.len() as u64, signals] {
            varint(&mut block, number);
        }
        block.extend_from_slice(&self.frame);
        varint(&mut block, signals);
        let mut before = block.len();
        block.push(LZ4);
        let (mut places, mut without) = (Vec::new(), 0);
        for signal in &mut self.signals {
            if signal.changes.is_empty() {
                without += 1;
                continue;
            }
            skip(&mut places, &mut without);
            let place = block.len();
            signed_varint(&mut places, ((place - before) as u64) << 1 | 1);
            before = place;
            pack(&mut block, &signal.changes);
            signal.changes.clear();
            signal.time = 0;
        }
        skip(&mut places, &mut without);
        block.extend_from_slice(&places);
        block.extend_from_slice(&(places.len() as u64).to_be_bytes());
        let packed = miniz_oxide::deflate::compress_to_vec_zlib(&self.times, ZLIB_LEVEL);
        let times = if packed.len() < self.times.len() { &packed } else { &self.times };
        block.extend_from_slice(times);
        for number in [self.times.len() as u64, times.len() as u64, self.count] {
            block.extend_from_slice(&number.to_be_bytes());
        }
        out.write_all(&[CHANGES])?;
        // The length counts its own eight bytes.
        out.write_all(&(block.len() as u64 + 8).to_be_bytes())?;
        out.write_all(&block)?;
        self.times.clear();
        (self.count, self.size, self.begin) = (0, 0, self.now);
        self.blocks += 1;
        Ok(())
    }
}

/// Adds the changes of a signal to the block. They are compressed if that makes them shorter. In
/// front of them stands a varint: their number of bytes before compression, or 0 if they are not
/// compressed.
fn pack(block: &mut Vec<u8>, changes: &[u8]) {
    if changes.len() >= SHORT {
        let packed = lz4_flex::compress(changes);
        if packed.len() < changes.len() {
            varint(block, changes.len() as u64);
            block.extend_from_slice(&packed);
            return;
        }
    }
    varint(block, 0);
    block.extend_from_slice(changes);
}

/// Notes in the places that so many signals, one after the other, have no changes, and sets the
/// number back to 0.
fn skip(places: &mut Vec<u8>, without: &mut u64) {
    let count = std::mem::take(without);
    if count > 0 {
        varint(places, count << 1);
    }
}

/// Adds a number in groups of seven bits, the lowest first; all but the last have bit 7 set.
fn varint(bytes: &mut Vec<u8>, mut number: u64) {
    while number > 0x7f {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

/// The same for the places, which a reader takes as signed numbers: it reads bit 6 of the last group
/// as the sign, so that bit must be 0.
fn signed_varint(bytes: &mut Vec<u8>, mut number: u64) {
    while number > 0x3f {
        bytes.push(number as u8 & 0x7f | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

#[cfg(test)]
mod tests;

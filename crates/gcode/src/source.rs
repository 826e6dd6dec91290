//! Reads a program line by line, and jumps to lines whose place in the file is known.
//!
//! Only one line and one buffer are in memory, whatever the length of the file.

use crate::error::ErrorKind;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};

/// Greatest length of a line in bytes. No program needs so much; it bounds the memory for a file
/// that has no lines.
pub(crate) const LONGEST_LINE: usize = 1 << 16;

/// Bytes that are read from the file at once. A jump within them reads nothing anew.
const BUFFER: usize = 1 << 16;

/// A place in the file at the beginning of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Place {
    /// Bytes before it.
    pub(crate) offset: u64,
    /// Lines before it.
    pub(crate) lines: u64,
}

/// The lines of a file.
#[derive(Debug)]
pub(crate) struct Source<R> {
    reader: BufReader<R>,
    /// The beginning of the next line.
    next: Place,
    line: Vec<u8>,
}

impl<R: Read + Seek> Source<R> {
    /// Begins at the beginning of the file.
    pub(crate) fn new(file: R) -> Result<Self, ErrorKind> {
        let mut reader = BufReader::with_capacity(BUFFER, file);
        reader.seek(SeekFrom::Start(0)).map_err(|error| unreadable(&error))?;
        Ok(Self { reader, next: Place::default(), line: Vec::new() })
    }

    /// Reads the next line; false at the end of the file.
    pub(crate) fn advance(&mut self) -> Result<bool, ErrorKind> {
        self.line.clear();
        let most = LONGEST_LINE as u64 + 1;
        let read = (&mut self.reader).take(most).read_until(b'\n', &mut self.line);
        let read = read.map_err(|error| unreadable(&error))? as u64;
        self.next = Place { offset: self.next.offset + read, lines: self.next.lines + 1 };
        if self.line.len() > LONGEST_LINE {
            return Err(ErrorKind::LineTooLong(LONGEST_LINE));
        }
        if self.next.offset == read && self.line.starts_with("\u{feff}".as_bytes()) {
            self.line.drain(..'\u{feff}'.len_utf8());
        }
        Ok(read > 0)
    }

    /// The line that was read.
    pub(crate) fn line(&self) -> &[u8] {
        &self.line
    }

    /// The beginning of the next line.
    pub(crate) fn next_place(&self) -> Place {
        self.next
    }

    /// Continues with the line that begins at this place.
    pub(crate) fn jump(&mut self, to: Place) -> Result<(), ErrorKind> {
        let (from, until) = (i128::from(self.next.offset), i128::from(to.offset));
        let distance = i64::try_from(until - from)
            .map_err(|_| ErrorKind::Unreadable("it is too long".to_owned()))?;
        self.reader.seek_relative(distance).map_err(|error| unreadable(&error))?;
        self.next = to;
        Ok(())
    }
}

/// The error for a file that the operating system does not let be read.
pub(crate) fn unreadable(error: &io::Error) -> ErrorKind {
    ErrorKind::Unreadable(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn a_jump_repeats_the_same_lines() {
        let text = "\u{feff}one\ntwo\r\nthree";
        let mut source = Source::new(Cursor::new(text)).unwrap();
        let mut places = Vec::new();
        let mut lines = Vec::new();
        loop {
            places.push(source.next_place());
            if !source.advance().unwrap() {
                break;
            }
            lines.push(source.line().to_vec());
        }
        assert_eq!(lines, [&b"one\n"[..], b"two\r\n", b"three"]);
        for (line, place) in lines.iter().zip(places).rev() {
            source.jump(place).unwrap();
            assert!(source.advance().unwrap());
            assert_eq!(source.line(), line);
        }
    }

    #[test]
    fn a_line_without_end_is_refused_before_it_fills_the_memory() {
        let mut source = Source::new(Cursor::new(vec![b'x'; 3 * LONGEST_LINE])).unwrap();
        assert_eq!(source.advance(), Err(ErrorKind::LineTooLong(LONGEST_LINE)));
        assert!(source.line.capacity() < 3 * LONGEST_LINE);
    }
}

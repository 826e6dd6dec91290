//! Finds the places where a VCD can be cut: lines that give a time.

use crate::vcd_header::Unit;
use serde::{Deserialize, Serialize};
use std::io::{self, BufRead, BufReader, Read};

/// A place in a capture that begins with a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Cut {
    /// The place, bytes from the start of the file.
    pub(crate) byte: u64,
    /// The time, ps.
    pub(crate) ps: u64,
}

/// So many bytes are searched for a time at which no pulse is due.
const SEARCHED: u64 = 1 << 20;

/// The longest line that is looked at, bytes. Lines of times are much shorter.
const LONGEST: u64 = 1 << 12;

/// Finds the first cut at `from` or after it that is not near a crossing; the first one if all are
/// near, and `None` if there is no line with a time. `bytes` begin one byte before `from`.
pub(crate) fn find(
    bytes: impl Read,
    from: u64,
    unit: Unit,
    mut is_near: impl FnMut(u64) -> bool,
) -> io::Result<Option<Cut>> {
    let mut bytes = BufReader::new(bytes);
    let (mut place, mut first, mut line) = (from - 1, None, Vec::new());
    // The line that has begun before.
    let mut is_whole = false;
    loop {
        line.clear();
        let length = bytes.by_ref().take(LONGEST).read_until(b'\n', &mut line)? as u64;
        let begun = place;
        place += length;
        if length == 0 || (first.is_some() && place > from + SEARCHED) {
            return Ok(first);
        }
        if is_whole && let Some(cut) = time(&line, unit).map(|ps| Cut { byte: begun, ps }) {
            if !is_near(cut.ps) {
                return Ok(Some(cut));
            }
            first = first.or(Some(cut));
        }
        is_whole = line.ends_with(b"\n");
    }
}

/// The time that a line begins with, ps.
fn time(line: &[u8], unit: Unit) -> Option<u64> {
    let text = std::str::from_utf8(line.strip_prefix(b"#")?).ok()?;
    unit.ps(text.split_ascii_whitespace().next()?.parse().ok()?)
}

/// The first place after so many line ends, bytes from the start.
pub(crate) fn place_of_line(bytes: impl Read, lines: u64) -> io::Result<u64> {
    let (mut bytes, mut place) = (BufReader::new(bytes), 0);
    for _ in 0..lines {
        place += bytes.skip_until(b'\n')? as u64;
    }
    Ok(place)
}

/// The number of line ends in these bytes.
pub(crate) fn line_ends(bytes: impl Read) -> io::Result<u64> {
    let (mut bytes, mut lines) = (BufReader::new(bytes), 0);
    loop {
        let buffer = bytes.fill_buf()?;
        if buffer.is_empty() {
            return Ok(lines);
        }
        lines += buffer.iter().filter(|&&byte| byte == b'\n').count() as u64;
        let length = buffer.len();
        bytes.consume(length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vcd::TimescaleUnit;

    const TEXT: &str = "#0\n0!\n#10\n1!\n\n#20 0!\nr#25\n#3x\n#40\n0!";

    fn found(from: u64, is_near: impl FnMut(u64) -> bool) -> Option<(u64, u64)> {
        let unit = Unit::new(1, TimescaleUnit::NS);
        let bytes = &TEXT.as_bytes()[from as usize - 1..];
        find(bytes, from, unit, is_near).unwrap().map(|cut| (cut.byte, cut.ps))
    }

    #[test]
    fn the_next_line_with_a_time_is_found() {
        let all: Vec<_> = (1..TEXT.len() as u64).map(|from| found(from, |_| false)).collect();
        for (index, cut) in all.iter().enumerate() {
            let from = index + 1;
            let next = [(6, 10_000), (14, 20_000), (30, 40_000)].into_iter();
            let wanted = next.into_iter().find(|(byte, _)| *byte >= from as u64);
            assert_eq!(*cut, wanted, "from {from}");
            let byte = cut.map_or(TEXT.len(), |(byte, _)| byte as usize);
            assert!(byte == TEXT.len() || TEXT[byte..].starts_with('#'));
        }
    }

    #[test]
    fn times_near_a_crossing_are_passed_over() {
        assert_eq!(found(1, |ps| ps < 40_000), Some((30, 40_000)));
        assert_eq!(found(1, |_| true), Some((6, 10_000)), "all are near");
        assert_eq!(place_of_line(TEXT.as_bytes(), 2).unwrap(), 6);
        assert_eq!(line_ends(TEXT.as_bytes()).unwrap(), 9);
    }
}

//! The lines of a TOML text, each with what it begins.

use crate::input::MAX_TEXT_BYTES;
use std::io::{self, BufRead, Read as _};

/// A line of the text.
#[derive(Debug)]
pub(crate) struct Line {
    /// The line with its end.
    pub text: String,
    /// The table that it begins, if it begins one.
    pub head: Option<TableHead>,
}

/// The table that a line begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TableHead {
    /// `[[move]]`
    Move,
    /// A table of the last move, as in `[move.to]`.
    WithinMove,
    /// Any other table.
    Other,
}

/// Why a line cannot be read.
#[derive(Debug)]
pub(crate) enum LineFault {
    Io(io::Error),
    /// The character in this column, from 1, is not UTF-8.
    NotUtf8 {
        column: usize,
    },
    /// The line is longer than any text may be.
    Long,
}

/// Reads lines, and follows where texts and lists over several lines begin and end.
#[derive(Debug)]
pub(crate) struct TomlLines<R> {
    text: R,
    /// The three quotation marks that end the text which the last line has begun.
    within: Option<&'static [u8]>,
    /// Number of brackets and braces that are open.
    open: u32,
}

impl<R: BufRead> TomlLines<R> {
    pub(crate) fn new(text: R) -> Self {
        Self { text, within: None, open: 0 }
    }

    /// The next line; `None` at the end.
    pub(crate) fn next_line(&mut self) -> Result<Option<Line>, LineFault> {
        let mut bytes = Vec::new();
        self.text
            .by_ref()
            .take(MAX_TEXT_BYTES + 1)
            .read_until(b'\n', &mut bytes)
            .map_err(LineFault::Io)?;
        if bytes.is_empty() {
            return Ok(None);
        }
        if bytes.len() as u64 > MAX_TEXT_BYTES {
            return Err(LineFault::Long);
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            LineFault::NotUtf8 { column: String::from_utf8_lossy(good).chars().count() + 1 }
        })?;
        let begins = self.within.is_none() && self.open == 0;
        let head = begins.then(|| table_head(&text)).flatten();
        if head.is_none() {
            self.follow(text.as_bytes());
        }
        Ok(Some(Line { text, head }))
    }

    /// Follows brackets and quotation marks to the end of a line.
    fn follow(&mut self, mut rest: &[u8]) {
        while let Some((&first, after)) = rest.split_first() {
            if let Some(marks) = self.within {
                let escapes = first == b'\\' && marks[0] == b'"';
                rest = if rest.starts_with(marks) {
                    self.within = None;
                    &rest[3..]
                } else {
                    &rest[if escapes { rest.len().min(2) } else { 1 }..]
                };
                continue;
            }
            rest = match first {
                b'#' => return,
                b'"' | b'\'' => {
                    let marks: &[u8] = if first == b'"' { b"\"\"\"" } else { b"\'\'\'" };
                    if rest.starts_with(marks) {
                        self.within = Some(marks);
                        &rest[3..]
                    } else {
                        after_quoted(first, after)
                    }
                }
                b'[' | b'{' => {
                    self.open += 1;
                    after
                }
                b']' | b'}' => {
                    self.open = self.open.saturating_sub(1);
                    after
                }
                _ => after,
            };
        }
    }
}

/// What follows a text in quotation marks on one line; nothing if it does not end there.
fn after_quoted(mark: u8, mut rest: &[u8]) -> &[u8] {
    while let Some((&first, after)) = rest.split_first() {
        if first == mark {
            return after;
        }
        let escapes = first == b'\\' && mark == b'"';
        rest = &rest[if escapes { rest.len().min(2) } else { 1 }..];
    }
    rest
}

/// The table that a line begins. A name with escapes is taken for another table.
fn table_head(line: &str) -> Option<TableHead> {
    let inner = line.trim_start().strip_prefix('[')?;
    let (is_list, inner) = inner.strip_prefix('[').map_or((false, inner), |inner| (true, inner));
    let inner = inner.trim_start();
    let quoted = inner.strip_prefix(['"', '\'']);
    let (name, rest) = match quoted {
        Some(text) => text.split_once(['"', '\'']).unwrap_or((text, "")),
        None => inner.split_at(inner.find([' ', '\t', '.', ']']).unwrap_or(inner.len())),
    };
    let is_sub = rest.trim_start().starts_with('.');
    Some(match (name, is_sub, is_list) {
        ("move", true, _) => TableHead::WithinMove,
        ("move", false, true) => TableHead::Move,
        _ => TableHead::Other,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines that begin a table.
    fn heads(text: &str) -> Vec<(usize, TableHead)> {
        let mut lines = TomlLines::new(text.as_bytes());
        let read = std::iter::from_fn(|| lines.next_line().unwrap());
        (1..).zip(read).filter_map(|(number, line)| Some((number, line.head?))).collect()
    }

    #[test]
    fn tables_are_told_from_lists_and_texts() {
        use TableHead::{Move, Other, WithinMove};
        let text = r##"[machine] # [[move]]
order = [["z"], # [
["x", "y"],
]
name = """
[[move]]
\""" [[move]]
"""
word = "[" # the same ]
path = 'C:\'
text = '''
[[move]] \'''
 [[ move ]]
to = { x = 1, y = [
[1]]}
[move.to]
[ "move" ]
[["move"]]
[[moves]]
[["move".to]]
a = "\"[" # [
[[move]]"##;
        let found = heads(text);
        let wanted = [
            (1, Other),
            (13, Move),
            (16, WithinMove),
            (17, Other),
            (18, Move),
            (19, Other),
            (20, WithinMove),
            (22, Move),
        ];
        assert_eq!(found, wanted);
    }

    #[test]
    fn a_line_that_is_not_text_is_named_by_its_column() {
        let mut lines = TomlLines::new(&b"a = 1\n\xc3\xa9 = \xff"[..]);
        assert!(lines.next_line().unwrap().is_some());
        assert!(matches!(lines.next_line(), Err(LineFault::NotUtf8 { column: 5 })));
    }
}

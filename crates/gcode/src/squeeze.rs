//! Takes comments and blanks out of a line, before the grammar reads it.
//!
//! In RS274/NGC blanks mean nothing outside of comments, not even within a number or a name, and
//! letters mean the same in both cases. What remains is lower-case text, with the column of each
//! character in the file.

use crate::error::{ErrorKind, Fault};

/// A line without comments and blanks. It is used again for each line, so that no memory is
/// allocated for lines without comments.
#[derive(Debug, Default)]
pub(crate) struct Squeezed {
    /// Graphic ASCII characters in lower case.
    pub(crate) text: Vec<u8>,
    /// The column of each character, from 1, and then the column after the last one.
    columns: Vec<u32>,
    /// The texts of the comments, in order.
    pub(crate) comments: Vec<String>,
}

impl Squeezed {
    /// Reads a line.
    ///
    /// # Errors
    /// A comment that is not closed or contains a parenthesis; characters that are not ASCII, and
    /// control characters, outside of comments.
    pub(crate) fn read(&mut self, line: &[u8]) -> Result<(), Fault> {
        self.text.clear();
        self.columns.clear();
        self.comments.clear();
        let mut column = 0;
        let mut rest = line;
        while let Some((&byte, after)) = rest.split_first() {
            column += 1;
            rest = after;
            match byte {
                b' ' | b'\t' | b'\r' | b'\n' => {}
                b'(' => {
                    let inner = Self::parenthesis(rest, column)?;
                    column += characters(inner) + 1;
                    self.comments.push(String::from_utf8_lossy(inner).into_owned());
                    rest = &rest[inner.len() + 1..];
                }
                b';' => {
                    self.comments.push(String::from_utf8_lossy(rest).trim_end().to_owned());
                    break;
                }
                _ if byte.is_ascii_graphic() => {
                    self.text.push(byte.to_ascii_lowercase());
                    self.columns.push(column);
                }
                _ => return Err(Fault::new(column, ErrorKind::NotText(byte))),
            }
        }
        self.columns.push(self.columns.last().map_or(1, |last| last + 1));
        Ok(())
    }

    /// The text of a comment up to its closing parenthesis. `column` is that of the opening one.
    fn parenthesis(rest: &[u8], column: u32) -> Result<&[u8], Fault> {
        let end = rest.iter().position(|&byte| byte == b')' || byte == b'(');
        match end {
            None => Err(Fault::new(column, ErrorKind::UnclosedComment)),
            Some(end) if rest[end] == b'(' => {
                let inner = column + characters(&rest[..end]) + 1;
                Err(Fault::new(inner, ErrorKind::NestedComment))
            }
            Some(end) => Ok(&rest[..end]),
        }
    }

    /// The column of a character of the text, or the one after the last.
    pub(crate) fn column(&self, offset: usize) -> u32 {
        self.columns.get(offset).or(self.columns.last()).copied().unwrap_or(1)
    }
}

/// Number of characters of a text in UTF-8: bytes that do not continue a character.
fn characters(text: &[u8]) -> u32 {
    let count = text.iter().filter(|&&byte| byte & 0b1100_0000 != 0b1000_0000).count();
    u32::try_from(count).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> Result<Squeezed, Fault> {
        let mut squeezed = Squeezed::default();
        squeezed.read(line.as_bytes()).map(|()| squeezed)
    }

    #[test]
    fn blanks_and_comments_are_taken_out_and_columns_are_kept() {
        let line = read("G0 (ä b) X 1 2 ; rest (").unwrap();
        assert_eq!(line.text, b"g0x12");
        assert_eq!(line.comments, ["ä b", " rest ("]);
        let columns: Vec<u32> = (0..6).map(|offset| line.column(offset)).collect();
        assert_eq!(columns, [1, 2, 10, 12, 14, 15]);
    }

    #[test]
    fn faults_have_the_column_of_the_character() {
        assert_eq!(read("G0 (a").unwrap_err(), Fault::new(4, ErrorKind::UnclosedComment));
        assert_eq!(read("G0 (a(b)").unwrap_err(), Fault::new(6, ErrorKind::NestedComment));
        assert_eq!(read("(ä) X\u{0}").unwrap_err(), Fault::new(6, ErrorKind::NotText(0)));
    }
}

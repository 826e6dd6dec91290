//! The excerpt of a file that an error message shows: the wrong line and its neighbours, each cut
//! to [`WIDTH`] characters.

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};
use std::ops::Range;

/// The greatest number of characters shown of a line, chosen around the error.
const WIDTH: usize = 200;
/// The number of them before the error.
const BEFORE: usize = 100;
const CUT: &str = "...";

/// A part of a file, cut for display, with the position of the error in it.
pub struct Excerpt {
    name: String,
    text: String,
    span: Range<usize>,
    /// The line of the file, from 0, at which the excerpt begins.
    first_line: usize,
    /// The column of the error in the file, in characters from 0.
    column: usize,
}

impl Excerpt {
    /// The lines around a span of bytes. A span over several lines is reduced to its first line.
    pub fn new(name: String, text: &str, span: &Range<usize>) -> Self {
        let start = span.start.min(text.len());
        let line = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
        let column = text[line..start].chars().count();
        let before = text[..line]
            .strip_suffix('\n')
            .map(|above| above.rsplit('\n').next().unwrap_or_default());
        let after = text
            .get(end + 1..)
            .filter(|below| !below.is_empty())
            .map(|below| below.lines().next().unwrap_or_default());
        let mut shown = before.map_or_else(String::new, |above| head(above) + "\n");
        let bad = text[line..end].trim_end_matches('\r');
        let (cut, at) = window(bad, column);
        let from = shown.len() + at;
        let longest = shown.len() + cut.trim_end_matches(CUT).len().max(at);
        let length = span.end.min(end).saturating_sub(start);
        shown += &cut;
        if let Some(below) = after {
            shown = shown + "\n" + &head(below);
        }
        let first_line = text[..line].matches('\n').count() - usize::from(before.is_some());
        Self {
            name,
            text: shown,
            span: from..(from + length).min(longest.max(from)),
            first_line,
            column,
        }
    }

    /// The same excerpt of a text that follows this number of lines of the file.
    pub fn after(self, lines: usize) -> Self {
        Self { first_line: self.first_line + lines, ..self }
    }

    /// The position of the error in the excerpt, in bytes.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }
}

/// The beginning of a line, cut for display.
fn head(line: &str) -> String {
    window(line.trim_end_matches('\r'), 0).0
}

/// The part of a line around a column, and the byte offset of that column in it.
fn window(line: &str, column: usize) -> (String, usize) {
    let byte = |chars: usize| line.char_indices().nth(chars).map_or(line.len(), |(at, _)| at);
    if line.chars().nth(WIDTH).is_none() {
        return (line.to_owned(), byte(column));
    }
    let room = WIDTH - 2 * CUT.len();
    let last = line.chars().count() - room;
    let first = column.saturating_sub(BEFORE).min(last);
    let (from, to) = (byte(first), byte(first + room));
    let lead = if from > 0 { CUT } else { "" };
    let tail = if to < line.len() { CUT } else { "" };
    (format!("{lead}{}{tail}", &line[from..to]), lead.len() + byte(column) - from)
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let inner = self.text.read_span(span, lines_before, lines_after)?;
        let line = self.first_line + inner.line();
        // In the line with the error, the column is that of the file; neighbouring lines are shown
        // from their beginning.
        let column =
            if inner.span().offset() == self.span.start { self.column } else { inner.column() };
        let (data, shown, count) = (inner.data(), *inner.span(), inner.line_count());
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.clone(),
            data,
            shown,
            line,
            column,
            count,
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_line_is_cut_around_the_error() {
        let text = format!("short\n{}!{}\nnext", "a".repeat(1_000_000), "b".repeat(9_000_000));
        let excerpt = Excerpt::new("m.toml".into(), &text, &(1_000_006..10_000_007));
        assert_eq!(&excerpt.text[excerpt.span.start..=excerpt.span.start], "!");
        assert!(excerpt.text.lines().all(|line| line.chars().count() <= WIDTH), "{}", excerpt.text);
        assert!(
            excerpt.text.starts_with("short\n...aaa") && excerpt.text.ends_with("bbb...\nnext"),
            "{}",
            excerpt.text
        );
        assert_eq!((excerpt.first_line, excerpt.column), (0, 1_000_000));
    }

    #[test]
    fn error_at_the_end_of_a_long_line_shows_the_end() {
        let text = "\u{17c}".repeat(500);
        let excerpt = Excerpt::new("m.toml".into(), &text, &(text.len()..text.len()));
        assert_eq!((excerpt.column, excerpt.span()), (500, excerpt.text.len()..excerpt.text.len()));
        assert!(
            excerpt.text.starts_with("...\u{17c}") && excerpt.text.ends_with('\u{17c}'),
            "{}",
            excerpt.text
        );
    }

    #[test]
    fn excerpt_exists_for_every_span_of_every_text() {
        for text in [
            "",
            "\n",
            "a",
            "a\n",
            "\n\n",
            "\r\n\r\n",
            "a\r\nb\r\n",
            &"ab\u{e9}\n".repeat(3),
            &"\u{e9}".repeat(300),
        ] {
            for start in (0..=text.len()).filter(|&at| text.is_char_boundary(at)) {
                for end in (start..=text.len()).filter(|&at| text.is_char_boundary(at)) {
                    let excerpt = Excerpt::new("m.toml".into(), text, &(start..end));
                    assert!(excerpt.text.get(excerpt.span()).is_some(), "{text:?} {start}..{end}");
                }
            }
        }
    }
}

//! Errors of input files, with the place of each in its file.

use crate::{nearest, read_text};

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A text file that was read. Its text is kept so that an error can quote the line.
#[derive(Debug, Clone)]
pub struct SourceText {
    /// Path of the file, as the user gave it.
    pub path: PathBuf,
    /// Its whole text.
    pub text: Arc<str>,
}

/// An input that cannot be used: the mistake, its place, and the remedy.
#[derive(Debug, Clone)]
pub struct InputError {
    /// The mistake.
    pub message: String,
    /// The remedy, if there is one.
    pub help: Option<String>,
    /// The file and the range of bytes in its text that is wrong, if the error belongs to one.
    pub place: Option<(SourceText, Range<usize>)>,
    /// Number of lines of the file before this text, if it is a part of a long file.
    pub lines_before: usize,
}

impl InputError {
    /// Makes an error without a place.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: bounded(message.into()), help: None, place: None, lines_before: 0 }
    }

    /// Makes an error at a range of bytes in a file.
    pub fn at(source: &SourceText, span: Range<usize>, message: impl Into<String>) -> Self {
        Self { place: Some((source.clone(), span)), ..Self::new(message) }
    }

    /// Adds a remedy to the error.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(bounded(help.into()));
        self
    }

    /// Line and column of the place, both from 1.
    pub fn line_column(&self) -> Option<(usize, usize)> {
        let (source, span) = self.place.as_ref()?;
        let (line, column) = line_column(source.text.get(..span.start)?);
        Some((self.lines_before + line, column))
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let (Some((source, _)), Some((line, column))) = (&self.place, self.line_column()) {
            write!(f, "{}:{line}:{column}: ", source.path.display())?;
        }
        f.write_str(&self.message)?;
        if let Some(help) = &self.help {
            write!(f, "\n  help: {help}")?;
        }
        Ok(())
    }
}

impl std::error::Error for InputError {}

impl SourceText {
    /// Reads a text file, and registers it as an input, so that no later output of this process
    /// replaces it.
    ///
    /// # Errors
    /// The file cannot be read, is not a regular file, is too long, or is not UTF-8.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let shown = path.display();
        let bytes = read_text(path).map_err(|error| InputError::new(error.to_string()))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let (line, column) = line_column(&String::from_utf8_lossy(good));
            InputError::new(format!("{shown}:{line}:{column}: not UTF-8"))
                .help("a text file in TOML is expected")
        })?;
        Ok(Self { path: path.to_owned(), text: text.into() })
    }

    /// Parses the text as TOML.
    ///
    /// # Errors
    /// [`InputError`] at the place of a syntax error, an unknown key, a missing field or a wrong
    /// type.
    pub fn parse<T: serde::de::DeserializeOwned>(&self) -> Result<T, InputError> {
        self.parse_as(&self.text)
    }

    /// Parses `text` as TOML in the place of this text; errors point to this text.
    pub(crate) fn parse_as<T: serde::de::DeserializeOwned>(
        &self,
        text: &str,
    ) -> Result<T, InputError> {
        toml::from_str(text).map_err(|error| {
            let message = error.message();
            let told = InputError::at(self, error.span().unwrap_or(0..0), in_plain_words(message));
            match meant(message) {
                Some(name) => told.help(format!("did you mean `{name}`?")),
                None => told,
            }
        })
    }
}

/// Line and column, both from 1, of the character that follows the text.
fn line_column(before: &str) -> (usize, usize) {
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
    (line, column)
}

/// The known key or value that is most like the unknown one, from a message of the parser such as
/// "unknown field `a`, expected one of `b`, `c`".
fn meant(message: &str) -> Option<&str> {
    let (wrong, known) = message.strip_prefix("unknown ")?.split_once("`, expected ")?;
    let (_, wrong) = wrong.split_once('`')?;
    nearest(wrong, known.split('`').skip(1).step_by(2))
}

/// Shortens a message that quotes a long text of a file: its first and last 400 characters remain.
fn bounded(message: String) -> String {
    const MOST: usize = 1000;
    const KEPT: usize = 400;
    if message.len() <= MOST {
        return message;
    }
    let head = message.char_indices().nth(KEPT).map_or(message.len(), |(at, _)| at);
    let tail = message.char_indices().nth_back(KEPT).map_or(0, |(at, _)| at);
    if tail <= head { message } else { format!("{} ... {}", &message[..head], &message[tail..]) }
}

/// A text of a file as messages quote it: at most its first 40 characters.
pub(crate) fn quoted(text: &str) -> String {
    const MOST: usize = 40;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

/// Replaces the parser's terms for Rust types by terms for the author of the file.
fn in_plain_words(message: &str) -> String {
    const WORDS: [(&str, &str); 8] = [
        ("wanted string or table", "expected a word in quotes"),
        ("expected f64", "expected a number"),
        ("expected u64", "expected a whole number, zero or more"),
        ("expected u32", "expected a whole number, zero or more"),
        (
            "expected a sequence",
            "expected tables in double brackets, as in [[move]] and [[machine.axis]], or a list in brackets, as in [0, 300]",
        ),
        ("expected a map", "expected distances, as in { x = 1.5 }"),
        (
            "integer number overflowed",
            "a number of too many digits: at most 38, or 60 with a point, are expected",
        ),
        ("floating-point number overflowed", "the number is too great: it must be under 10^30"),
    ];
    WORDS.iter().fold(message.to_owned(), |text, (theirs, ours)| text.replace(theirs, ours))
}

//! What is wrong with an input file, and where.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// A text file that was read, kept so that an error can show the line.
#[derive(Debug, Clone)]
pub struct Source {
    /// Where it came from, as the user named it.
    pub path: PathBuf,
    /// Its whole text.
    pub text: Arc<str>,
}

/// An input that cannot be used: what, where, and what to do.
#[derive(Debug, Clone)]
pub struct InputError {
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// The file, and the bytes in it that are wrong.
    pub place: Option<(Source, Range<usize>)>,
}

impl InputError {
    /// An error without a place.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), help: None, place: None }
    }

    /// An error at a span of bytes in a file.
    pub fn at(source: &Source, span: Range<usize>, message: impl Into<String>) -> Self {
        Self { message: message.into(), help: None, place: Some((source.clone(), span)) }
    }

    /// The same error with advice.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Line and column, both from 1, of the place.
    pub fn line_column(&self) -> Option<(usize, usize)> {
        let (source, span) = self.place.as_ref()?;
        let before = source.text.get(..span.start)?;
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        Some((line, column))
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

impl Source {
    /// Reads a text file.
    ///
    /// # Errors
    /// The file cannot be read or is not UTF-8.
    pub fn read(path: &std::path::Path) -> Result<Self, InputError> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| InputError::new(format!("cannot read {}: {error}", path.display())))?;
        Ok(Self { path: path.to_owned(), text: text.into() })
    }

    /// Parses TOML, with the place of what is wrong.
    ///
    /// # Errors
    /// Syntax errors, unknown keys, missing fields, wrong types.
    pub(crate) fn parse<T: serde::de::DeserializeOwned>(&self) -> Result<T, InputError> {
        toml::from_str(&self.text).map_err(|error| InputError::at(self, error.span().unwrap_or(0..0), error.message()))
    }
}

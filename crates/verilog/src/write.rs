//! Files that appear whole or not at all.

use crate::ExportError;
use carrystep_files::{Claim, NewFile, OutputFailure};
use std::io::Write;
use std::path::{Path, PathBuf};

/// A file that has been made, but not written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextFile {
    /// Its name, or its path from where it is written.
    pub name: String,
    /// Its text.
    pub text: String,
    /// It is a script.
    pub executable: bool,
}

impl TextFile {
    /// A file that is no script.
    pub(crate) fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), executable: false }
    }
}

/// Writes files under `dir`; none appears before all have been written, and none is made where one of them would
/// replace an input.
///
/// # Errors
/// [`ExportError::Io`] names what cannot be written.
pub fn write(dir: &Path, files: &[TextFile]) -> Result<Vec<PathBuf>, ExportError> {
    let claims = files.iter().map(|file| Claim::new(&dir.join(&file.name))).collect::<Result<Vec<_>, _>>()?;
    let made = |(claim, file): (Claim, &TextFile)| {
        let mut new = claim.begin(file.executable)?;
        let written = new.write_all(file.text.as_bytes());
        written.map_err(|source| OutputFailure { path: new.path().to_owned(), source })?;
        Ok(new)
    };
    let made: Vec<NewFile> = claims.into_iter().zip(files).map(made).collect::<Result<_, OutputFailure>>()?;
    Ok(made.into_iter().map(NewFile::appear).collect::<Result<_, _>>()?)
}

impl From<OutputFailure> for ExportError {
    fn from(OutputFailure { path, source }: OutputFailure) -> Self {
        Self::Io { path, source }
    }
}

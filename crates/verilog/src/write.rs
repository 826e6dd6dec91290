//! Writes files that appear completely or not at all.

use crate::ExportError;
use carrystep_files::{NewFile, OutputClaim, OutputFailure};
use std::io::Write;
use std::path::{Path, PathBuf};

/// A generated file that has not been written yet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextFile {
    /// Name of the file, or its path relative to the output directory.
    pub name: String,
    /// Contents of the file.
    pub text: String,
    /// Whether the file is an executable script.
    pub executable: bool,
}

impl TextFile {
    /// A file that is not a script.
    pub(crate) fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), executable: false }
    }
}

/// Writes files into `dir`. No file appears before all have been written. Nothing is written if one
/// of them would replace an input of this process.
///
/// # Errors
/// [`ExportError::Io`] names the file that cannot be written.
pub fn write(dir: &Path, files: &[TextFile]) -> Result<Vec<PathBuf>, ExportError> {
    let claims = files
        .iter()
        .map(|file| OutputClaim::new(&dir.join(&file.name)))
        .collect::<Result<Vec<_>, _>>()?;
    let made = |(claim, file): (OutputClaim, &TextFile)| {
        let mut new = claim.begin(file.executable)?;
        let written = new.write_all(file.text.as_bytes());
        written.map_err(|source| OutputFailure { path: new.path().to_owned(), source })?;
        Ok(new)
    };
    let made: Vec<NewFile> =
        claims.into_iter().zip(files).map(made).collect::<Result<_, OutputFailure>>()?;
    Ok(made.into_iter().map(NewFile::appear).collect::<Result<_, _>>()?)
}

impl From<OutputFailure> for ExportError {
    fn from(OutputFailure { path, source }: OutputFailure) -> Self {
        Self::Io { path, source }
    }
}

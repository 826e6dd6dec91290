//! Files that appear whole or not at all.

use crate::ExportError;
use std::io::{ErrorKind, Write};
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

/// Writes files under `dir`; none appears before all have been written.
///
/// # Errors
/// [`ExportError::Io`] names what cannot be written.
pub fn write(dir: &Path, files: &[TextFile]) -> Result<Vec<PathBuf>, ExportError> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        |source| ExportError::Io { path, source }
    };
    let made = |file: &TextFile| {
        let path = dir.join(&file.name);
        let folder = path.parent().unwrap_or(dir);
        std::fs::create_dir_all(folder).map_err(|source| failed(folder)(told(source)))?;
        let made =
            new_file(folder, file.executable).and_then(|mut new| new.write_all(file.text.as_bytes()).map(|()| new));
        made.map_err(failed(&path)).map(|new| (path, new))
    };
    let made: Vec<_> = files.iter().map(made).collect::<Result<_, _>>()?;
    let appear = |(path, file): (PathBuf, tempfile::NamedTempFile)| {
        file.persist(&path).map_err(|error| failed(&path)(error.error))?;
        Ok(path)
    };
    made.into_iter().map(appear).collect()
}

/// A file in the folder's place is told as what it is; the system says only that something exists.
fn told(error: std::io::Error) -> std::io::Error {
    if error.kind() == ErrorKind::AlreadyExists { ErrorKind::NotADirectory.into() } else { error }
}

/// A file without a name yet, with the permissions of any other new file (a temporary one is its owner's only).
fn new_file(dir: &Path, executable: bool) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(if executable { 0o777 } else { 0o666 }));
    builder.tempfile_in(dir)
}

//! Where results go: standard output, and files that appear whole or not at all.

use crate::failure::Failure;
use serde::Serialize;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Prints text to standard output.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::ReaderGone,
        _ => Failure::Run(format!("cannot write to standard output: {error}")),
    })
}

/// Prints one JSON document.
pub fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value).map_err(|error| Failure::Run(error.to_string()))?;
    print(&format!("{text}\n"))
}

/// A file that is there under its name only once [`OutputFile::keep`] has succeeded.
pub struct OutputFile {
    path: PathBuf,
    writer: BufWriter<NamedTempFile>,
}

impl OutputFile {
    /// Makes the folder if need be, and a nameless file beside the place where the result will be.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let made = std::fs::create_dir_all(folder).and_then(|()| NamedTempFile::new_in(folder));
        let file = made.map_err(|error| cannot_write(path, &error))?;
        Ok(Self { path: path.to_owned(), writer: BufWriter::with_capacity(1 << 18, file) })
    }

    /// Everything is written: let it appear.
    pub fn keep(self) -> Result<PathBuf, Failure> {
        let wrong = |error: std::io::Error| cannot_write(&self.path, &error);
        let file = self.writer.into_inner().map_err(|error| wrong(error.into_error()))?;
        readable_by_all(&file).map_err(wrong)?;
        file.persist(&self.path).map_err(|error| wrong(error.error))?;
        Ok(self.path)
    }
}

/// Temporary files are private; results are ordinary files.
fn readable_by_all(file: &NamedTempFile) -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))?;
    }
    let _ = file;
    Ok(())
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.writer.write(bytes)
    }
    fn flush(&mut self) -> std::io::Result<()> {
        self.writer.flush()
    }
}

/// Writes a whole text file.
pub fn write_file(path: &Path, text: &str) -> Result<(), Failure> {
    let mut file = OutputFile::create(path)?;
    file.write_all(text.as_bytes()).map_err(|error| cannot_write(path, &error))?;
    file.keep().map(|_| ())
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Input(carrystep_spec::InputError::new(format!("cannot write {}: {error}", path.display())))
}

//! Where results go: standard output, and files that appear whole or not at all.

use crate::colour;
use crate::failure::Failure;
use crate::interrupt;
use serde::Serialize;
use std::borrow::Cow;
use std::fs::File;
use std::io::{BufWriter, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Prints text to standard output.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    let painted = if colour::wanted(&out) { Cow::Owned(colour::painted(text)) } else { Cow::Borrowed(text) };
    out.write_all(painted.as_bytes()).and_then(|()| out.flush()).map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::ReaderGone,
        _ => Failure::input(format!("cannot write to standard output: {error}")),
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
    writer: BufWriter<Place>,
}

/// Where the bytes go until then.
enum Place {
    /// A file without a name, beside the place where the result will be.
    Beside(NamedTempFile),
    /// A pipe or a device is written as it is: to rename a file over it would destroy it.
    Itself(File),
}

impl Write for Place {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        match self {
            Self::Beside(file) => file.write(bytes),
            Self::Itself(file) => file.write(bytes),
        }
    }
    fn flush(&mut self) -> std::io::Result<()> {
        match self {
            Self::Beside(file) => file.flush(),
            Self::Itself(file) => file.flush(),
        }
    }
}

impl Seek for Place {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        match self {
            Self::Beside(file) => file.seek(to),
            Self::Itself(file) => file.seek(to),
        }
    }
}

impl OutputFile {
    /// Makes the folder if need be. Whatever forbids the file is found here, before any work is done.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        interrupt::watch();
        let place = place(path).map_err(|error| cannot_write(path, &error))?;
        Ok(Self { path: path.to_owned(), writer: BufWriter::with_capacity(1 << 18, place) })
    }

    /// Where the result will be.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Who writes into us says only what is wrong; this adds where.
    fn named(&self, error: &std::io::Error) -> std::io::Error {
        std::io::Error::new(error.kind(), format!("{}: {error}", self.path.display()))
    }

    /// Writes a whole text.
    pub fn text(&mut self, text: &str) -> Result<(), Failure> {
        self.writer.write_all(text.as_bytes()).map_err(|error| cannot_write(&self.path, &error))
    }

    /// Nothing is left to be written.
    pub fn whole(&mut self) -> Result<(), Failure> {
        self.writer.flush().map_err(|error| cannot_write(&self.path, &error))
    }

    /// Everything is written: let it appear, unless somebody has asked us to end.
    pub fn keep(self) -> Result<PathBuf, Failure> {
        interrupt::check()?;
        self.appear()
    }

    /// Everything is written: let it appear, where to be asked to end is how a command ends.
    pub fn appear(self) -> Result<PathBuf, Failure> {
        let wrong = |error: std::io::Error| cannot_write(&self.path, &error);
        let place = self.writer.into_inner().map_err(|error| wrong(error.into_error()))?;
        if let Place::Beside(file) = place {
            readable_by_all(&file).map_err(wrong)?;
            file.persist(&self.path).map_err(|error| wrong(error.error))?;
        }
        Ok(self.path)
    }
}

fn place(path: &Path) -> std::io::Result<Place> {
    match std::fs::metadata(path) {
        Ok(there) if there.is_dir() => return Err(ErrorKind::IsADirectory.into()),
        Ok(there) if !there.is_file() => return Ok(Place::Itself(File::options().write(true).open(path)?)),
        _ => {}
    }
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if folder.is_file() {
        return Err(ErrorKind::NotADirectory.into());
    }
    std::fs::create_dir_all(folder)?;
    NamedTempFile::new_in(folder).map(Place::Beside)
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
        self.writer.write(bytes).map_err(|error| self.named(&error))
    }
    fn flush(&mut self) -> std::io::Result<()> {
        self.writer.flush().map_err(|error| self.named(&error))
    }
}

impl Seek for OutputFile {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.writer.seek(to).map_err(|error| self.named(&error))
    }
}

/// Writes a whole text file.
pub fn write_file(path: &Path, text: &str) -> Result<(), Failure> {
    let mut file = OutputFile::create(path)?;
    file.text(text)?;
    file.keep().map(|_| ())
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::input(format!("cannot write {}: {error}", path.display()))
}

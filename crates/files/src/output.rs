//! Writes outputs: files that appear completely or not at all.
//!
//! If the system supports it (`O_TMPFILE` of Linux), an output has no name until it is complete.
//! However the process ends, even by SIGKILL, no file remains. Otherwise the output is a temporary
//! file in the same directory, which a killed process leaves behind.
//!
//! On Linux the file receives its name by a link, which cannot replace a file. If a file of that
//! name exists, the new file first receives a temporary name and is then renamed. A process that is
//! killed between these two system calls leaves the temporary name behind.

use crate::made_folders::MadeFolders;
use crate::place::{End, Identity, folder, follow};
use crate::registry::{self, Collision};
use crate::unnamed::{beside, name, nameless};
use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;
use thiserror::Error;

/// Why an output cannot be written.
#[derive(Debug, Error)]
#[error("cannot write {}: {source}", .path.display())]
pub struct OutputFailure {
    /// Path of the file, as the user gave it.
    pub path: PathBuf,
    /// The error.
    #[source]
    pub source: io::Error,
}

/// A claim on a path: it leads to no input and to no other output of this process. The file does
/// not exist yet.
#[derive(Debug)]
pub struct OutputClaim {
    shown: PathBuf,
    at: At,
    /// Number in the registry. A device has none, because several outputs may go to it.
    number: Option<u64>,
}

/// Destination of the bytes.
#[derive(Debug)]
enum At {
    /// A file of this name, which replaces an existing one.
    Name(PathBuf),
    /// An existing pipe or device. Renaming a file to this path would destroy it.
    Itself(PathBuf),
    /// The standard output of this process, together with anything else that is written to it.
    Stdout,
}

impl OutputClaim {
    /// Resolves a path. Symbolic links are followed: their target is replaced or created, and the
    /// links remain.
    ///
    /// # Errors
    /// The path leads to an input or another output of this process, or to a directory, or cannot
    /// be resolved.
    pub fn new(path: &Path) -> Result<Self, OutputFailure> {
        Self::look(path).map_err(|source| OutputFailure { path: path.to_owned(), source })
    }

    fn look(path: &Path) -> io::Result<Self> {
        let shown = path.to_owned();
        if path.as_os_str().is_empty() {
            return Err(io::Error::other("it has no name"));
        }
        if path.as_os_str().to_string_lossy().ends_with('/') {
            return Err(ErrorKind::IsADirectory.into());
        }
        // A small system, or a damaged one, may lack this link. A file made in its place would take
        // what was meant for the pipe.
        #[cfg(unix)]
        if path == Path::new("/dev/stdout") && !path.exists() {
            let number =
                Identity::of_stdout().map(|identity| Self::register(path, identity)).transpose()?;
            return Ok(Self { shown, at: At::Stdout, number });
        }
        let (at, there) = match follow(path)? {
            End::Name(name) => {
                let there = fs::metadata(&name).ok();
                let replaced = there.as_ref().is_none_or(Metadata::is_file);
                (if replaced { At::Name(name) } else { At::Itself(path.to_owned()) }, there)
            }
            End::OpenFile => (At::Itself(path.to_owned()), Some(fs::metadata(path)?)),
        };
        if there.as_ref().is_some_and(Metadata::is_dir) {
            return Err(ErrorKind::IsADirectory.into());
        }
        if there.as_ref().is_some_and(is_block_device) {
            return Err(io::Error::other("it is a block device"));
        }
        if there.as_ref().is_some_and(is_char_device) {
            return Ok(Self { shown, at, number: None });
        }
        let identity = match &at {
            At::Name(name) => Identity::of(name)?,
            At::Itself(_) | At::Stdout => Identity::of(path)?,
        };
        let at = Self::stdout(at, &identity)?;
        let number = Self::register(path, identity)?;
        Ok(Self { shown, at, number: Some(number) })
    }

    /// Claims a file for this output: no input and no other output of the process may be the same.
    fn register(path: &Path, identity: Identity) -> io::Result<u64> {
        registry::add_output(path, identity).map_err(|collision| match collision {
            Collision::Input(input) => {
                io::Error::other(format!("it is the input {}", input.display()))
            }
            Collision::Output(other) => {
                io::Error::other(format!("it is also the output {}", other.display()))
            }
        })
    }

    /// Detects a path to the standard output of this process, so that a file to which it is
    /// redirected is not replaced.
    #[cfg(unix)]
    fn stdout(at: At, identity: &Identity) -> io::Result<At> {
        if Identity::of_stdout().as_ref() != Some(identity) {
            return Ok(at);
        }
        match at {
            At::Name(_) => Err(io::Error::other("standard output goes there already")),
            At::Itself(_) | At::Stdout => Ok(At::Stdout),
        }
    }

    #[cfg(not(unix))]
    fn stdout(at: At, _: &Identity) -> io::Result<At> {
        Ok(at)
    }

    /// Creates the file without its name, and its directory if necessary.
    ///
    /// # Errors
    /// The operating system reports an error.
    pub fn begin(self, executable: bool) -> Result<NewFile, OutputFailure> {
        let (place, made) = self.place(executable).map_err(|source| self.failed(source))?;
        Ok(NewFile { claim: self, place, made })
    }

    /// Whether the output is a regular file, which is replaced, and no pipe or device.
    pub(crate) fn is_file(&self) -> bool {
        matches!(self.at, At::Name(_))
    }

    /// Writes a whole file to the disk and gives it the name. The claim remains.
    pub(crate) fn replace(&self, bytes: &[u8]) -> Result<(), OutputFailure> {
        let write = || {
            let (mut place, made) = self.place(false)?;
            place.file().write_all(bytes)?;
            // After a power failure, the name must lead to the whole file or to the old one.
            place.file().sync_all()?;
            Ok((place, made))
        };
        let (place, _made) = write().map_err(|source| self.failed(source))?;
        // While the old file is open, no other file gets its number, by which it is registered.
        let old = File::open(&self.shown);
        self.name(place)?;
        if let (Some(number), Ok(identity)) = (self.number, Identity::of(&self.shown)) {
            registry::move_output(number, identity);
        }
        drop(old);
        Ok(())
    }

    /// Gives a complete file its name; a file that had the name is replaced.
    fn name(&self, place: Place) -> Result<(), OutputFailure> {
        let named = match (place, &self.at) {
            (Place::Nameless(file), At::Name(target)) => name(file, target),
            (Place::Beside(file), At::Name(target)) => {
                file.persist(target).map(drop).map_err(|error| error.error)
            }
            (Place::Nameless(_) | Place::Beside(_) | Place::Itself(_), _) => Ok(()),
        };
        named.map_err(|source| self.failed(source))
    }

    /// An error of this output.
    pub(crate) fn failed(&self, source: io::Error) -> OutputFailure {
        OutputFailure { path: self.shown.clone(), source }
    }

    fn place(&self, executable: bool) -> io::Result<(Place, MadeFolders)> {
        let itself = |file| (Place::Itself(file), MadeFolders::default());
        match &self.at {
            At::Itself(path) => File::options().write(true).open(path).map(itself),
            At::Stdout => stdout().map(itself),
            At::Name(path) => {
                let folder = folder(path);
                if folder.is_file() {
                    return Err(ErrorKind::NotADirectory.into());
                }
                let made = MadeFolders::make(folder)?;
                let place = match nameless(folder, executable)? {
                    Some(file) => Place::Nameless(file),
                    None => beside(folder, executable).map(Place::Beside)?,
                };
                Ok((place, made))
            }
        }
    }
}

impl Drop for OutputClaim {
    fn drop(&mut self) {
        if let Some(number) = self.number {
            registry::drop_output(number);
        }
    }
}

/// An output that has its name only after [`NewFile::appear`] has succeeded.
#[derive(Debug)]
pub struct NewFile {
    claim: OutputClaim,
    place: Place,
    /// Folders that were made for the file; dropped after it.
    made: MadeFolders,
}

#[derive(Debug)]
enum Place {
    /// A file without a name.
    Nameless(File),
    /// A file with a temporary name, which is removed when this value is dropped.
    Beside(NamedTempFile),
    /// A pipe, a device or the standard output.
    Itself(File),
}

impl NewFile {
    /// Claims a path and creates the file.
    ///
    /// # Errors
    /// As [`OutputClaim::new`] and [`OutputClaim::begin`].
    pub fn create(path: &Path) -> Result<Self, OutputFailure> {
        OutputClaim::new(path)?.begin(false)
    }

    /// Path of the file, as the user gave it.
    pub fn path(&self) -> &Path {
        &self.claim.shown
    }

    /// Gives the file its name; a file that had the name is replaced.
    ///
    /// # Errors
    /// The operating system reports an error; no file has appeared.
    pub fn appear(self) -> Result<PathBuf, OutputFailure> {
        let Self { claim, place, made } = self;
        claim.name(place)?;
        drop(made);
        Ok(claim.shown.clone())
    }
}

impl Place {
    fn file(&mut self) -> &mut File {
        match self {
            Self::Nameless(file) | Self::Itself(file) => file,
            Self::Beside(file) => file.as_file_mut(),
        }
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.place.file().write(bytes)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.place.file().flush()
    }
}

impl Seek for NewFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.place.file().seek(to)
    }
}

#[cfg(unix)]
fn stdout() -> io::Result<File> {
    use std::os::fd::AsFd as _;
    io::stdout().as_fd().try_clone_to_owned().map(File::from)
}

#[cfg(not(unix))]
fn stdout() -> io::Result<File> {
    Err(ErrorKind::Unsupported.into())
}

#[cfg(unix)]
fn is_char_device(there: &Metadata) -> bool {
    std::os::unix::fs::FileTypeExt::is_char_device(&there.file_type())
}

#[cfg(unix)]
fn is_block_device(there: &Metadata) -> bool {
    std::os::unix::fs::FileTypeExt::is_block_device(&there.file_type())
}

#[cfg(not(unix))]
fn is_char_device(_: &Metadata) -> bool {
    false
}

#[cfg(not(unix))]
fn is_block_device(_: &Metadata) -> bool {
    false
}

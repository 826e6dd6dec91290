//! Outputs: files that appear whole or not at all.
//!
//! Until it is whole, an output has no name where the system allows that (`O_TMPFILE` of Linux): whatever ends the
//! process, SIGKILL included, nothing stays behind. Elsewhere it is a temporary file beside its place, which a
//! process that is killed leaves there. On Linux a name is given to the file by a link. A link cannot replace a
//! file: where one is already there, the new file gets a temporary name and is renamed at once. A process that is
//! killed between these two system calls leaves that name.

use crate::place::{End, Identity, folder, follow};
use crate::registry::{self, Collision};
use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;
use thiserror::Error;

/// Why an output cannot be written.
#[derive(Debug, Error)]
#[error("cannot write {}: {source}", .path.display())]
pub struct OutputFailure {
    /// The file as the user named it.
    pub path: PathBuf,
    /// What is wrong.
    #[source]
    pub source: io::Error,
}

/// The right to write a path: it leads to no input and to no other output. Nothing is made yet.
#[derive(Debug)]
pub struct Claim {
    shown: PathBuf,
    at: At,
    /// In the registry; a device has none, because two outputs may go there.
    number: Option<u64>,
}

/// Where the bytes go.
#[derive(Debug)]
enum At {
    /// To a file of this name, which replaces one that is there.
    Name(PathBuf),
    /// Into what is there: a pipe or a device. To rename a file over it would destroy it.
    Itself(PathBuf),
    /// Into our own standard output, behind whatever else is written there.
    Stdout,
}

impl Claim {
    /// Looks where a path leads. Links are followed: what they lead to is replaced, or made, and the links stay.
    ///
    /// # Errors
    /// The path leads to an input or another output of this process, or to a folder, or nowhere.
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
        let number = registry::add_output(path, identity).map_err(|collision| match collision {
            Collision::Input(input) => io::Error::other(format!("it is the input {}", input.display())),
            Collision::Output(other) => io::Error::other(format!("it is also the output {}", other.display())),
        })?;
        Ok(Self { shown, at, number: Some(number) })
    }

    /// What is our own standard output is written there; a file to which it was sent is not replaced.
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

    /// Makes the file, without its name yet, and its folder if need be.
    ///
    /// # Errors
    /// The system refuses.
    pub fn begin(self, executable: bool) -> Result<NewFile, OutputFailure> {
        match self.place(executable) {
            Ok(place) => Ok(NewFile { claim: self, place }),
            Err(source) => Err(OutputFailure { path: self.shown.clone(), source }),
        }
    }

    fn place(&self, executable: bool) -> io::Result<Place> {
        match &self.at {
            At::Itself(path) => File::options().write(true).open(path).map(Place::Itself),
            At::Stdout => stdout().map(Place::Itself),
            At::Name(path) => {
                let folder = folder(path);
                if folder.is_file() {
                    return Err(ErrorKind::NotADirectory.into());
                }
                fs::create_dir_all(folder)?;
                match nameless(folder, executable)? {
                    Some(file) => Ok(Place::Nameless(file)),
                    None => beside(folder, executable).map(Place::Beside),
                }
            }
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        if let Some(number) = self.number {
            registry::drop_output(number);
        }
    }
}

/// An output that is there under its name only once [`NewFile::appear`] has succeeded.
#[derive(Debug)]
pub struct NewFile {
    claim: Claim,
    place: Place,
}

#[derive(Debug)]
enum Place {
    /// A file without a name.
    Nameless(File),
    /// A file with a temporary name, removed with this value.
    Beside(NamedTempFile),
    /// A pipe, a device or standard output.
    Itself(File),
}

impl NewFile {
    /// Claims a path and makes the file.
    ///
    /// # Errors
    /// As [`Claim::new`] and [`Claim::begin`].
    pub fn create(path: &Path) -> Result<Self, OutputFailure> {
        Claim::new(path)?.begin(false)
    }

    /// The file as the user named it.
    pub fn path(&self) -> &Path {
        &self.claim.shown
    }

    /// Gives the file its name, in place of a file that had it.
    ///
    /// # Errors
    /// The system refuses; nothing has appeared then.
    pub fn appear(self) -> Result<PathBuf, OutputFailure> {
        let Self { claim, place } = self;
        let appeared = match (place, &claim.at) {
            (Place::Nameless(file), At::Name(target)) => name(file, target),
            (Place::Beside(file), At::Name(target)) => file.persist(target).map(drop).map_err(|error| error.error),
            (Place::Nameless(_) | Place::Beside(_) | Place::Itself(_), _) => Ok(()),
        };
        appeared.map_err(|source| OutputFailure { path: claim.shown.clone(), source })?;
        Ok(claim.shown.clone())
    }

    fn file(&mut self) -> &mut File {
        match &mut self.place {
            Place::Nameless(file) | Place::Itself(file) => file,
            Place::Beside(file) => file.as_file_mut(),
        }
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file().write(bytes)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.file().flush()
    }
}

impl Seek for NewFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file().seek(to)
    }
}

/// Permissions of any other new file, before the user's mask.
const fn mode(executable: bool) -> u32 {
    if executable { 0o777 } else { 0o666 }
}

/// A file without a name in this folder; `None` where the system has none.
#[cfg(target_os = "linux")]
fn nameless(folder: &Path, executable: bool) -> io::Result<Option<File>> {
    use rustix::fs::{Mode, OFlags, open};
    use rustix::io::Errno;
    // Its name is given by way of this folder.
    if !Path::new("/proc/self/fd").is_dir() {
        return Ok(None);
    }
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    match open(folder, flags, Mode::from_raw_mode(mode(executable))) {
        Ok(file) => Ok(Some(file.into())),
        // Which of these a file system says that cannot do it depends on its age and the kernel's.
        Err(Errno::OPNOTSUPP | Errno::ISDIR | Errno::NOENT | Errno::INVAL | Errno::NOSYS) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

#[cfg(not(target_os = "linux"))]
fn nameless(_: &Path, _: bool) -> io::Result<Option<File>> {
    Ok(None)
}

/// A file with a temporary name in this folder.
fn beside(folder: &Path, executable: bool) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode(executable)));
    let _ = executable;
    builder.tempfile_in(folder)
}

/// Gives a file without a name this one.
#[cfg(target_os = "linux")]
fn name(file: File, target: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use rustix::io::Errno;
    use std::os::fd::AsRawFd as _;
    let from = format!("/proc/self/fd/{}", file.as_raw_fd());
    let link = |to: &Path| linkat(CWD, from.as_str(), CWD, to, AtFlags::SYMLINK_FOLLOW);
    match link(target) {
        Ok(()) => return Ok(()),
        Err(Errno::EXIST) => {}
        Err(_) => return copied(file, target),
    }
    for attempt in 0..1000 {
        let temporary = folder(target).join(format!(".carrystep-{}-{attempt}.tmp", std::process::id()));
        match link(&temporary) {
            Ok(()) => {
                return fs::rename(&temporary, target).inspect_err(|_| {
                    // What is left to say is why the file could not be renamed.
                    let _ = fs::remove_file(&temporary);
                });
            }
            Err(Errno::EXIST) => {}
            Err(error) => return Err(error.into()),
        }
    }
    Err(ErrorKind::AlreadyExists.into())
}

#[cfg(not(target_os = "linux"))]
fn name(file: File, target: &Path) -> io::Result<()> {
    copied(file, target)
}

/// The same where the file system has files without a name, and no link to one.
fn copied(mut file: File, target: &Path) -> io::Result<()> {
    #[cfg(unix)]
    let executable = std::os::unix::fs::PermissionsExt::mode(&file.metadata()?.permissions()) & 0o100 != 0;
    #[cfg(not(unix))]
    let executable = false;
    let mut new = beside(folder(target), executable)?;
    file.rewind()?;
    io::copy(&mut Read::by_ref(&mut file), &mut new)?;
    new.persist(target).map(drop).map_err(|error| error.error)
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

//! Resolves paths: follows links, and decides whether two paths are the same file.

use std::ffi::OsStr;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Greatest number of consecutive links that are followed, as in Linux.
const MOST_LINKS: u32 = 40;

/// Identity of a file, independent of its names: device and inode.
#[cfg(unix)]
type Number = (u64, u64);
/// Identity of a file on systems without inodes: its canonical path.
#[cfg(not(unix))]
type Number = PathBuf;

/// Identity of a path: the file itself, or, if it does not exist yet, the nearest existing
/// directory above it and the rest of the path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Identity {
    existing: Number,
    rest: PathBuf,
}

impl Identity {
    /// The identity of the target of a path.
    pub(crate) fn of(path: &Path) -> io::Result<Self> {
        let path = std::path::absolute(path)?;
        for folder in path.ancestors() {
            match number(folder) {
                Ok(existing) => {
                    let rest = path.strip_prefix(folder).unwrap_or(Path::new("")).to_owned();
                    return Ok(Self { existing, rest });
                }
                Err(error) if error.kind() == ErrorKind::NotFound => {}
                Err(error) => return Err(error),
            }
        }
        Err(ErrorKind::NotFound.into())
    }

    /// The identity of the standard output.
    #[cfg(unix)]
    pub(crate) fn of_stdout() -> Option<Self> {
        use std::os::fd::AsFd as _;
        use std::os::unix::fs::MetadataExt as _;
        let there =
            fs::File::from(io::stdout().as_fd().try_clone_to_owned().ok()?).metadata().ok()?;
        Some(Self { existing: (there.dev(), there.ino()), rest: PathBuf::new() })
    }
}

#[cfg(unix)]
fn number(path: &Path) -> io::Result<Number> {
    use std::os::unix::fs::MetadataExt as _;
    fs::metadata(path).map(|there| (there.dev(), there.ino()))
}

#[cfg(not(unix))]
fn number(path: &Path) -> io::Result<Number> {
    fs::canonicalize(path)
}

/// The end of a path.
pub(crate) enum End {
    /// A name that is not a link: of a file, or of nothing yet.
    Name(PathBuf),
    /// An open file of a process (/dev/stdout, /dev/fd/3), which only looks like a link.
    OpenFile,
}

/// Follows the links at the end of a path. For a link without a target, the result is the name of
/// the missing target.
pub(crate) fn follow(path: &Path) -> io::Result<End> {
    let mut at = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::symlink_metadata(&at) {
            Ok(there) if there.is_symlink() => {}
            Ok(_) => return Ok(End::Name(at)),
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(End::Name(at)),
            Err(error) => return Err(error),
        }
        let folder = folder(&at);
        if is_open_files(folder) {
            return Ok(End::OpenFile);
        }
        at = folder.join(fs::read_link(&at)?);
    }
    Err(io::Error::other("too many symbolic links, one leading to the other"))
}

/// The directory that contains a path.
pub(crate) fn folder(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Whether a directory is /proc/PROCESS/fd.
fn is_open_files(folder: &Path) -> bool {
    let real = fs::canonicalize(folder);
    real.is_ok_and(|real| real.starts_with("/proc") && real.file_name() == Some(OsStr::new("fd")))
}

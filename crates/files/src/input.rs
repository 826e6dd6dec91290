//! Opens and reads inputs: regular files only, and texts up to a limit.

use crate::registry;
use std::fs::{File, Metadata};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Greatest size in bytes of a text that is read as a whole (machine, move, sweep and board files,
/// reports).
pub const MAX_TEXT_BYTES: u64 = 4 << 20;

/// Why an input cannot be read.
#[derive(Debug, Error)]
#[error("cannot read {}: {why}", .path.display())]
pub struct InputFailure {
    /// Path of the file, as the user gave it.
    pub path: PathBuf,
    /// The reason.
    pub why: InputFault,
}

/// A reason why an input cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum InputFault {
    /// The operating system reports an error.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The file exists but is not a regular file.
    #[error("it is a {0}, and an input must be a regular file")]
    Kind(&'static str),
    /// The file is longer than [`MAX_TEXT_BYTES`].
    #[error("it has {size} bytes, and an input may have at most {MAX_TEXT_BYTES} ({} MiB)", MAX_TEXT_BYTES >> 20)]
    Size {
        /// Its length, as far as it is known.
        size: String,
    },
    /// This process is about to replace the file by an output.
    #[error("it is also the output {}", .0.display())]
    Output(PathBuf),
}

/// Opens an input of any size: a regular file, or a symbolic link to one. From then on, no output
/// of this process can replace it.
///
/// # Errors
/// [`InputFailure`] if the file is missing, may not be read, is not a regular file, or is an output
/// of this process.
pub fn open(path: &Path) -> Result<File, InputFailure> {
    let failed = |why: InputFault| InputFailure { path: path.to_owned(), why };
    let file = open_regular(path).map_err(failed)?;
    registry::add_input(path).map_err(|output| failed(InputFault::Output(output)))?;
    Ok(file)
}

/// Opens a regular file and does not register it.
fn open_regular(path: &Path) -> Result<File, InputFault> {
    // Opening a device can have an effect, and opening a pipe can block, so the kind of the file is
    // checked first.
    regular(&std::fs::metadata(path)?)?;
    let file = without_waiting(path)?;
    // The kind is checked again, because the name may meanwhile belong to another file.
    regular(&file.metadata()?)?;
    Ok(file)
}

/// Reads a whole text of at most [`MAX_TEXT_BYTES`].
///
/// # Errors
/// As [`open`]; also if the file is too long, or if reading fails.
pub fn read_text(path: &Path) -> Result<Vec<u8>, InputFailure> {
    contents(open(path)?).map_err(|why| InputFailure { path: path.to_owned(), why })
}

/// Reads what a process has written before it was started again. The file may also be an output of
/// this process, so it is not registered as an input. `None` if there is no such file.
pub(crate) fn read_own(path: &Path) -> Result<Option<Vec<u8>>, InputFailure> {
    match open_regular(path).and_then(contents) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(InputFault::Io(error)) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(why) => Err(InputFailure { path: path.to_owned(), why }),
    }
}

/// All bytes of a file of at most [`MAX_TEXT_BYTES`].
fn contents(file: File) -> Result<Vec<u8>, InputFault> {
    let size = file.metadata()?.len();
    if size > MAX_TEXT_BYTES {
        return Err(InputFault::Size { size: size.to_string() });
    }
    let mut bytes = Vec::new();
    // The reported size is not sufficient: files of the kernel report 0, and a log grows while it
    // is read.
    file.take(MAX_TEXT_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_TEXT_BYTES {
        return Err(InputFault::Size { size: format!("more than {MAX_TEXT_BYTES}") });
    }
    Ok(bytes)
}

fn regular(there: &Metadata) -> Result<(), InputFault> {
    if there.is_file() { Ok(()) } else { Err(InputFault::Kind(kind(there))) }
}

/// The name of this kind of file.
fn kind(there: &Metadata) -> &'static str {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt as _;
        let kind = there.file_type();
        if kind.is_fifo() {
            return "pipe (FIFO)";
        }
        if kind.is_char_device() || kind.is_block_device() {
            return "device";
        }
        if kind.is_socket() {
            return "socket";
        }
    }
    if there.is_dir() { "folder" } else { "special file" }
}

/// Opens a file for reading without waiting, even if it has become a pipe.
fn without_waiting(path: &Path) -> io::Result<File> {
    let mut options = File::options();
    options.read(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt as _;
        options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits().cast_signed());
    }
    options.open(path)
}

//! New files without a name or with a temporary one, and how they get their name.

use crate::place::folder;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read, Seek};
use std::path::Path;
use tempfile::NamedTempFile;

/// Permissions of a new file before the umask is applied.
const fn mode(executable: bool) -> u32 {
    if executable { 0o777 } else { 0o666 }
}

/// Creates a file without a name in this directory; `None` if the system does not support it.
#[cfg(target_os = "linux")]
pub(crate) fn nameless(folder: &Path, executable: bool) -> io::Result<Option<File>> {
    use rustix::fs::{Mode, OFlags, open};
    use rustix::io::Errno;
    // The name is given by way of this directory.
    if !Path::new("/proc/self/fd").is_dir() {
        return Ok(None);
    }
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    match open(folder, flags, Mode::from_raw_mode(mode(executable))) {
        Ok(file) => Ok(Some(file.into())),
        // Which of these errors a file system without this function reports depends on its age and
        // on the kernel's.
        Err(Errno::OPNOTSUPP | Errno::ISDIR | Errno::NOENT | Errno::INVAL | Errno::NOSYS) => {
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn nameless(_: &Path, _: bool) -> io::Result<Option<File>> {
    Ok(None)
}

/// Creates a file with a temporary name in this directory.
pub(crate) fn beside(folder: &Path, executable: bool) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode(executable)));
    let _ = executable;
    builder.tempfile_in(folder)
}

/// Gives a file without a name this name.
#[cfg(target_os = "linux")]
pub(crate) fn name(file: File, target: &Path) -> io::Result<()> {
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
        let temporary =
            folder(target).join(format!(".carrystep-{}-{attempt}.tmp", std::process::id()));
        match link(&temporary) {
            Ok(()) => {
                return fs::rename(&temporary, target).inspect_err(|_| {
                    // The error of the rename is reported, so an error here is ignored.
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
pub(crate) fn name(file: File, target: &Path) -> io::Result<()> {
    copied(file, target)
}

/// Copies the file to a temporary file and renames that, for file systems that support files
/// without a name but no link to one.
fn copied(mut file: File, target: &Path) -> io::Result<()> {
    #[cfg(unix)]
    let executable =
        std::os::unix::fs::PermissionsExt::mode(&file.metadata()?.permissions()) & 0o100 != 0;
    #[cfg(not(unix))]
    let executable = false;
    let mut new = beside(folder(target), executable)?;
    file.rewind()?;
    io::copy(&mut Read::by_ref(&mut file), &mut new)?;
    new.persist(target).map(drop).map_err(|error| error.error)
}

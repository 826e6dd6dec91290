//! The user's cache folder. What lies there is executed or believed, so nobody but the user may
//! have put it there.

use std::fs::{self, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Names another folder than the user's cache folder.
const VARIABLE: &str = "CARRYSTEP_CACHE";

/// Why the cache folder, or a file in it, is not used.
#[derive(Debug, Error)]
pub enum CacheFailure {
    /// Somebody else could have put it there.
    #[error("{}: {why}", path.display())]
    Refused {
        /// The folder or file.
        path: PathBuf,
        /// What is wrong with it.
        why: &'static str,
    },
    /// The system's.
    #[error("{context}: {source}")]
    Io {
        /// What was tried.
        context: String,
        /// The system's answer.
        source: io::Error,
    },
}

/// The user's own cache folder, made where it is not there: `$CARRYSTEP_CACHE`, or `carrystep` in
/// the user's cache folder (`$XDG_CACHE_HOME`, `~/.cache`).
///
/// # Errors
/// The folder cannot be made, or another user owns it or may write to it.
pub fn cache_folder() -> Result<PathBuf, CacheFailure> {
    let chosen = std::env::var_os(VARIABLE).filter(|path| !path.is_empty()).map(PathBuf::from);
    let folder = chosen.or_else(|| Some(dirs::cache_dir()?.join("carrystep")));
    let folder = folder
        .ok_or_else(|| refused(Path::new("~/.cache/carrystep"), "the user has no home folder"))?;
    make(&folder)?;
    Ok(folder)
}

/// A folder of the cache folder, made where it is not there, with the same checks.
///
/// # Errors
/// As [`cache_folder`].
pub fn cache_folder_of(name: &str) -> Result<PathBuf, CacheFailure> {
    let folder = cache_folder()?.join(name);
    make(&folder)?;
    Ok(folder)
}

fn make(folder: &Path) -> Result<(), CacheFailure> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    let context = || format!("cannot make the cache folder {}", folder.display());
    let io = |source| CacheFailure::Io { context: context(), source };
    builder.create(folder).map_err(io)?;
    // The folder itself, and no link that somebody else may turn round.
    let there = fs::symlink_metadata(folder).map_err(io)?;
    if !there.is_dir() {
        return Err(refused(folder, "it is no folder"));
    }
    own(folder, &there)
}

/// Whether the cache has this file.
///
/// # Errors
/// It is there, and another user owns it or may write to it.
pub fn cache_holds(file: &Path) -> Result<bool, CacheFailure> {
    match fs::symlink_metadata(file) {
        Ok(there) if there.is_file() => own(file, &there).map(|()| true),
        Ok(_) => Err(refused(file, "it is no file")),
        Err(_) => Ok(false),
    }
}

/// Nobody else owns it or may write to it.
#[cfg(unix)]
fn own(path: &Path, there: &Metadata) -> Result<(), CacheFailure> {
    use std::os::unix::fs::MetadataExt as _;
    const OTHERS_MAY_WRITE: u32 = 0o022;
    if there.uid() != rustix::process::geteuid().as_raw() {
        return Err(refused(path, "another user owns it"));
    }
    if there.mode() & OTHERS_MAY_WRITE != 0 {
        return Err(refused(path, "other users may write to it: `chmod go-w` changes that"));
    }
    Ok(())
}

#[cfg(not(unix))]
fn own(_: &Path, _: &Metadata) -> Result<(), CacheFailure> {
    Ok(())
}

fn refused(path: &Path, why: &'static str) -> CacheFailure {
    CacheFailure::Refused { path: path.to_owned(), why }
}

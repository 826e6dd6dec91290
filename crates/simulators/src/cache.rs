//! The directory of compiled simulations. They will be executed, so no other user may be able to
//! write to it.

use crate::LevelError;
use crate::tool::io;
use std::fs::{self, Metadata};
use std::path::{Path, PathBuf};

/// Environment variable that selects another directory for compiled simulations.
const CACHE_VARIABLE: &str = "CARRYSTEP_CACHE";

/// The user's own directory for compiled simulations: `$CARRYSTEP_CACHE`, or `carrystep` in the
/// user's cache directory (`$XDG_CACHE_HOME`, `~/.cache`). It is created if it does not exist.
///
/// # Errors
/// The directory cannot be created, or another user owns it or can write to it.
pub(crate) fn folder() -> Result<PathBuf, LevelError> {
    let chosen = std::env::var_os(CACHE_VARIABLE).filter(|path| !path.is_empty()).map(PathBuf::from);
    let folder = chosen.or_else(|| Some(dirs::cache_dir()?.join("carrystep")));
    let folder = folder.ok_or_else(|| refused(Path::new("~/.cache/carrystep"), "the user has no home folder"))?;
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    let made = format!("cannot make the cache folder {}", folder.display());
    builder.create(&folder).map_err(io(made.clone()))?;
    // Checks the directory itself; a symbolic link could be redirected by another user.
    let there = fs::symlink_metadata(&folder).map_err(io(made))?;
    if !there.is_dir() {
        return Err(refused(&folder, "it is no folder"));
    }
    own(&folder, &there)?;
    Ok(folder)
}

/// Whether a compiled simulation exists.
///
/// # Errors
/// It exists, but another user owns it or can write to it.
pub(crate) fn holds(binary: &Path) -> Result<bool, LevelError> {
    match fs::symlink_metadata(binary) {
        Ok(there) if there.is_file() => own(binary, &there).map(|()| true),
        Ok(_) => Err(refused(binary, "it is no file")),
        Err(_) => Ok(false),
    }
}

/// Removes the permissions of all other users from a compiled simulation, regardless of the user's
/// umask.
pub(crate) fn only_ours(binary: &Path) -> Result<(), LevelError> {
    #[cfg(unix)]
    fs::set_permissions(binary, std::os::unix::fs::PermissionsExt::from_mode(0o700))
        .map_err(io("cannot keep the compiled simulation"))?;
    let _ = binary;
    Ok(())
}

/// Checks that no other user owns this or can write to it.
#[cfg(unix)]
fn own(path: &Path, there: &Metadata) -> Result<(), LevelError> {
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
fn own(_: &Path, _: &Metadata) -> Result<(), LevelError> {
    Ok(())
}

fn refused(path: &Path, why: &'static str) -> LevelError {
    LevelError::Cache { path: path.to_owned(), why }
}

//! The directory of compiled simulations. They will be executed, so no other user may be able to
//! write to it.

use crate::LevelError;
use crate::tool::io;
use carrystep_files::CacheFailure;
use std::fs;
use std::path::{Path, PathBuf};

/// The user's own folder for compiled simulations, see [`carrystep_files::cache_folder`].
///
/// # Errors
/// The directory cannot be created, or another user owns it or can write to it.
pub(crate) fn folder() -> Result<PathBuf, LevelError> {
    carrystep_files::cache_folder().map_err(failed)
}

/// Whether a compiled simulation exists.
///
/// # Errors
/// It exists, but another user owns it or can write to it.
pub(crate) fn holds(binary: &Path) -> Result<bool, LevelError> {
    carrystep_files::cache_holds(binary).map_err(failed)
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

fn failed(failure: CacheFailure) -> LevelError {
    match failure {
        CacheFailure::Refused { path, why } => LevelError::Cache { path, why },
        CacheFailure::Io { context, source } => LevelError::Io { context, source },
    }
}

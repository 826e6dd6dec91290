//! The folder of compiled simulations. They are executed, so nobody but the user may have put them there.

use crate::LevelError;
use crate::tool::io;
use carrystep_files::CacheFailure;
use std::fs;
use std::path::{Path, PathBuf};

/// The user's own folder for compiled simulations, see [`carrystep_files::cache_folder`].
///
/// # Errors
/// The folder cannot be made, or another user owns it or may write to it.
pub(crate) fn folder() -> Result<PathBuf, LevelError> {
    carrystep_files::cache_folder().map_err(failed)
}

/// Whether a compiled simulation is there.
///
/// # Errors
/// It is there, and another user owns it or may write to it.
pub(crate) fn holds(binary: &Path) -> Result<bool, LevelError> {
    carrystep_files::cache_holds(binary).map_err(failed)
}

/// Takes everybody else's permissions from a compiled simulation, whatever the user's mask is.
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

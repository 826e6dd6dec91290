//! The executable of this command, by which builds of the same version are told apart.

use crate::failure::Failure;
use carrystep_files::sealed::sha256;
use std::path::PathBuf;

/// The executable of this process. Linux finds it here also if it was replaced or removed since.
const RUNNING: &str = "/proc/self/exe";

/// The path of the executable.
pub fn path() -> Result<PathBuf, Failure> {
    std::env::current_exe()
        .map_err(|error| Failure::Run(format!("the path of carrystep is not known: {error}")))
}

/// The first 16 hexadecimal digits of the SHA-256 of the executable.
pub fn build() -> Result<String, Failure> {
    let bytes = match std::fs::read(RUNNING) {
        Ok(bytes) => bytes,
        Err(_) => std::fs::read(path()?).map_err(|error| {
            Failure::Run(format!("cannot read the executable of carrystep: {error}"))
        })?,
    };
    Ok(sha256(&bytes).chars().take(16).collect())
}

//! The folder of lock files and sockets, which only this user can access.

use std::fs::DirBuilder;
use std::io::{Error, ErrorKind, Result};
use std::os::unix::fs::{DirBuilderExt as _, MetadataExt as _};
use std::path::{Path, PathBuf};

/// The first usable folder of the user. It must be the same in every terminal of the user, so the
/// environment variable comes last.
///
/// # Errors
/// No folder can be created or used; the error is that of the last one.
pub fn folder() -> Result<PathBuf> {
    let mut refused = Error::from(ErrorKind::NotFound);
    for path in all() {
        match private(&path) {
            Ok(()) => return Ok(path),
            Err(error) => {
                refused = Error::new(error.kind(), format!("{}: {error}", path.display()));
            }
        }
    }
    Err(refused)
}

/// All folders in which another command of this user may have its files.
pub fn all() -> Vec<PathBuf> {
    let user = rustix::process::geteuid().as_raw();
    let mut folders = vec![
        PathBuf::from(format!("/run/user/{user}/carrystep")),
        PathBuf::from(format!("/tmp/carrystep-{user}")),
    ];
    folders
        .extend(std::env::var_os("XDG_RUNTIME_DIR").map(|path| Path::new(&path).join("carrystep")));
    folders
}

/// Creates the folder, or checks that it belongs to this user and that nobody else can access it.
fn private(path: &Path) -> Result<()> {
    match DirBuilder::new().mode(0o700).create(path) {
        Err(error) if error.kind() != ErrorKind::AlreadyExists => return Err(error),
        _ => {}
    }
    let there = path.symlink_metadata()?;
    let own = there.uid() == rustix::process::geteuid().as_raw();
    if there.is_dir() && own && there.mode() & 0o077 == 0 {
        return Ok(());
    }
    Err(Error::new(
        ErrorKind::PermissionDenied,
        "it must be a folder of this user with the permissions 0700",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    #[test]
    fn folder_accessible_to_others_is_refused() {
        let top = tempfile::tempdir().unwrap();
        let [own, open, file, link] =
            ["own", "open", "file", "link"].map(|name| top.path().join(name));
        private(&own).unwrap();
        assert_eq!(own.metadata().unwrap().mode() & 0o777, 0o700);
        private(&own).unwrap();
        std::fs::create_dir(&open).unwrap();
        std::fs::set_permissions(&open, std::fs::Permissions::from_mode(0o755)).unwrap();
        std::fs::write(&file, "").unwrap();
        symlink(&own, &link).unwrap();
        for path in [&open, &file, &link] {
            assert_eq!(
                private(path).unwrap_err().kind(),
                ErrorKind::PermissionDenied,
                "{}",
                path.display()
            );
        }
    }
}

//! A symbolic link to the pseudo-terminal, for senders that keep the name of their port.

use crate::failure::Failure;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

/// A link that is removed when it is dropped, unless it leads elsewhere by then.
#[derive(Debug)]
pub struct Link {
    path: PathBuf,
    to: PathBuf,
}

impl Link {
    /// Makes a link. Another link of this name is replaced.
    ///
    /// # Errors
    /// Something else has this name, or the system refuses the link.
    pub fn new(path: &Path, to: &str) -> Result<Self, Failure> {
        let refused = |why: String| Failure::input(format!("{}: {why}", path.display()));
        if let Ok(found) = std::fs::symlink_metadata(path)
            && !found.is_symlink()
        {
            return Err(refused("something else than a symbolic link has this name".to_owned()));
        }
        // It appears whole: a sender never finds no link where there was one.
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let made = tempfile::Builder::new()
            .prefix(".carrystep")
            .make_in(folder.unwrap_or(Path::new(".")), |place| symlink(to, place));
        let made = made.map_err(|error| refused(error.to_string()))?;
        made.persist(path).map_err(|error| refused(error.error.to_string()))?;
        Ok(Self { path: path.to_owned(), to: to.into() })
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        if std::fs::read_link(&self.path).is_ok_and(|to| to == self.to) {
            // Whoever has removed it before has done what was to do.
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

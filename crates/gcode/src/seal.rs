//! Notices that a file changes while it is read, by its length and the time of its last change.

use crate::error::ErrorKind;
use crate::source::unreadable;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// What changes when a file is written: its length and the time of its last change.
type Signs = (u64, Option<SystemTime>);

/// A file as it was when it was opened.
#[derive(Debug)]
pub(crate) struct Seal {
    path: PathBuf,
    signs: Signs,
}

impl Seal {
    /// Opens a regular file.
    pub(crate) fn open(path: &Path) -> Result<(File, Self), ErrorKind> {
        // A device or a pipe could block for ever, and cannot be read twice.
        let there = std::fs::metadata(path).map_err(|error| unreadable(&error))?;
        if !there.is_file() {
            return Err(ErrorKind::Unreadable("it is no regular file".to_owned()));
        }
        let file = File::open(path).map_err(|error| unreadable(&error))?;
        let signs = signs(&file).map_err(|error| unreadable(&error))?;
        Ok((file, Self { path: path.to_owned(), signs }))
    }

    /// Whether the file at the path still has the same signs.
    pub(crate) fn holds(&self) -> bool {
        File::open(&self.path).and_then(|file| signs(&file)).is_ok_and(|now| now == self.signs)
    }
}

fn signs(file: &File) -> std::io::Result<Signs> {
    let there = file.metadata()?;
    Ok((there.len(), there.modified().ok()))
}

//! Folders that were made for an output, and that disappear again if the output does not appear.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Folders that this process has made, the outermost first. When the value is dropped, those that
/// are still empty are removed.
#[derive(Debug, Default)]
pub(crate) struct MadeFolders(Vec<PathBuf>);

impl MadeFolders {
    /// Makes a folder, and those that it is to be in, if they do not exist.
    ///
    /// # Errors
    /// The operating system reports an error; nothing was made then.
    pub(crate) fn make(folder: &Path) -> io::Result<Self> {
        // An empty path is the present folder.
        let missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
        let missing: Vec<&Path> = folder.ancestors().take_while(missing).collect();
        let mut made = Self::default();
        for folder in missing.into_iter().rev() {
            match fs::create_dir(folder) {
                Ok(()) => made.0.push(folder.to_owned()),
                // Another process has made it meanwhile.
                Err(_) if folder.is_dir() => {}
                Err(error) => return Err(error),
            }
        }
        Ok(made)
    }
}

impl Drop for MadeFolders {
    fn drop(&mut self) {
        for folder in self.0.iter().rev() {
            // A folder that holds something stays.
            if fs::remove_dir(folder).is_err() {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_stay_only_with_something_in_them() {
        let root = tempfile::tempdir().unwrap();
        let inner = root.path().join("a/b/c");
        drop(MadeFolders::make(&inner).unwrap());
        assert!(!root.path().join("a").exists());

        let made = MadeFolders::make(&inner).unwrap();
        fs::write(root.path().join("a/b/file"), "").unwrap();
        drop(made);
        assert!(root.path().join("a/b/file").exists() && !inner.exists());

        // A folder that was there before is not removed.
        let outer = root.path().join("a/d");
        fs::create_dir(&outer).unwrap();
        drop(MadeFolders::make(&outer.join("e")).unwrap());
        assert!(outer.exists() && !outer.join("e").exists());
        drop(MadeFolders::make(&outer).unwrap());
        assert!(outer.exists());
    }

    #[test]
    fn nothing_is_left_where_a_folder_cannot_be_made() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("file"), "").unwrap();
        assert!(MadeFolders::make(&root.path().join("file/a")).is_err());
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
        drop(MadeFolders::make(Path::new("")).unwrap());
    }
}

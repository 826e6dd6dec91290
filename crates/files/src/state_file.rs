//! A file that a process reads when it begins, and replaces again and again while it works, so that
//! a later process can continue.

use crate::input::{InputFailure, read_own};
use crate::output::{OutputClaim, OutputFailure};
use std::io;
use std::path::Path;
use thiserror::Error;

/// Why a state file cannot be used.
#[derive(Debug, Error)]
pub enum StateFailure {
    /// It cannot be read.
    #[error(transparent)]
    Input(#[from] InputFailure),
    /// It cannot be written.
    #[error(transparent)]
    Output(#[from] OutputFailure),
}

/// A file with the state of this process. Under its name there is always a whole state: the old one
/// or the new one, however the process ends.
#[derive(Debug)]
pub struct StateFile {
    claim: OutputClaim,
}

impl StateFile {
    /// Claims the file as an output and reads what an earlier process has left in it; `None` if
    /// there is no such file. Nothing is written.
    ///
    /// # Errors
    /// The path leads to an input or another output of this process, or to something other than a
    /// regular file; the file is longer than [`crate::MAX_TEXT_BYTES`]; or reading fails.
    pub fn open(path: &Path) -> Result<(Self, Option<Vec<u8>>), StateFailure> {
        let claim = OutputClaim::new(path)?;
        if !claim.is_file() {
            return Err(claim.failed(io::Error::other("it is not a regular file")).into());
        }
        let left = read_own(path)?;
        Ok((Self { claim }, left))
    }

    /// Replaces the content. The new content is on the disk when this function returns.
    ///
    /// # Errors
    /// The operating system reports an error, for example that the disk is full. The old content is
    /// still there.
    pub fn replace(&self, bytes: &[u8]) -> Result<(), StateFailure> {
        Ok(self.claim.replace(bytes)?)
    }
}

#[cfg(test)]
mod tests {
    use super::StateFile;

    #[test]
    fn each_state_replaces_the_one_before() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new").join("state");
        let (file, left) = StateFile::open(&path).expect("a claim");
        assert_eq!(left, None);
        assert!(!path.exists(), "opening writes nothing");
        assert!(StateFile::open(&path).is_err(), "an output has one writer");
        for state in ["first", "second", ""] {
            file.replace(state.as_bytes()).expect("space on the disk");
            assert_eq!(std::fs::read_to_string(&path).expect("a file"), state);
        }
        drop(file);
        assert_eq!(StateFile::open(&path).expect("a claim").1, Some(Vec::new()));
        assert_eq!(std::fs::read_dir(path.parent().expect("a folder")).expect("it").count(), 1);
    }

    /// A system gives the number of a removed file to a new one. The claim must follow its file.
    #[test]
    fn claim_is_of_the_file_that_has_the_name_now() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state");
        let (file, _) = StateFile::open(&path).expect("a claim");
        for round in 0..50 {
            file.replace(b"state").expect("space on the disk");
            assert!(StateFile::open(&path).is_err(), "an output has one writer");
            let other = folder.path().join(round.to_string());
            std::fs::write(&other, "another file").expect("space on the disk");
            let error = StateFile::open(&other).err().map(|error| error.to_string());
            assert_eq!(error, None);
        }
    }

    #[test]
    fn folders_and_inputs_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        assert!(StateFile::open(folder.path()).is_err());
        let input = folder.path().join("input");
        std::fs::write(&input, "text").expect("a file");
        crate::read_text(&input).expect("an input");
        let error = StateFile::open(&input).expect_err("an input is never replaced").to_string();
        assert!(error.contains("it is the input"), "{error}");
    }
}

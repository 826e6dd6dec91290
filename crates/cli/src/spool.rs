//! Text of any length that is printed when it is complete, and not at all if it never is.

use crate::failure::Failure;
use crate::output;
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use tempfile::SpooledTempFile;

/// The greatest length of a text that is kept in memory, in bytes. A longer one goes to a file
/// without a name in the folder for temporary files.
const KEPT: usize = 1 << 23;

/// Number of bytes that are written or read at once.
const BLOCK: usize = 1 << 16;

/// A text that grows at its end.
pub struct Spool {
    file: SpooledTempFile,
    block: String,
}

impl Spool {
    /// An empty text.
    pub fn new() -> Self {
        Self { file: SpooledTempFile::new(KEPT), block: String::new() }
    }

    /// Adds what `write` writes.
    pub fn add(&mut self, write: impl FnOnce(&mut String)) -> Result<(), Failure> {
        write(&mut self.block);
        if self.block.len() < BLOCK { Ok(()) } else { self.flush() }
    }

    fn flush(&mut self) -> Result<(), Failure> {
        self.file.write_all(self.block.as_bytes()).map_err(|error| failed(&error))?;
        self.block.clear();
        Ok(())
    }

    /// Prints all of it to standard output.
    pub fn print(mut self) -> Result<(), Failure> {
        self.flush()?;
        self.file.seek(SeekFrom::Start(0)).map_err(|error| failed(&error))?;
        let mut block = vec![0; BLOCK];
        loop {
            match self.file.read(&mut block).map_err(|error| failed(&error))? {
                0 => return Ok(()),
                length => output::print_bytes(&block[..length])?,
            }
        }
    }
}

fn failed(error: &std::io::Error) -> Failure {
    let folder = std::env::temp_dir();
    Failure::input(format!("cannot keep the plan in {}: {error}", folder.display()))
}

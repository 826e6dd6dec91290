//! All files of the workspace that are made from tables of `spec`: the register map's, the pages of boards and drivers, and the
//! boards' gateware.

use crate::write::{TextFile, write};
use crate::{ExportError, Gateware, board, registers};
use carrystep_boards::boards;
use std::path::Path;

/// Each file, its name being its path in the workspace.
///
/// # Errors
/// [`ExportError`] where a file cannot be made.
pub fn generated_files() -> Result<Vec<TextFile>, ExportError> {
    let mut files: Vec<_> = registers::files()?.into_iter().map(|(path, text)| TextFile::new(path, text)).collect();
    files.extend(board::pages()?);
    for board in boards() {
        let made = Gateware::shipped(board, &board.parts[0])?.files()?.into_iter();
        files.extend(made.map(|file| TextFile { name: format!("hdl-out/{}/{}", board.name, file.name), ..file }));
    }
    Ok(files)
}

/// Writes each of them to its place under the workspace's `root`; each appears whole or not at all.
///
/// # Errors
/// [`ExportError`] where a file cannot be made or written.
pub fn write_generated_files(root: &Path) -> Result<(), ExportError> {
    write(root, &generated_files()?).map(|_| ())
}

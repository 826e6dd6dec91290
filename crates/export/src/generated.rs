//! All files of the workspace that are made from tables of `spec`: the register map's, the pages of boards and drivers.

use crate::core::new_file;
use crate::{ExportError, board, registers};
use std::io::Write;
use std::path::Path;

/// Each file: its path in the workspace, and its text.
///
/// # Errors
/// [`ExportError::Template`] where a template asks for what there is not.
pub fn generated_files() -> Result<Vec<(String, String)>, ExportError> {
    let mut files: Vec<_> = registers::files()?.into_iter().map(|(path, text)| (path.to_owned(), text)).collect();
    files.extend(board::pages()?);
    Ok(files)
}

/// Writes each of them to its place under the workspace's `root`; each appears whole or not at all.
///
/// # Errors
/// [`ExportError`] where a file cannot be made or written.
pub fn write_generated_files(root: &Path) -> Result<(), ExportError> {
    for (path, text) in generated_files()? {
        let path = root.join(path);
        let dir = path.parent().unwrap_or(root);
        let write = || {
            std::fs::create_dir_all(dir)?;
            let mut file = new_file(dir)?;
            file.write_all(text.as_bytes())?;
            file.persist(&path)?;
            Ok(())
        };
        write().map_err(|source| ExportError::Io { path: path.clone(), source })?;
    }
    Ok(())
}

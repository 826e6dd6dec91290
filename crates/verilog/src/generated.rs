//! All files of the workspace that are generated from tables of `spec`: the files of the register
//! map, the pages of boards and drivers, the cores, and the boards' gateware.

use crate::core::{engine_of, line_of, link_of, parallel_of};
use crate::prefix::Prefix;
use crate::write::{TextFile, write};
use crate::{ExportError, Gateware, board, fusesoc, registers};
use carrystep_boards::boards;
use carrystep_core::link::LineKind;
use carrystep_files::{Machine, SourceText};
use std::path::Path;

/// Where the modules are that boards share.
const CORE: &str = "hdl-out/core";

/// The machine whose parameters are the defaults there.
const SHIPPED: &str = "sim/six-axis.toml";
const SHIPPED_TEXT: &str = include_str!("../../../sim/six-axis.toml");

/// Each file, named by its path in the workspace.
///
/// # Errors
/// [`ExportError`] if a file cannot be generated.
pub fn generated_files() -> Result<Vec<TextFile>, ExportError> {
    let mut files: Vec<_> =
        registers::files()?.into_iter().map(|(path, text)| TextFile::new(path, text)).collect();
    files.extend(board::pages()?);
    files.extend(core_files()?);
    for board in boards() {
        let made = Gateware::shipped(board, &board.parts[0])?.files_beside("../core")?.into_iter();
        files.extend(made.map(|file| TextFile {
            name: format!("hdl-out/{}/{}", board.name, file.name),
            ..file
        }));
    }
    Ok(files)
}

/// The cores, each with its files, with the parameters of the shipped machine as defaults, and
/// their description for FuseSoC.
fn core_files() -> Result<Vec<TextFile>, ExportError> {
    let machine =
        Machine::from_source(&SourceText { path: SHIPPED.into(), text: SHIPPED_TEXT.into() })?;
    let (build, line, prefix) = (machine.engine(), machine.line()?, Prefix::default());
    let cores = [
        engine_of(&build, &prefix, SHIPPED)?,
        link_of(&build, line, &prefix, SHIPPED)?,
        line_of(line, &prefix, SHIPPED)?,
        line_of(LineKind::Spi, &prefix, SHIPPED)?,
        parallel_of(&machine.build()?, machine.axes.len(), &prefix, SHIPPED)?,
    ];
    let description = fusesoc::description(&cores)?;
    let mut files = Vec::new();
    for core in cores {
        files.extend(core.files()?);
    }
    files.push(description);
    Ok(files
        .into_iter()
        .map(|file| TextFile { name: format!("{CORE}/{}", file.name), ..file })
        .collect())
}

/// Writes the files to their places under `root`, the root of the workspace. Each file appears
/// completely or not at all.
///
/// # Errors
/// [`ExportError`] if a file cannot be generated or written.
pub fn write_generated_files(root: &Path) -> Result<(), ExportError> {
    write(root, &generated_files()?).map(|_| ())
}

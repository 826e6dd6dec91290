//! The files that a run is to write: all begun before it, so that a wrong path costs no time, and all
//! kept after it.

use crate::failure::Failure;
use crate::output::OutputFile;
use std::path::{Path, PathBuf};

/// What is asked for.
#[derive(Debug, Default)]
pub struct Wanted {
    pub vcd: Option<PathBuf>,
    pub fst: Option<PathBuf>,
    pub save: Option<PathBuf>,
    pub csv: Option<PathBuf>,
    pub plot: Option<PathBuf>,
}

/// The same, begun.
pub struct Files {
    pub vcd: Option<OutputFile>,
    pub fst: Option<OutputFile>,
    pub save: Option<OutputFile>,
    pub csv: Option<OutputFile>,
    pub plot: Option<OutputFile>,
}

impl Wanted {
    /// Begins all files. None of them may be the move file, or another of them.
    pub fn begin(&self, move_file: &Path) -> Result<Files, Failure> {
        let mut taken = vec![("the move file", absolute(move_file))];
        let named = [
            ("--vcd", &self.vcd),
            ("--fst", &self.fst),
            ("--save", &self.save),
            ("--csv", &self.csv),
            ("--plot", &self.plot),
        ];
        for (name, path) in named {
            let Some(path) = path else { continue };
            if let Some((other, _)) = taken.iter().find(|(_, there)| *there == absolute(path)) {
                return Err(Failure::input(format!("{name} would write over {other}: {}", path.display())));
            }
            taken.push((name, absolute(path)));
        }
        let begin = |path: &Option<PathBuf>| path.as_deref().map(OutputFile::create).transpose();
        Ok(Files {
            vcd: begin(&self.vcd)?,
            fst: begin(&self.fst)?,
            save: begin(&self.save)?,
            csv: begin(&self.csv)?,
            plot: begin(&self.plot)?,
        })
    }
}

impl Files {
    /// Lets all files appear, or none where one is not whole; their paths.
    pub fn keep(self) -> Result<Vec<PathBuf>, Failure> {
        let mut files: Vec<OutputFile> =
            [self.vcd, self.fst, self.save, self.csv, self.plot].into_iter().flatten().collect();
        files.iter_mut().try_for_each(OutputFile::whole)?;
        files.into_iter().map(OutputFile::keep).collect()
    }
}

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

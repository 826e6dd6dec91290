//! The output files of a run. All of them are begun before the run, so that a wrong path is
//! detected at once, and they appear after it.

use crate::failure::Failure;
use crate::output::OutputFile;
use std::path::PathBuf;

/// The paths of the wanted files.
#[derive(Debug, Default)]
pub struct Wanted {
    pub vcd: Option<PathBuf>,
    pub fst: Option<PathBuf>,
    pub save: Option<PathBuf>,
    pub csv: Option<PathBuf>,
    pub plot: Option<PathBuf>,
}

/// The same files after they were begun.
pub struct Files {
    pub vcd: Option<OutputFile>,
    pub fst: Option<OutputFile>,
    pub save: Option<OutputFile>,
    pub csv: Option<OutputFile>,
    pub plot: Option<OutputFile>,
}

impl Wanted {
    /// Begins all files. If one of them is an input, equals another output or cannot be written,
    /// none is begun.
    pub fn begin(&self) -> Result<Files, Failure> {
        let claim = |path: &Option<PathBuf>| path.as_deref().map(OutputFile::claim).transpose();
        let claims = [
            claim(&self.vcd)?,
            claim(&self.fst)?,
            claim(&self.save)?,
            claim(&self.csv)?,
            claim(&self.plot)?,
        ];
        let [vcd, fst, save, csv, plot] =
            claims.map(|claim| claim.map(OutputFile::begin).transpose());
        Ok(Files { vcd: vcd?, fst: fst?, save: save?, csv: csv?, plot: plot? })
    }
}

impl Files {
    /// Lets all files appear and returns their paths. If one of them is incomplete, none appears.
    pub fn keep(self) -> Result<Vec<PathBuf>, Failure> {
        let mut files: Vec<OutputFile> =
            [self.vcd, self.fst, self.save, self.csv, self.plot].into_iter().flatten().collect();
        files.iter_mut().try_for_each(OutputFile::whole)?;
        files.into_iter().map(OutputFile::keep).collect()
    }
}

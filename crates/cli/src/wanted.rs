//! The output files of a run. All of them are begun before the run, so that a wrong path is
//! detected at once, and they appear after it.

use crate::failure::Failure;
use crate::output::OutputFile;
use carrystep_check::View;
use carrystep_files::{Machine, did_you_mean};
use std::path::PathBuf;

/// The paths of the wanted files.
#[derive(Debug, Default)]
pub struct Wanted {
    pub vcd: Option<PathBuf>,
    pub fst: Option<PathBuf>,
    pub save: Option<PathBuf>,
    pub csv: Option<PathBuf>,
    pub plot: Option<PathBuf>,
    pub report: Option<PathBuf>,
    /// The part of the run that the waveform shows.
    pub part: Part,
}

/// A part of a run.
#[derive(Debug, Default)]
pub struct Part {
    /// Seconds after the start of the first move.
    pub from: Option<f64>,
    pub to: Option<f64>,
    /// Names of axes; none: all.
    pub axes: Vec<String>,
}

impl Part {
    /// The part of a run of `total_s` seconds, in times of a capture that has its origin at
    /// `origin_ps`.
    pub fn view(&self, machine: &Machine, origin_ps: i64, total_s: f64) -> Result<View, Failure> {
        let (from, to) = (self.from, self.to);
        if let Some(from) = from.filter(|&from| from >= total_s) {
            return Err(Failure::input(format!(
                "--from {from} is not within the moves, which take {total_s:.6} s"
            )));
        }
        if let Some((from, to)) = from.zip(to).filter(|(from, to)| from >= to) {
            return Err(Failure::input(format!("--from {from} is not before --to {to}")));
        }
        let at = |seconds: f64| (seconds * 1e12).round() as i64;
        let at = |seconds| u64::try_from(origin_ps.saturating_add(at(seconds))).unwrap_or(0);
        let view = View::default().between(from.map(at), to.map(at));
        if self.axes.is_empty() {
            return Ok(view);
        }
        let known = || machine.axes.iter().map(|axis| axis.name.as_str());
        let number = |name: &String| {
            known().position(|one| one == name).ok_or_else(|| {
                let meant = did_you_mean(name, known());
                let all = known().collect::<Vec<_>>().join(", ");
                Failure::input(format!("no axis is called '{name}'{meant}: the axes are {all}"))
            })
        };
        Ok(view.of_axes(self.axes.iter().map(number).collect::<Result<_, _>>()?))
    }
}

/// The same files after they were begun.
pub struct Files {
    pub vcd: Option<OutputFile>,
    pub fst: Option<OutputFile>,
    pub save: Option<OutputFile>,
    pub csv: Option<OutputFile>,
    pub plot: Option<OutputFile>,
    pub report: Option<OutputFile>,
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
            claim(&self.report)?,
        ];
        let [vcd, fst, save, csv, plot, report] =
            claims.map(|claim| claim.map(OutputFile::begin).transpose());
        Ok(Files { vcd: vcd?, fst: fst?, save: save?, csv: csv?, plot: plot?, report: report? })
    }
}

impl Files {
    /// The paths under which the files will appear.
    pub fn paths(&self) -> Vec<PathBuf> {
        let Self { vcd, fst, save, csv, plot, report } = self;
        let files = [vcd, fst, save, csv, plot, report].into_iter().flatten();
        files.map(|file| file.path().to_owned()).collect()
    }

    /// Lets all files appear and returns their paths. If one of them is incomplete, none appears.
    pub fn keep(self) -> Result<Vec<PathBuf>, Failure> {
        let Self { vcd, fst, save, csv, plot, report } = self;
        let files = [vcd, fst, save, csv, plot, report];
        let mut files: Vec<OutputFile> = files.into_iter().flatten().collect();
        files.iter_mut().try_for_each(OutputFile::whole)?;
        files.into_iter().map(OutputFile::keep).collect()
    }
}

//! `carrystep sweep --slurm`, `--parallel` and `--kubernetes`: writes the files with which other
//! programs run the shards of a sweep.

use crate::arguments::Sweep;
use crate::failure::Failure;
use crate::output::OutputFile;
use crate::{executable, output};
use carrystep_sweep::{Cluster, SweepFile};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::path::{Path, PathBuf, absolute};
use std::process::Command;

/// The number of shards if the user gives none.
const SHARDS: u64 = 64;

/// A program that runs shards, and the folder for its files.
pub enum Scheduler<'a> {
    Slurm(&'a Path),
    Parallel(&'a Path),
    Kubernetes(&'a Path, &'a str),
}

impl<'a> Scheduler<'a> {
    /// The one that the arguments name.
    pub fn of(arguments: &'a Sweep) -> Option<Self> {
        let Sweep { slurm, parallel, kubernetes, image, .. } = arguments;
        if let Some(folder) = slurm {
            return Some(Self::Slurm(folder));
        }
        if let Some(folder) = parallel {
            return Some(Self::Parallel(folder));
        }
        kubernetes.as_deref().zip(image.as_deref()).map(|(dir, image)| Self::Kubernetes(dir, image))
    }

    fn folder(&self) -> &'a Path {
        match self {
            Self::Slurm(folder) | Self::Parallel(folder) | Self::Kubernetes(folder, _) => folder,
        }
    }
}

/// The files for a cluster, and what was submitted. `--json` prints it as it is.
#[derive(Debug, JsonSchema, Serialize)]
pub struct WrittenForCluster<'a> {
    /// Always true.
    passed: bool,
    /// The program for which the files are: slurm, parallel or kubernetes.
    scheduler: &'static str,
    /// Number of shards.
    shards: u64,
    /// Number of cases of the sweep.
    cases: u64,
    /// The files that were written.
    files: Vec<PathBuf>,
    /// The jobs that were submitted; null without `--submit`.
    submitted: Option<Submitted>,
    /// The commands with which to continue.
    #[serde(skip)]
    next: &'a str,
}

/// The jobs that were submitted to Slurm.
#[derive(Debug, JsonSchema, Serialize)]
struct Submitted {
    /// The job id of the array.
    shards: String,
    /// The job id of the merge.
    merge: String,
}

/// Writes the files and submits them if that is wanted.
pub fn write(arguments: &Sweep, file: &Path, scheduler: &Scheduler<'_>) -> Result<(), Failure> {
    let sweep = SweepFile::load(file, arguments.sample, arguments.seed)?;
    let folder = scheduler.folder();
    let (file, executable) = (whole(file)?, executable::path()?);
    let cluster = Cluster {
        sweep: &sweep,
        file: &file,
        folder: &whole(folder)?,
        carrystep: &whole(&executable)?,
        version: env!("CARGO_PKG_VERSION"),
        core: arguments.core.name(),
        shards: arguments.shards.unwrap_or(SHARDS),
    };
    let (name, texts, next) = match scheduler {
        Scheduler::Slurm(_) => ("slurm", cluster.slurm()?, "shards.sbatch says how to submit them"),
        Scheduler::Parallel(_) => ("parallel", cluster.parallel()?, "`sh run.sh` runs and merges"),
        Scheduler::Kubernetes(_, image) => {
            ("kubernetes", cluster.kubernetes(image)?, "sweep.yaml says how to apply them")
        }
    };
    let claims = texts.iter().map(|file| OutputFile::claim(&folder.join(file.name)));
    let claims = claims.collect::<Result<Vec<_>, _>>()?;
    let mut files = Vec::new();
    for (claim, text) in claims.into_iter().zip(&texts) {
        let mut file = OutputFile::begin(claim)?;
        file.text(&text.text)?;
        files.push(file.keep()?);
    }
    let submitted = if arguments.submit { Some(submit(folder)?) } else { None };
    let (shards, cases) = (cluster.shards, sweep.cases());
    let written =
        WrittenForCluster { passed: true, scheduler: name, shards, cases, files, submitted, next };
    if arguments.json { output::print_json(&written) } else { output::print(&written.to_string()) }
}

/// An absolute path as a text.
fn whole(path: &Path) -> Result<String, Failure> {
    let failed = |why: String| Failure::input(format!("{}: {why}", path.display()));
    let whole = absolute(path).map_err(|error| failed(error.to_string()))?;
    let text = whole.into_os_string().into_string();
    text.map_err(|_| failed("the path is not UTF-8, and a script needs it as text".to_owned()))
}

/// Submits the array, and the merge that waits for it.
fn submit(folder: &Path) -> Result<Submitted, Failure> {
    let shards = sbatch(folder, &["shards.sbatch"])?;
    let dependency = format!("--dependency=afterany:{shards}");
    let merge = sbatch(folder, &[&dependency, "merge.sbatch"]).map_err(|failure| {
        Failure::Run(format!(
            "{}\n  the shards were submitted as job {shards}, but not the merge\n  help: submit it from {} by `sbatch {dependency} merge.sbatch`",
            failure.message(),
            folder.display()
        ))
    })?;
    Ok(Submitted { shards, merge })
}

/// Runs sbatch and returns the job id.
fn sbatch(folder: &Path, arguments: &[&str]) -> Result<String, Failure> {
    let command =
        Command::new("sbatch").arg("--parsable").args(arguments).current_dir(folder).output();
    let output = command.map_err(|error| {
        Failure::Tool(format!(
            "cannot start sbatch: {error}\n  help: run this on a machine that submits to Slurm; the files are written already"
        ))
    })?;
    let said = String::from_utf8_lossy(&output.stdout);
    // With several clusters, the name of the cluster follows.
    let id = said.trim().split(';').next().unwrap_or_default();
    let is_id = !id.is_empty() && id.bytes().all(|byte| byte.is_ascii_digit());
    if output.status.success() && is_id {
        return Ok(id.to_owned());
    }
    let why = String::from_utf8_lossy(&output.stderr);
    Err(Failure::Run(format!("sbatch did not submit {}: {}", arguments.join(" "), why.trim())))
}

impl fmt::Display for WrittenForCluster<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for file in &self.files {
            writeln!(f, "wrote {}", file.display())?;
        }
        writeln!(f, "{} cases in {} shards", self.cases, self.shards)?;
        match &self.submitted {
            Some(Submitted { shards, merge }) => {
                writeln!(f, "submitted the shards as job {shards} and the merge as job {merge}")
            }
            None => writeln!(f, "next: {}", self.next),
        }
    }
}

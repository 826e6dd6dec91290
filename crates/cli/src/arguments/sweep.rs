//! The arguments of `carrystep sweep`.

use super::{Core, core};
use carrystep_sweep::Shard;
use clap::{ArgGroup, Args};
use std::path::PathBuf;

/// The arguments of `carrystep sweep`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("cluster").args(["slurm", "parallel", "kubernetes"])
    .conflicts_with_all(["shard", "keep", "merge", "report", "junit"]))]
pub struct Sweep {
    /// The sweep: a move file with blanks, and what they are filled with.
    #[arg(value_name = "SWEEP.toml", required_unless_present = "merge")]
    pub file: Option<PathBuf>,
    /// Which gateware: the engine, one adder for all axes with queues and a guard; or its sibling,
    /// an adder an axis.
    #[arg(long, default_value = "engine", value_name = "CORE", value_parser = core())]
    pub core: Core,
    /// So many random cases instead of the whole grid.
    #[arg(long, value_name = "CASES")]
    pub sample: Option<u64>,
    /// Seed of the random cases.
    #[arg(long, default_value_t = 1, value_name = "NUMBER")]
    pub seed: u64,
    /// Only this part of the cases: 3/16 is the third of sixteen.
    #[arg(long, default_value_t = Shard::WHOLE, value_name = "N/OF")]
    pub shard: Shard,
    /// Keep the progress in this file. If the run is ended, killed or fails, the same command
    /// continues with the cases that are missing.
    #[arg(long, value_name = "FILE", conflicts_with = "merge")]
    pub keep: Option<PathBuf>,
    /// Exit status 0 if all cases were judged, whatever the result; the merge gives the verdict
    /// (needs --keep).
    #[arg(long, requires = "keep", conflicts_with_all = ["json", "merge"])]
    pub no_verdict: bool,
    /// Make one report of all shards, from their JSON reports or from the files in which they keep
    /// their progress.
    #[arg(long, value_name = "SHARD", num_args = 1.., conflicts_with_all = ["file", "core", "sample", "seed", "shard"])]
    pub merge: Vec<PathBuf>,
    /// Write files that run all shards as a job array of Slurm, and merge them.
    #[arg(long, value_name = "DIR")]
    pub slurm: Option<PathBuf>,
    /// Also submit them by sbatch (needs --slurm).
    #[arg(long, requires = "slurm")]
    pub submit: bool,
    /// Write files that run all shards by GNU parallel, and merge them.
    #[arg(long, value_name = "DIR")]
    pub parallel: Option<PathBuf>,
    /// Write files that run all shards as an indexed Job of Kubernetes, and merge them (needs
    /// --image).
    #[arg(long, value_name = "DIR", requires = "image")]
    pub kubernetes: Option<PathBuf>,
    /// The container image with carrystep, for --kubernetes.
    #[arg(long, value_name = "IMAGE", requires = "kubernetes")]
    pub image: Option<String>,
    /// Number of shards for --slurm, --parallel or --kubernetes; default: 64.
    #[arg(long, value_name = "COUNT", requires = "cluster", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub shards: Option<u64>,
    /// Also write the JSON report to this file.
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// Also write the result as JUnit XML, a test case for the whole and one for each case that
    /// failed.
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// One JSON document instead of the table; shards are merged from these.
    #[arg(long)]
    pub json: bool,
}

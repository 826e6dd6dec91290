//! `carrystep sweep` on clusters: a real Slurm and a real GNU parallel run the files that it
//! writes. There is no Kubernetes here; its files are read as YAML, and their scripts run in a
//! shell.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::expect_used)] // Tests may panic.

mod daemons;
mod folder;
mod kubernetes;
mod parallel;
mod slurm;

//! The machine that is inspected: its root directory, its search path and its user. Tests use a
//! temporary directory as the root.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// A machine.
#[derive(Debug, Clone)]
pub struct Computer {
    /// Directory that contains `dev`, `sys`, `proc` and `etc`.
    pub root: PathBuf,
    /// Search path of programs, as in PATH.
    pub path: OsString,
    /// The current user.
    pub user: User,
    /// Function that returns whether the user may read and write a file.
    pub may: fn(&Path) -> bool,
}

/// A user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct User {
    /// Login name, if it is known.
    pub name: Option<String>,
    /// Group ids of this session.
    pub groups: Vec<u32>,
}

impl Computer {
    /// The machine on which this process runs.
    pub fn this() -> Self {
        let path = std::env::var_os("PATH").unwrap_or_default();
        let name = std::env::var("USER").or_else(|_| std::env::var("LOGNAME")).ok();
        Self { root: "/".into(), path, user: User { name, groups: groups() }, may }
    }

    /// The file of a program, if the search path contains it.
    pub(crate) fn program(&self, name: &str) -> Option<PathBuf> {
        which::which_in_global(name, Some(&self.path)).ok()?.next()
    }

    /// The entries of a directory, sorted by name; empty if there is no such directory.
    pub(crate) fn list(&self, folder: &str) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.root.join(folder)).into_iter().flatten().flatten();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        paths.sort();
        paths
    }

    /// Name of a group, and whether its entry lists the user.
    pub(crate) fn group(&self, gid: u32) -> Option<(String, bool)> {
        let text = fs::read_to_string(self.root.join("etc/group")).ok()?;
        let mut rows = text.lines().map(|line| line.split(':').collect::<Vec<_>>());
        let row = rows.find(|row| row.get(2).is_some_and(|id| id.parse() == Ok(gid)))?;
        let members = row.get(3).copied().unwrap_or_default();
        Some((
            row[0].to_owned(),
            members.split(',').any(|member| self.user.name.as_deref() == Some(member)),
        ))
    }
}

#[cfg(unix)]
fn groups() -> Vec<u32> {
    let mut groups: Vec<u32> = rustix::process::getgroups()
        .unwrap_or_default()
        .into_iter()
        .map(|gid| gid.as_raw())
        .collect();
    groups.push(rustix::process::getegid().as_raw());
    groups
}

#[cfg(not(unix))]
fn groups() -> Vec<u32> {
    Vec::new()
}

/// As the system decides it, with access control lists.
#[cfg(unix)]
fn may(path: &Path) -> bool {
    use rustix::fs::Access;
    rustix::fs::access(path, Access::READ_OK | Access::WRITE_OK).is_ok()
}

#[cfg(not(unix))]
fn may(_: &Path) -> bool {
    true
}

//! Checks whether the user may open a device, and finds the reason if not.

use crate::doctor::Computer;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::fs;
use std::path::Path;

/// Whether a device may be used.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PortAccess {
    /// The user may open the device.
    Granted,
    /// Another program has the device open.
    InUse {
        /// Its process.
        pid: u32,
        /// Its name.
        program: String,
    },
    /// The operating system denies access.
    Refused(AccessRefusal),
}

/// Why the operating system denies access.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "snake_case", tag = "reason")]
pub enum AccessRefusal {
    /// The device's group may use it, but the user is not a member of the group.
    NotInGroup {
        /// The group.
        group: String,
    },
    /// The user is a member of the group, but was not when this session began.
    LogInAgain {
        /// The group.
        group: String,
    },
    /// Not even the device's group may use it, because a udev rule is missing.
    NoRule,
}

/// Whether the user may open this device.
pub(crate) fn access(host: &Computer, device: &Path) -> PortAccess {
    if !(host.may)(device) {
        return PortAccess::Refused(refusal(host, device));
    }
    user_of(host, device).unwrap_or(PortAccess::Granted)
}

/// Why the user may not open this device of this machine, if a reason can be found. Symbolic links
/// are followed.
pub fn obstacle(device: &Path) -> Option<PortAccess> {
    let device = fs::canonicalize(device).ok()?;
    Some(access(&Computer::this(), &device)).filter(|access| *access != PortAccess::Granted)
}

#[cfg(unix)]
fn refusal(host: &Computer, device: &Path) -> AccessRefusal {
    use std::os::unix::fs::MetadataExt;
    let Ok(there) = fs::metadata(device) else { return AccessRefusal::NoRule };
    // The group must be able to read and write. The group of root does not count.
    let for_group = there.mode() & 0o060 == 0o060;
    match host.group(there.gid()).filter(|(name, _)| for_group && name != "root") {
        None => AccessRefusal::NoRule,
        // The group is not the reason either.
        Some(_) if host.user.groups.contains(&there.gid()) => AccessRefusal::NoRule,
        Some((group, true)) => AccessRefusal::LogInAgain { group },
        Some((group, false)) => AccessRefusal::NotInGroup { group },
    }
}

#[cfg(not(unix))]
fn refusal(_: &Computer, _: &Path) -> AccessRefusal {
    AccessRefusal::NoRule
}

/// The process that has the device open, among the processes that this user may inspect.
fn user_of(host: &Computer, device: &Path) -> Option<PortAccess> {
    let numbered = |path: &Path| path.file_name()?.to_str()?.parse::<u32>().ok();
    host.list("proc").into_iter().find_map(|process| {
        let pid = numbered(&process)?;
        let mut files = fs::read_dir(process.join("fd")).ok()?.flatten();
        files.find(|file| fs::read_link(file.path()).is_ok_and(|target| target == device))?;
        let program =
            fs::read_to_string(process.join("comm")).unwrap_or_default().trim().to_owned();
        Some(PortAccess::InUse { pid, program })
    })
}

impl fmt::Display for PortAccess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Granted => f.write_str("may be used"),
            Self::InUse { pid, program } => {
                write!(f, "in use by {program} (process {pid}): close that first")
            }
            Self::Refused(AccessRefusal::NotInGroup { group }) => write!(
                f,
                "may not be opened: you are not in its group {group}. `sudo usermod -aG {group} $USER`, then log out and in"
            ),
            Self::Refused(AccessRefusal::LogInAgain { group }) => write!(
                f,
                "may not be opened yet: you are in its group {group} since this session began. Log out and in, or run \
                 `newgrp {group}`"
            ),
            Self::Refused(AccessRefusal::NoRule) => f.write_str(
                "may not be opened: no rule of udev gives it to a group. docs/flashing.md has one",
            ),
        }
    }
}

//! The dependencies between the crates: which crate may depend on which, checked with `cargo tree`.
//! A new dependency must be added to `ALLOWED`.

use crate::shell::{self, Done};
use std::collections::BTreeSet;

/// Each crate, and all crates of the workspace on which it may depend, directly or through others.
const ALLOWED: [(&str, &[&str]); 19] = [
    ("files", &[]),
    ("spec", &["files"]),
    ("profile", &["files", "spec"]),
    ("table", &["files", "spec", "profile"]),
    ("reference", &["files", "spec", "profile"]),
    ("plan", &["files", "spec", "profile"]),
    ("model", &["files", "spec"]),
    ("hdl", &["files", "spec"]),
    ("export", &["files", "spec", "hdl"]),
    ("trace", &["files", "spec", "profile"]),
    ("link", &["files", "spec"]),
    ("levels", &["files", "spec", "profile", "model", "hdl", "export", "trace"]),
    ("board", &["files", "spec", "profile", "model", "hdl", "export", "trace", "levels"]),
    ("sweep", &["files", "spec"]),
    ("synthesis", &["files", "spec", "hdl", "export"]),
    ("doctor", &["files", "spec"]),
    (
        "cli",
        &[
            "files",
            "spec",
            "profile",
            "table",
            "reference",
            "plan",
            "model",
            "hdl",
            "export",
            "trace",
            "levels",
            "link",
            "board",
            "sweep",
            "synthesis",
            "doctor",
        ],
    ),
    ("bench", &["files", "spec", "profile", "plan", "model", "hdl", "export", "trace", "levels"]),
    ("xtask", &[]),
];

/// Fails at the first dependency that is not allowed. `model` and `hdl` must never depend on each
/// other, because shared code would make their agreement prove nothing.
pub fn check() -> Done {
    for (name, allowed) in ALLOWED {
        let package = format!("carrystep-{name}");
        let tree = shell::read("cargo", &["tree", "-p", &package, "-e", "normal,build", "--prefix", "none"])?;
        let reached: BTreeSet<&str> = tree
            .lines()
            .filter_map(|line| line.split_whitespace().next()?.strip_prefix("carrystep-"))
            .filter(|reached| *reached != name)
            .collect();
        if let Some(wrong) = reached.iter().find(|reached| !allowed.contains(reached)) {
            return Err(format!(
                "crates/{name} reaches crates/{wrong}: that arrow is not allowed (docs/architecture.md)"
            ));
        }
    }
    shell::say("arrows: one way");
    Ok(())
}

//! The arrows between the crates: who may depend on whom, checked with `cargo tree`.

use crate::shell::{self, Done};
use std::collections::BTreeSet;

/// Each crate and all crates of the house that it may reach, directly or through others.
const ALLOWED: [(&str, &[&str]); 18] = [
    ("spec", &[]),
    ("profile", &["spec"]),
    ("table", &["spec", "profile"]),
    ("reference", &["spec", "profile"]),
    ("plan", &["spec", "profile"]),
    ("model", &["spec"]),
    ("hdl", &["spec"]),
    ("export", &["spec", "hdl"]),
    ("trace", &["spec", "profile"]),
    ("link", &["spec"]),
    ("levels", &["spec", "profile", "model", "hdl", "export", "trace"]),
    ("board", &["spec", "profile", "model", "hdl", "export", "trace", "levels"]),
    ("sweep", &["spec"]),
    ("synthesis", &["spec", "hdl", "export"]),
    ("doctor", &["spec"]),
    (
        "cli",
        &[
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
    ("bench", &["spec", "profile", "plan", "model", "hdl", "export", "trace", "levels"]),
    ("xtask", &[]),
];

/// Fails on the first arrow that is not allowed. `model` and `hdl` must never reach each other: a
/// shared line would make their agreement prove nothing.
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

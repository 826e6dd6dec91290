//! The arrows between the crates: who may depend on whom, checked with `cargo tree`.

use crate::shell::{self, Done};
use std::collections::BTreeSet;

/// Each crate and all crates of the house that it may reach, directly or through others.
const ALLOWED: [(&str, &[&str]); 17] = [
    ("core", &[]),
    ("files", &["core"]),
    ("boards", &["core", "files"]),
    ("profile", &["core"]),
    ("table", &[]),
    ("plan", &["core", "files", "profile"]),
    ("model", &["core"]),
    ("hdl", &["core"]),
    ("verilog", &["core", "files", "boards", "hdl"]),
    ("check", &["core", "files", "profile"]),
    ("link", &["core"]),
    ("sweep", &["core", "files"]),
    ("tools", &["core", "files", "boards", "hdl", "verilog"]),
    ("simulators", &["core", "files", "boards", "profile", "model", "hdl", "verilog", "check", "tools"]),
    (
        "virtual-board",
        &["core", "files", "boards", "profile", "model", "hdl", "verilog", "check", "tools", "simulators"],
    ),
    (
        "cli",
        &[
            "core",
            "files",
            "boards",
            "profile",
            "table",
            "plan",
            "model",
            "hdl",
            "verilog",
            "check",
            "tools",
            "simulators",
            "link",
            "virtual-board",
            "sweep",
        ],
    ),
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

//! The arrows between the crates, read from their `Cargo.toml` files by cargo.
//!
//! Cargo itself refuses a circle. What it cannot know is checked here: `core` depends on no other
//! crate, `model` and `hdl` never reach each other, the files of a folder depend one way, and
//! `docs/architecture.md` shows the crates as they are.

use crate::circles::Modules;
use crate::shell::{self, TaskResult};
use cargo_metadata::{DependencyKind, Metadata, MetadataCommand, Package};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

const PAGE: &str = "docs/architecture.md";
const BEGIN: &str = "<!-- `cargo xtask arrows --write` writes from here ... -->\n";
const END: &str = "<!-- ... to here -->\n";
const PREFIX: &str = "carrystep-";

/// Pairs of crates of which neither may reach the other, directly or through a third: shared code
/// would make their agreement prove nothing.
const STRANGERS: [(&str, &str); 1] = [("model", "hdl")];

/// The crate that depends on no other.
const LOWEST: &str = "core";

/// A crate of `crates/`.
struct Crate {
    /// What is in it, from `Cargo.toml`.
    description: String,
    /// The crates on which it depends directly; those of its tests do not count.
    uses: BTreeSet<String>,
}

/// The workspace, as cargo reads it.
fn workspace() -> Result<Metadata, String> {
    let manifest = shell::root().join("Cargo.toml");
    MetadataCommand::new()
        .manifest_path(manifest)
        .no_deps()
        .exec()
        .map_err(|error| error.to_string())
}

/// All crates by folder.
fn crates() -> Result<BTreeMap<String, Crate>, String> {
    let metadata = workspace()?;
    let crates = metadata.workspace_packages().into_iter().filter_map(|package| {
        let folder = package.manifest_path.parent()?;
        (folder.parent()?.file_name()? == "crates")
            .then(|| of(folder.file_name().unwrap_or_default(), package))
    });
    crates.collect()
}

fn of(folder: &str, package: &Package) -> Result<(String, Crate), String> {
    if package.name.as_str() != format!("{PREFIX}{folder}") {
        return Err(format!("crates/{folder} is called {}, not {PREFIX}{folder}", package.name));
    }
    let description =
        package.description.clone().ok_or_else(|| format!("crates/{folder} has no description"))?;
    let uses = package
        .dependencies
        .iter()
        .filter(|dependency| dependency.kind != DependencyKind::Development)
        .filter_map(|dependency| dependency.name.strip_prefix(PREFIX).map(str::to_owned))
        .collect();
    Ok((folder.to_owned(), Crate { description, uses }))
}

/// All crates that `from` reaches.
fn reached<'a>(crates: &'a BTreeMap<String, Crate>, from: &str) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(next) = open.pop() {
        for used in crates.get(next).into_iter().flat_map(|found| &found.uses) {
            if found.insert(used.as_str()) {
                open.push(used);
            }
        }
    }
    found
}

/// Each crate one row above the highest crate on which it depends.
fn rows(crates: &BTreeMap<String, Crate>) -> Vec<Vec<&str>> {
    fn height(crates: &BTreeMap<String, Crate>, name: &str) -> usize {
        let below = crates.get(name).into_iter().flat_map(|found| &found.uses);
        below.map(|used| height(crates, used) + 1).max().unwrap_or(0)
    }
    let mut rows: Vec<Vec<&str>> = Vec::new();
    for name in crates.keys() {
        let height = height(crates, name);
        rows.resize_with(rows.len().max(height + 1), Vec::new);
        rows[height].push(name);
    }
    rows
}

/// The part of the page that shows the crates: a drawing, then a table.
fn drawn(crates: &BTreeMap<String, Crate>) -> String {
    let mut text = String::from("```text\n");
    for row in rows(crates).iter().rev() {
        let _ = writeln!(text, "{}", row.join("   "));
    }
    text += "```\n\nEach crate depends only on crates of lower rows:\n\n| crate | what is in it | depends on |\n|---|---|---|\n";
    for (name, Crate { description, uses }) in crates {
        let uses: Vec<String> = uses.iter().map(|used| format!("`{used}`")).collect();
        let _ = writeln!(text, "| `{name}` | {description} | {} |", uses.join(", "));
    }
    text
}

/// The page with that part in place of the one that it has.
fn page() -> Result<(String, String), String> {
    let before =
        fs::read_to_string(shell::root().join(PAGE)).map_err(|error| format!("{PAGE}: {error}"))?;
    let parts =
        before.split_once(BEGIN).and_then(|(head, rest)| Some((head, rest.split_once(END)?.1)));
    let (head, tail) =
        parts.ok_or_else(|| format!("{PAGE} has no place for the crates: {BEGIN}"))?;
    let after = format!("{head}{BEGIN}\n{}\n{END}{tail}", drawn(&crates()?));
    Ok((before, after))
}

/// Shows the crates in `docs/architecture.md` as they are.
pub fn write() -> TaskResult {
    let (_, after) = page()?;
    fs::write(shell::root().join(PAGE), after).map_err(|error| format!("{PAGE}: {error}"))
}

/// The circles between files of the same folder, in all targets of all crates.
fn circles() -> Result<BTreeSet<String>, String> {
    let load = |file: &Path| fs::read_to_string(shell::root().join(file)).ok();
    let metadata = workspace()?;
    let mut circles = BTreeSet::new();
    for target in metadata.workspace_packages().into_iter().flat_map(|package| &package.targets) {
        let root = target.src_path.as_std_path();
        let root = root.strip_prefix(shell::root()).unwrap_or(root);
        let modules = Modules::read(root, &load)?;
        circles.extend(modules.circles());
    }
    Ok(circles)
}

/// Fails on an arrow that may not be, on a circle of files, and where the page shows others.
pub fn check() -> TaskResult {
    let crates = crates()?;
    for (one, other) in STRANGERS {
        for (from, to) in [(one, other), (other, one)] {
            if reached(&crates, from).contains(to) {
                return Err(format!(
                    "crates/{from} reaches crates/{to}: these two may not know each other"
                ));
            }
        }
    }
    if let Some(used) = reached(&crates, LOWEST).first() {
        return Err(format!("crates/{LOWEST} depends on crates/{used}: it may depend on none"));
    }
    let circles = circles()?;
    if !circles.is_empty() {
        let circles = circles.into_iter().collect::<Vec<String>>().join("\n");
        return Err(format!("files of the same folder need each other in a circle:\n{circles}"));
    }
    let (before, after) = page()?;
    if before != after {
        return Err(format!(
            "{PAGE} shows other crates: look at the change, then run `cargo xtask arrows --write`"
        ));
    }
    shell::say("arrows: one way");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn house(crates: &[(&str, &[&str])]) -> BTreeMap<String, Crate> {
        let of = |uses: &[&str]| uses.iter().map(|&used| used.to_owned()).collect();
        let one = |(name, uses): &(&str, &[&str])| {
            ((*name).to_owned(), Crate { description: "text".to_owned(), uses: of(uses) })
        };
        crates.iter().map(one).collect()
    }

    #[test]
    fn a_crate_reaches_what_its_dependencies_reach() {
        let house = house(&[
            ("core", &[]),
            ("model", &["middle"]),
            ("middle", &["hdl"]),
            ("hdl", &["core"]),
        ]);
        assert!(reached(&house, "model").contains("hdl"));
        assert!(!reached(&house, "hdl").contains("model"));
    }

    #[test]
    fn a_crate_stands_above_all_that_it_uses() {
        let house = house(&[
            ("core", &[]),
            ("cli", &["core", "plan"]),
            ("plan", &["core"]),
            ("table", &[]),
        ]);
        assert_eq!(rows(&house), [vec!["core", "table"], vec!["plan"], vec!["cli"]]);
    }

    #[test]
    fn the_page_shows_the_crates_as_they_are() {
        check().unwrap();
    }
}

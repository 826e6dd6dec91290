//! Circles between files of the same folder, read from the sources with `syn`.
//!
//! A file depends on another where one of its paths names the other: in a `use`, in code or in a
//! macro. A re-export is followed to the file that it names. A file `part.rs` and its folder
//! `part/` count as one for the files beside them; the files in the folder depend on `part.rs` as
//! they like. Modules and `use`s for tests, marked with `#[cfg(test)]`, do not count.
//!
//! ```text
//! engine.rs   engine/turn.rs   fast.rs       engine -> fast -> engine is a circle;
//! engine/turn.rs names crate::fast           turn -> engine is none, and neither is engine -> turn
//! fast.rs names crate::engine
//! ```

mod paths;

use crate::shell::TaskResult;
use paths::{Paths, is_for_tests};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Component, Path, PathBuf};
use syn::{Attribute, Expr, ExprLit, Item, Lit, Meta};

/// The number of re-exports in a row that are followed.
const DEEPEST: usize = 16;

/// Reads a file; `None` if it cannot.
pub type Load<'a> = &'a dyn Fn(&Path) -> Option<String>;

/// What depends on what, by name, and what makes it so.
type Arrows = BTreeMap<String, BTreeMap<String, String>>;

/// The modules to which a path leads.
type Way = BTreeSet<usize>;

/// A module: a file, or a `mod` with a body within one.
#[derive(Default)]
struct Module {
    parent: Option<usize>,
    children: BTreeMap<String, usize>,
    paths: Paths,
    /// The names of the modules down to its file.
    place: Vec<String>,
    file: PathBuf,
}

/// All modules of one target of a crate; the first one is the root.
pub struct Modules(Vec<Module>);

impl Modules {
    /// Reads the file of a crate's root, and the files of all its modules.
    ///
    /// # Errors
    /// Names a file that cannot be read or that is no Rust.
    pub fn read(root: &Path, load: Load<'_>) -> Result<Self, String> {
        let mut modules = Self(vec![Module { file: root.to_owned(), ..Module::default() }]);
        let folder = root.parent().unwrap_or(root).to_owned();
        modules.file(0, &folder, load)?;
        Ok(modules)
    }

    /// Reads the file of a module. The files of its own modules are in `folder`.
    fn file(&mut self, at: usize, folder: &Path, load: Load<'_>) -> TaskResult {
        let file = self.0[at].file.clone();
        let text = load(&file).ok_or_else(|| format!("{} cannot be read", file.display()))?;
        let wrong = |error| format!("{}: {error}", file.display());
        let syntax = syn::parse_file(&text).map_err(wrong)?;
        self.items(at, &syntax.items, folder, load)
    }

    fn items(&mut self, at: usize, items: &[Item], folder: &Path, load: Load<'_>) -> TaskResult {
        for item in items {
            let Item::Mod(module) = item else {
                self.0[at].paths.read(item);
                continue;
            };
            if is_for_tests(&module.attrs) {
                continue;
            }
            let name = module.ident.to_string();
            let (mut place, mut file) = (self.0[at].place.clone(), self.0[at].file.clone());
            let mut inner = folder.join(&name);
            if module.content.is_none() {
                place.push(name.clone());
                let beside = file.parent().unwrap_or(folder).to_owned();
                file = folder.join(format!("{name}.rs"));
                if let Some(given) = given_path(&module.attrs) {
                    file = plain(&beside.join(given));
                    inner = file.parent().unwrap_or(folder).to_owned();
                } else if load(&file).is_none() {
                    file = inner.join("mod.rs");
                }
            }
            self.0.push(Module { parent: Some(at), place, file, ..Module::default() });
            let new = self.0.len() - 1;
            self.0[at].children.insert(name, new);
            match &module.content {
                Some((_, items)) => self.items(new, items, &inner, load)?,
                None => self.file(new, &inner, load)?,
            }
        }
        Ok(())
    }

    /// The modules through which a path leads that module `at` names. The last of them is in
    /// `Some` if the path names a module and not something in it.
    fn follow(&self, mut at: usize, path: &[String], depth: usize, way: &mut Way) -> Option<usize> {
        for name in path {
            at = match name.as_str() {
                "crate" => 0,
                "self" => at,
                "super" => self.0[at].parent?,
                name => self.named_in(at, name, depth.checked_sub(1)?, way)?,
            };
            way.insert(at);
        }
        Some(at)
    }

    /// The module of this name in module `at`. If the name stands for something else, only the
    /// modules on the way to it are noted.
    fn named_in(&self, at: usize, name: &str, depth: usize, way: &mut Way) -> Option<usize> {
        let module = &self.0[at];
        if let Some(&child) = module.children.get(name) {
            return Some(child);
        }
        let mut found = None;
        for (own, path) in &module.paths.imports {
            if own == name && path.first() != Some(own) {
                found = self.follow(at, path, depth, way).or(found);
            }
        }
        module.paths.globs.iter().fold(found, |found, glob| {
            let through = || {
                let target = self.follow(at, glob, depth, &mut BTreeSet::new())?;
                self.named_in(target, name, depth.checked_sub(1)?, way)
            };
            found.or_else(through)
        })
    }

    /// What depends on what between siblings: by folder, then by name, with the file and the path
    /// that make it so.
    fn arrows(&self) -> BTreeMap<Vec<String>, Arrows> {
        let mut arrows: BTreeMap<Vec<String>, Arrows> = BTreeMap::new();
        for (at, module) in self.0.iter().enumerate() {
            // Where several paths lead to a file, the longest is the best reason.
            let mut named: Vec<&Vec<String>> = module.paths.named.iter().collect();
            named.sort_by_key(|path| std::cmp::Reverse(path.len()));
            for path in named {
                let mut way = BTreeSet::new();
                self.follow(at, path, DEEPEST, &mut way);
                for other in way {
                    let (from, to) = (&module.place, &self.0[other].place);
                    let shared = from.iter().zip(to).take_while(|(from, to)| from == to).count();
                    if let (Some(one), Some(other)) = (from.get(shared), to.get(shared)) {
                        let why = format!("{} names {}", module.file.display(), path.join("::"));
                        let folder = arrows.entry(from[..shared].to_vec()).or_default();
                        let below = folder.entry(one.clone()).or_default();
                        below.entry(other.clone()).or_insert(why);
                    }
                }
            }
        }
        arrows
    }

    /// The circles between files of the same folder, each as a text that names its files. Where
    /// circles share files, the shortest is given.
    pub fn circles(&self) -> Vec<String> {
        let mut texts = Vec::new();
        for (folder, arrows) in self.arrows() {
            let circles = arrows.keys().filter_map(|name| circle(&arrows, name));
            let mut circles: Vec<Vec<&str>> = circles.collect();
            circles.sort_by_key(Vec::len);
            let mut told = BTreeSet::new();
            for circle in circles {
                if circle.iter().any(|name| told.contains(name)) {
                    continue;
                }
                told.extend(circle.iter().copied());
                let next = circle.iter().cycle().skip(1);
                let reasons = circle.iter().zip(next).map(|(from, to)| &*arrows[*from][*to]);
                let reasons = reasons.collect::<Vec<&str>>().join("; ");
                let root = self.0[0].file.parent().unwrap_or(&self.0[0].file);
                let folder = folder.iter().fold(root.to_owned(), |folder, name| folder.join(name));
                let names = circle.join(" -> ");
                texts.push(format!("{}: {names} -> {}: {reasons}", folder.display(), circle[0]));
            }
        }
        texts
    }
}

/// The shortest way from a name back to itself, without the return.
fn circle<'a>(arrows: &'a Arrows, start: &'a str) -> Option<Vec<&'a str>> {
    let mut open = VecDeque::from([vec![start]]);
    let mut seen = BTreeSet::new();
    while let Some(way) = open.pop_front() {
        let below = way.last().and_then(|last| arrows.get(*last));
        for next in below.into_iter().flat_map(BTreeMap::keys) {
            if next == start {
                return Some(way);
            }
            if seen.insert(next) {
                open.push_back(way.iter().copied().chain([next.as_str()]).collect());
            }
        }
    }
    None
}

/// The path in `#[path = "..."]`.
fn given_path(attributes: &[Attribute]) -> Option<String> {
    attributes.iter().find_map(|attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("path") => match &pair.value {
            Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) => Some(text.value()),
            _ => None,
        },
        _ => None,
    })
}

/// A path without `..`.
fn plain(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |plain, part| match part {
        Component::ParentDir => plain.parent().map_or_else(|| plain.clone(), Path::to_owned),
        part => plain.join(part),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circles(files: &[(&str, &str)]) -> Vec<String> {
        let files = files.iter().map(|(file, text)| (Path::new(file), *text));
        let files: BTreeMap<&Path, &str> = files.collect();
        let load = |path: &Path| files.get(path).map(|&text| text.to_owned());
        Modules::read(Path::new("src/lib.rs"), &load).unwrap().circles()
    }

    #[test]
    fn two_files_that_name_each_other_are_a_circle() {
        let found = circles(&[
            ("src/lib.rs", "mod fast; mod slow;"),
            ("src/fast.rs", "use crate::slow::Care; pub struct Leap(Care);"),
            ("src/slow.rs", "pub struct Care; fn pace() { super::fast::leap(); }"),
        ]);
        let whole = "src: fast -> slow -> fast: src/fast.rs names crate::slow::Care; \
                     src/slow.rs names super::fast::leap";
        assert_eq!(found, [whole]);
    }

    #[test]
    fn one_way_is_no_circle_and_neither_are_tests_and_the_parent() {
        let found = circles(&[
            ("src/lib.rs", "mod fast; mod slow; pub use fast::Leap;"),
            ("src/fast.rs", "mod leap; pub use leap::Leap; const HIGH: u8 = 1;"),
            ("src/fast/leap.rs", "use super::HIGH; use crate::slow::Care; pub struct Leap(Care);"),
            ("src/slow.rs", "pub struct Care; #[cfg(test)] mod tests { use crate::fast::Leap; }"),
        ]);
        assert!(found.is_empty(), "{found:?}");
    }

    /// The folder `fast/` counts as `fast.rs`, and `crate::Care` as the file from which it comes.
    #[test]
    fn circle_through_a_folder_a_re_export_and_a_macro_is_found() {
        let found = circles(&[
            ("src/lib.rs", "mod fast; mod slow; pub use slow::*;"),
            ("src/fast.rs", "mod leap;"),
            ("src/fast/leap.rs", "use crate::Care; pub struct Leap(Care);"),
            ("src/slow.rs", "mod care; pub use care::Care;"),
            ("src/slow/care.rs", "pub struct Care; fn f() { assert!(crate::fast::ONE) }"),
        ]);
        assert_eq!(found.len(), 1, "{found:?}");
        let begin =
            "src: fast -> slow -> fast: src/fast/leap.rs names crate::Care; src/slow/care.rs";
        assert!(found[0].starts_with(begin), "{found:?}");
    }

    #[test]
    fn circle_within_a_folder_names_the_folder() {
        let found = circles(&[
            ("src/lib.rs", "mod fast;"),
            ("src/fast.rs", "mod one; mod two; mod three; use one::One;"),
            ("src/fast/one.rs", "use super::two; pub struct One(two::Two);"),
            ("src/fast/two.rs", "pub struct Two(crate::fast::three::Three);"),
            ("src/fast/three.rs", "pub struct Three; mod inner { use super::super::One; }"),
        ]);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with("src/fast: one -> two -> three -> one: "), "{found:?}");
    }

    #[test]
    fn missing_file_is_named() {
        let error = Modules::read(Path::new("src/lib.rs"), &|_: &Path| None).err();
        assert_eq!(error.as_deref(), Some("src/lib.rs cannot be read"));
    }
}

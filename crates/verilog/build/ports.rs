//! Reads the structs of the Rust-HDL modules: the doc comment of each port, and the type of each
//! part. The sources are formatted by rustfmt, so that each field begins on a line of its own.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

/// A struct with ports.
#[derive(Default)]
struct Struct {
    /// Name and doc comment of each port.
    ports: Vec<(String, String)>,
    /// Name and type of each other field.
    parts: Vec<(String, String)>,
}

/// All structs with ports under `folder`, as the Rust expression of a list.
///
/// # Errors
/// If a file cannot be read, or if two structs with ports have the same name.
pub fn table(folder: &Path) -> io::Result<String> {
    let mut structs = BTreeMap::new();
    read_folder(folder, &mut structs)?;
    let mut text = "&[\n".to_owned();
    for (name, Struct { ports, parts }) in &structs {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "    Described {{ kind: {name:?}, ports: &{ports:?}, parts: &{parts:?} }},"
        );
    }
    Ok(text + "]\n")
}

fn read_folder(folder: &Path, structs: &mut BTreeMap<String, Struct>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            read_folder(&path, structs)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            for (name, found) in read(&fs::read_to_string(&path)?) {
                if structs.insert(name.clone(), found).is_some() {
                    let what = format!("{}: a second struct {name} with ports", path.display());
                    return Err(io::Error::other(what));
                }
            }
        }
    }
    Ok(())
}

/// The structs with ports in the text of a file.
fn read(text: &str) -> Vec<(String, Struct)> {
    let mut structs = Vec::new();
    let mut open: Option<(String, Struct)> = None;
    let mut doc: Vec<&str> = Vec::new();
    for line in text.lines() {
        if let Some(begun) = begins(line) {
            open = Some((begun.to_owned(), Struct::default()));
        } else if line == "}" {
            structs.extend(open.take().filter(|(_, found)| !found.ports.is_empty()));
        } else if let Some(more) = line.trim_start().strip_prefix("///") {
            doc.push(more.trim());
            continue;
        } else if let (Some((_, found)), Some((name, kind))) = (&mut open, field(line)) {
            match is_port(kind) {
                true => found.ports.push((name.to_owned(), without_links(&doc.join(" ")))),
                false => found.parts.push((name.to_owned(), element(kind).to_owned())),
            }
        }
        doc.clear();
    }
    structs
}

/// The name of the struct that begins on this line.
fn begins(line: &str) -> Option<&str> {
    let line = line.strip_prefix("pub ").unwrap_or(line);
    let name = line.strip_prefix("struct ")?.strip_suffix('{')?;
    name.split(['<', ' ']).next()
}

/// Name and type of the field that begins on this line.
fn field(line: &str) -> Option<(&str, &str)> {
    let line = line.strip_prefix("    ").filter(|line| !line.starts_with([' ', '/', '#']))?;
    let line = line.strip_prefix("pub ").or(line.strip_prefix("pub(crate) ")).unwrap_or(line);
    line.split_once(": ")
}

/// What the type of an array begins with.
const ARRAYS: [&str; 4] = ["PerAxis<", "PerLane<", "Optional<", "["];

/// From a type on, the type of its elements if it is an array.
fn elements(kind: &str) -> &str {
    ARRAYS.iter().fold(kind, |kind, begin| kind.trim_start_matches(begin))
}

fn is_port(kind: &str) -> bool {
    let kind = elements(kind);
    kind.starts_with("Input<") || kind.starts_with("Signal<Out,")
}

/// The type of the elements of an array, or the type itself, without its arguments.
fn element(kind: &str) -> &str {
    let kind = elements(kind);
    kind.split(['<', ',', ';', '>']).next().unwrap_or(kind).trim()
}

/// A doc comment without its links: [`super::turn`] becomes `turn`.
fn without_links(doc: &str) -> String {
    let mut text = String::new();
    let mut rest = doc;
    while let Some((before, link)) = rest.split_once("[`") {
        let Some((path, after)) = link.split_once("`]") else { break };
        let name = path.rsplit(['@', ':']).next().unwrap_or(path);
        text.push_str(&format!("{before}`{name}`"));
        rest = match after.strip_prefix('(').and_then(|target| target.split_once(')')) {
            Some((_, after)) => after,
            None => after,
        };
    }
    text + rest
}

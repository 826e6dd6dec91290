//! yosys' own models of cells: those that a design uses and no others, for all of them take yosys a minute.

use crate::SynthesisError;
use crate::tool::YOSYS;
use regex::Regex;
use std::collections::BTreeSet;

/// The models of a vendor's cells.
pub(crate) struct Library {
    /// Where yosys keeps them, seen from the folder that it is in.
    file: &'static str,
    /// What all its cells' names begin with.
    cells: &'static str,
    /// What goes before them.
    head: &'static str,
}

pub(crate) const ICE40: Library = Library {
    file: "../share/yosys/ice40/cells_sim.v",
    cells: r"\bSB_\w+",
    head: "`define NO_ICE40_DEFAULT_ASSIGNMENTS\n",
};

pub(crate) const XILINX: Library =
    Library { file: "../share/yosys/xilinx/cells_sim.v", cells: r"\b[A-Z][A-Z0-9_]+\b", head: "" };

/// A design for an iCE40, and before it the models of its cells.
pub(crate) fn with_models(verilog: &str) -> Result<String, SynthesisError> {
    Ok(format!("{}{verilog}", models(&ICE40, verilog)?))
}

/// The models of all cells in a design that the library has.
pub(crate) fn models(library: &Library, verilog: &str) -> Result<String, SynthesisError> {
    let known = text(library)?;
    let (head, _) = known.split_once("\nmodule ").ok_or_else(|| unread("a module in its models".to_owned()))?;
    let mut text = format!("{}{head}\n", library.head);
    let cell = pattern(library.cells);
    for name in cell.find_iter(verilog).map(|found| found.as_str()).collect::<BTreeSet<_>>() {
        // Names of cells are parts of names of wires too: those are no modules.
        let begin = [" (", "("].iter().find_map(|ports| known.find(&format!("\nmodule {name}{ports}")));
        let Some(begin) = begin else { continue };
        let end = known[begin..].find("\nendmodule").ok_or_else(|| unread(format!("the end of {name}")))?;
        text += &known[begin..begin + end];
        text += "\nendmodule\n";
    }
    Ok(text)
}

fn text(library: &Library) -> Result<String, SynthesisError> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folder = std::env::split_paths(&path).find(|folder| folder.join(YOSYS.name).is_file());
    let file = folder.unwrap_or_default().join(library.file);
    let context = || format!("cannot read yosys' models, {}", file.display());
    std::fs::read_to_string(&file).map_err(|source| SynthesisError::Io { context: context(), source })
}

fn unread(what: String) -> SynthesisError {
    SynthesisError::Unread { tool: YOSYS.name, what }
}

/// A pattern of this crate's own.
///
/// # Panics
/// Where it is none: a bug that the first run shows.
pub(crate) fn pattern(text: &str) -> Regex {
    Regex::new(text).expect("a fine pattern")
}

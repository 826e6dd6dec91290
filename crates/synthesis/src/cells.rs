//! yosys' own models of iCE40 cells: those that a design uses and no others, for all of them take yosys a minute.

use crate::SynthesisError;
use crate::tool::YOSYS;
use regex::Regex;
use std::collections::BTreeSet;

/// Where yosys keeps them, seen from the folder that it is in.
const MODELS: &str = "../share/yosys/ice40/cells_sim.v";

/// A design, and before it the models of its cells.
pub(crate) fn with_models(verilog: &str) -> Result<String, SynthesisError> {
    Ok(format!("{}{verilog}", models(verilog)?))
}

/// The models of all cells in a design.
pub(crate) fn models(verilog: &str) -> Result<String, SynthesisError> {
    let library = library()?;
    let (head, _) = library.split_once("\nmodule ").ok_or_else(|| unread("a module in its models".to_owned()))?;
    let mut text = format!("`define NO_ICE40_DEFAULT_ASSIGNMENTS\n{head}\n");
    let cell = pattern(r"\bSB_\w+");
    for name in cell.find_iter(verilog).map(|found| found.as_str()).collect::<BTreeSet<_>>() {
        // Names of cells are parts of names of wires too: those are no modules.
        let Some(begin) = library.find(&format!("\nmodule {name} (")) else { continue };
        let end = library[begin..].find("\nendmodule").ok_or_else(|| unread(format!("the end of {name}")))?;
        text += &library[begin..begin + end];
        text += "\nendmodule\n";
    }
    Ok(text)
}

fn library() -> Result<String, SynthesisError> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folder = std::env::split_paths(&path).find(|folder| folder.join(YOSYS.name).is_file());
    let file = folder.unwrap_or_default().join(MODELS);
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

//! Extracts yosys' models of those cells that a design uses. With the models of all cells yosys
//! would need a minute.

use crate::SynthesisError;
use crate::tool::YOSYS;
use regex::Regex;
use std::collections::BTreeSet;
use std::path::Path;

/// The models of a vendor's cells.
pub(crate) struct Library {
    /// File of the models, relative to yosys' data directory.
    file: &'static str,
    /// Prefix of the names of all these cells.
    cells: &'static str,
    /// Text that must precede the models.
    head: &'static str,
}

pub(crate) const ICE40: Library = Library {
    file: "../share/yosys/ice40/cells_sim.v",
    cells: r"\bSB_\w+",
    head: "`define NO_ICE40_DEFAULT_ASSIGNMENTS\n",
};

pub(crate) const XILINX: Library =
    Library { file: "../share/yosys/xilinx/cells_sim.v", cells: r"\b[A-Z][A-Z0-9_]+\b", head: "" };

pub(crate) const ECP5: Library =
    Library { file: "../share/yosys/ecp5/cells_sim.v", cells: r"\b[A-Z][A-Z0-9_]+\b", head: "" };

pub(crate) const GOWIN: Library =
    Library { file: "../share/yosys/gowin/cells_sim.v", cells: r"\b[A-Z][A-Z0-9_]+\b", head: "" };

/// The 64 parameters of a block RAM's first contents, for a model of it in Verilog.
pub(crate) struct FirstContents {
    /// Their declarations.
    pub(crate) declared: String,
    /// Their names, the last one first, as a concatenation needs them.
    pub(crate) all: String,
}

impl FirstContents {
    /// Parameters whose names begin so, with so many bits each.
    pub(crate) fn of(begin: &str, bits: u32) -> Self {
        let names: Vec<String> = (0..64).map(|number| format!("{begin}{number:02X}")).collect();
        let declare = |name: &String| format!("parameter [{}:0] {name} = 0", bits - 1);
        let declared: Vec<String> = names.iter().map(declare).collect();
        let all: Vec<String> = names.into_iter().rev().collect();
        Self { declared: declared.join(", "), all: all.join(", ") }
    }
}

/// A design for an iCE40, preceded by the models of its cells.
pub(crate) fn with_models(verilog: &str) -> Result<String, SynthesisError> {
    Ok(format!("{}{verilog}", models(&ICE40, verilog)?))
}

/// The models of those cells of a design that the library has.
pub(crate) fn models(library: &Library, verilog: &str) -> Result<String, SynthesisError> {
    let known = text(library)?;
    let (head, _) =
        known.split_once("\nmodule ").ok_or_else(|| unread("a module in its models".to_owned()))?;
    let mut text = format!("{}{head}\n", library.head);
    let cell = pattern(library.cells);
    for name in cell.find_iter(verilog).map(|found| found.as_str()).collect::<BTreeSet<_>>() {
        // The names of cells also occur within the names of wires; only those of modules count.
        let begin =
            [" (", "("].iter().find_map(|ports| known.find(&format!("\nmodule {name}{ports}")));
        let Some(begin) = begin else { continue };
        let end = known[begin..]
            .find("\nendmodule")
            .ok_or_else(|| unread(format!("the end of {name}")))?;
        text += &known[begin..begin + end];
        text += "\nendmodule\n";
    }
    Ok(text)
}

/// The kinds of cells in the output of yosys' `stat`, each with its number, which comes first from
/// yosys 0.59 on.
pub(crate) fn counted(stat: &str) -> impl Iterator<Item = (&str, u32)> {
    stat.lines().filter_map(|line| {
        let mut words = line.split_whitespace();
        let (one, other) = (words.next()?, words.next()?);
        let named = match (one.parse(), other.parse()) {
            (Err(_), Ok(number)) => (one, number),
            (Ok(number), Err(_)) => (other, number),
            _ => return None,
        };
        words.next().is_none().then_some(named)
    })
}

fn text(library: &Library) -> Result<String, SynthesisError> {
    let yosys = which::which_global(YOSYS.name).ok();
    let file = yosys.as_deref().and_then(Path::parent).unwrap_or(Path::new("")).join(library.file);
    let context = || format!("cannot read yosys' models, {}", file.display());
    std::fs::read_to_string(&file)
        .map_err(|source| SynthesisError::Io { context: context(), source })
}

fn unread(what: String) -> SynthesisError {
    SynthesisError::Unread { tool: YOSYS.name, what }
}

/// Compiles a pattern that this crate defines.
///
/// # Panics
/// If the pattern is invalid, which is a bug that the first run shows.
pub(crate) fn pattern(text: &str) -> Regex {
    Regex::new(text).expect("a fine pattern")
}

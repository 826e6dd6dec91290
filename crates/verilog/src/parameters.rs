//! The parameters of Verilog modules, which an instance may override, and how a module passes them
//! on to its children.
//!
//! ```text
//! engine #(STEP_HIGH_0, STEP_HIGH_1, ...)       one parameter per axis, with the axis' number
//!   pulser pulser_0 #(.STEP_HIGH(STEP_HIGH_0))  each instance receives that of its own axis
//!   edge_latch edge_latch_0 #(.LATCH_LOW(LATCH_LOW_1))  latches from 1 on
//!   supervisor supervisor #(.ROUND_TICKS(ROUND_TICKS))  not per axis: the same name
//! ```
//!
//! A module has the parameters that its own constants use, and those of its children.

use crate::ExportError;
use crate::names::split_index;
use crate::netlist::Module;
use carrystep_hdl::parameters::{Described, PARAMETERS, described};
use carrystep_hdl::primitives::formula::{Note, ParameterValue};

/// The parameters of a module with their values in this build, in the order of [`PARAMETERS`].
///
/// # Errors
/// [`ExportError`] if a parameter has two different values in this module.
pub(crate) fn of(module: &Module) -> Result<Vec<ParameterValue>, ExportError> {
    let mut all: Vec<ParameterValue> = Vec::new();
    let atoms = module.atoms.iter().filter_map(|atom| atom.note.as_ref());
    let registers = module.registers.iter().filter_map(|register| register.note.as_ref());
    let notes: Vec<&Note> = atoms.chain(registers).collect();
    let own = notes.into_iter().flat_map(|note| note.given.clone()).collect();
    let mut lists = vec![own];
    for child in &module.children {
        let mut given = of(child)?;
        for one in &mut given {
            one.name = in_parent(&child.instance, &one.name);
        }
        lists.push(given);
    }
    for one in lists.into_iter().flatten() {
        match all.iter().find(|known| known.name == one.name) {
            None => all.push(one),
            Some(known) if *known == one => {}
            Some(known) => {
                let what = format!(
                    "the parameter {} as {} and as {}",
                    one.name, known.literal, one.literal
                );
                return Err(ExportError::unsupported(&module.instance, what));
            }
        }
    }
    all.sort_by_key(|one| place(&one.name));
    Ok(all)
}

/// The name that the parameter of a child has in its parent.
pub(crate) fn in_parent(instance: &str, name: &str) -> String {
    match (split_index(instance).1, described(name)) {
        (Some(index), Some((known, None))) if known.per_axis => format!("{name}_{index}"),
        // Latch 0 is a part of its own, and an array contains the latches from 1 on.
        (Some(index), Some((known, None)))
            if known.per_latch && instance.starts_with("edge_latch") =>
        {
            format!("{name}_{}", index + 1)
        }
        _ => name.to_owned(),
    }
}

/// The declarations of the parameters in the head of a module. A comment that describes a parameter
/// precedes the first one of its kind. A parameter of 0 bits is a string and is declared without a
/// range.
pub(crate) fn head(parameters: &[ParameterValue]) -> Vec<String> {
    let mut lines = Vec::new();
    let mut before: Option<&Described> = None;
    for (index, one) in parameters.iter().enumerate() {
        let known = described(&one.name).map(|(known, _)| known);
        if let Some(known) = known.filter(|known| before != Some(known)) {
            lines.push(format!(
                "// {}{}; {}",
                known.what[..1].to_uppercase(),
                &known.what[1..],
                known.range
            ));
        }
        before = known;
        let range = if one.bits == 0 { String::new() } else { format!("[{}:0] ", one.bits - 1) };
        let comma = if index + 1 < parameters.len() { "," } else { "" };
        lines.push(format!("parameter {range}{} = {}{comma}", one.name, one.literal));
    }
    lines
}

/// The overrides of an instance, `#(.NAME(VALUE), ...)` with one parameter per line, or one space
/// if there are none.
pub(crate) fn overrides(parameters: &[ParameterValue]) -> String {
    if parameters.is_empty() {
        return " ".to_owned();
    }
    let each = parameters.iter().map(|one| format!("        .{}({})", one.name, one.literal));
    format!(" #(\n{}\n    ) ", each.collect::<Vec<_>>().join(",\n"))
}

/// The Verilog functions that the constants of a module use; `texts` are their expressions.
pub(crate) fn functions(texts: &[&str]) -> Vec<String> {
    let is_used =
        |width: &usize| texts.iter().any(|text| text.contains(&format!("used_bits_{width}(")));
    (1..=64).filter(is_used).flat_map(used_bits).collect()
}

/// The Verilog function that sets all bits below the highest bit that is 1.
fn used_bits(width: usize) -> Vec<String> {
    let top = width - 1;
    let name = format!("used_bits_{width}");
    let mut lines = vec![
        "// A mask of the bits that a counter from 0 to `greatest` uses.".to_owned(),
        format!("function [{top}:0] {name}(input [{top}:0] greatest);"),
        "    begin".to_owned(),
        format!("        {name} = greatest;"),
    ];
    let shifts = (0..).map(|power| 1_usize << power).take_while(|by| *by < width);
    lines.extend(shifts.map(|by| format!("        {name} = {name} | ({name} >> {by});")));
    lines.extend(["    end".to_owned(), "endfunction".to_owned()]);
    lines
}

/// The sort key of a parameter: its index in [`PARAMETERS`], and its axis.
fn place(name: &str) -> (usize, Option<usize>) {
    match described(name) {
        Some((known, axis)) => {
            (PARAMETERS.iter().position(|other| other == known).unwrap_or(PARAMETERS.len()), axis)
        }
        None => (PARAMETERS.len(), None),
    }
}

impl Module {
    /// The same module without the values of its parameters. Two modules that then have the same
    /// text differ only in these values, and the export writes them once.
    pub(crate) fn without_values(&self) -> Self {
        let mut module = self.clone();
        let atoms = module.atoms.iter_mut().filter_map(|atom| atom.note.as_mut());
        let registers = module.registers.iter_mut().filter_map(|register| register.note.as_mut());
        for given in atoms.chain(registers).flat_map(|note| &mut note.given) {
            given.literal.clear();
        }
        module.children = module.children.iter().map(Self::without_values).collect();
        module
    }
}

//! The parameters of modules: which numbers whoever instantiates a module may override, and how they are passed down.
//!
//! ```text
//! engine #(STEP_HIGH_0, STEP_HIGH_1, ...)     of each axis, with its number
//!   pulser pulser_0 #(.STEP_HIGH(STEP_HIGH_0))  in an array of instances that of the instance's axis
//! ```
//!
//! A module has those parameters that its constants name, and those of its children.

use crate::ExportError;
use crate::names::split_index;
use crate::netlist::Module;
use carrystep_hdl::parameters::{Described, PARAMETERS, described};
use carrystep_hdl::primitives::formula::{Note, ParameterValue};

/// The parameters of a module with the values that they have in this build, in the order of the table.
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

/// The name that a child's parameter has in its parent.
pub(crate) fn in_parent(instance: &str, name: &str) -> String {
    match (split_index(instance).1, described(name)) {
        (Some(index), Some((known, None))) if known.per_axis => format!("{name}_{index}"),
        _ => name.to_owned(),
    }
}

/// The lines of a module's head. What a parameter is stands before the first one of its kind.
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

/// The overrides of an instance, `#(.NAME(VALUE), ...)` with a space on each side; a space if there are none.
pub(crate) fn overrides(parameters: &[ParameterValue]) -> String {
    if parameters.is_empty() {
        return " ".to_owned();
    }
    let each = parameters.iter().map(|one| format!("        .{}({})", one.name, one.literal));
    format!(" #(\n{}\n    ) ", each.collect::<Vec<_>>().join(",\n"))
}

/// Functions for the constants in a module whose texts these are.
pub(crate) fn functions(texts: &[&str]) -> Vec<String> {
    let is_used =
        |width: &usize| texts.iter().any(|text| text.contains(&format!("used_bits_{width}(")));
    (1..=64).filter(is_used).flat_map(used_bits).collect()
}

/// The function that sets all bits below the highest one that is set.
fn used_bits(width: usize) -> Vec<String> {
    let top = width - 1;
    let name = format!("used_bits_{width}");
    let mut lines = vec![
        "// All bits of a counter that goes up to `greatest`.".to_owned(),
        format!("function [{top}:0] {name}(input [{top}:0] greatest);"),
        "    begin".to_owned(),
        format!("        {name} = greatest;"),
    ];
    let shifts = (0..).map(|power| 1_usize << power).take_while(|by| *by < width);
    lines.extend(shifts.map(|by| format!("        {name} = {name} | ({name} >> {by});")));
    lines.extend(["    end".to_owned(), "endfunction".to_owned()]);
    lines
}

/// Where a parameter stands in a list: its place in the table, and its axis.
fn place(name: &str) -> (usize, Option<usize>) {
    match described(name) {
        Some((known, axis)) => {
            (PARAMETERS.iter().position(|other| other == known).unwrap_or(PARAMETERS.len()), axis)
        }
        None => (PARAMETERS.len(), None),
    }
}

impl Module {
    /// The same without the values of its parameters: two that are equal then have one text.
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

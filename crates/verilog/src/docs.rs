//! Gives each port of the netlist the doc comment that it has in Rust.
//!
//! The build script reads the comments from the sources of `hdl` (`build/ports.rs`). A part of a
//! module is found there by the name of its field, which is also the name of its instance.

use crate::ExportError;
use crate::names::split_index;
use crate::netlist::Module;

/// A struct with ports.
struct Described {
    /// Its name.
    kind: &'static str,
    /// Name and comment of each port.
    ports: &'static [(&'static str, &'static str)],
    /// Name and type of each other field.
    parts: &'static [(&'static str, &'static str)],
}

const STRUCTS: &[Described] = include!(concat!(env!("OUT_DIR"), "/ports.rs"));

/// Describes the ports of a module and of its children; `kind` is the name of the module's struct.
///
/// # Errors
/// [`ExportError::Undescribed`] if a port has no comment.
pub(crate) fn describe(module: &mut Module, kind: &str) -> Result<(), ExportError> {
    let known = STRUCTS
        .iter()
        .find(|known| known.kind == kind)
        .ok_or_else(|| ExportError::undescribed(&module.instance, format!("the struct {kind}")))?;
    let find = |list: &[(&str, &'static str)], name: &str| {
        let found = list.iter().find(|(other, _)| *other == name);
        found.map(|(_, text)| *text).filter(|text| !text.is_empty())
    };
    for port in module.atoms.iter_mut().filter(|atom| atom.kind.is_parameter()) {
        let name = split_index(&port.name).0;
        port.about = find(known.ports, name);
        if port.about.is_none() {
            return Err(ExportError::undescribed(&module.instance, format!("the port {name}")));
        }
    }
    for child in &mut module.children {
        let kind = find(known.parts, split_index(&child.instance).0).ok_or_else(|| {
            ExportError::undescribed(&child.instance, format!("the part of {kind}"))
        })?;
        describe(child, kind)?;
    }
    Ok(())
}

/// A text as lines of at most `columns` columns, each of which begins with `begin`. A word that is
/// longer than a line has a line of its own.
pub(crate) fn wrapped(text: &str, begin: &str, columns: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= columns => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(format!("{begin}{word}")),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_have_no_links_and_are_wrapped() {
        let adder = STRUCTS.iter().find(|known| known.kind == "Adder").unwrap();
        let (_, beat) = adder.ports.iter().find(|(name, _)| *name == "beat").unwrap();
        assert!(!beat.contains(['[', ']']) && beat.contains("in beat i of a time slot"), "{beat}");
        assert_eq!(wrapped("one two three", "// ", 10), ["// one two", "// three"]);
        assert_eq!(wrapped("a-long-word b", "// ", 5), ["// a-long-word", "// b"]);
    }
}

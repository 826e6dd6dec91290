//! Converts the flat names of Rust-HDL to Verilog: `axis$0$go` becomes `axis_0_go`, the register
//! `left$q` becomes `left`, and an array of ports becomes one vector (an array of one element, one
//! port).

use crate::ExportError;
use crate::netlist::{Module, Wire};
use rust_hdl_core::prelude::AtomKind;
use std::collections::{BTreeMap, BTreeSet};

/// The kind of thing that a name in a kernel denotes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Role {
    /// An input port, a constant, or the output of a child.
    Given,
    /// A local signal or an output port.
    Driven,
    /// The value of a register.
    Value,
    /// The next value of a register.
    Next,
    /// The input of a child.
    ChildInput,
    /// A clock of this module, of a register or of a child.
    Clock,
}

/// The Verilog for a name.
#[derive(Debug, Clone)]
pub(crate) struct Name {
    pub(crate) text: String,
    pub(crate) width: usize,
    pub(crate) role: Role,
}

/// A port of the module in Verilog.
#[derive(Debug, Clone)]
pub(crate) struct Port {
    pub(crate) name: String,
    pub(crate) width: usize,
    pub(crate) output: bool,
    /// Its doc comment in Rust.
    pub(crate) about: Option<&'static str>,
}

/// A constant of the module in Verilog.
#[derive(Debug, Clone)]
pub(crate) struct Constant {
    pub(crate) name: String,
    pub(crate) width: usize,
    pub(crate) text: String,
}

/// All names of a module.
#[derive(Debug, Default)]
pub(crate) struct Names {
    pub(crate) ports: Vec<Port>,
    pub(crate) locals: Vec<String>,
    pub(crate) constants: Vec<Constant>,
    /// Conditions under which the module refuses its parameters, with the error's name.
    pub(crate) refusals: Vec<(String, String)>,
    known: BTreeMap<String, Name>,
}

impl Names {
    pub(crate) fn new(module: &Module) -> Result<Self, ExportError> {
        let mut names = Self::default();
        for atom in &module.atoms {
            let (base, index) = split_index(&atom.name);
            let elements =
                module.atoms.iter().filter(|other| split_index(&other.name).0 == base).count();
            match atom.kind {
                AtomKind::InputParameter | AtomKind::OutputParameter => {
                    let output = atom.kind == AtomKind::OutputParameter;
                    let role = match (atom.is_clock, output) {
                        (true, _) => Role::Clock,
                        (_, true) => Role::Driven,
                        _ => Role::Given,
                    };
                    let text = names.port(atom, index.filter(|_| elements > 1));
                    names.add(&atom.name, text, atom.width, role);
                }
                AtomKind::LocalSignal => {
                    let text = plain(&atom.name);
                    names.locals.push(text.clone());
                    names.add(&atom.name, text, atom.width, Role::Driven);
                }
                AtomKind::Constant => match &atom.note {
                    Some(note) if note.is_refusal && note.given.is_empty() => {}
                    Some(note) if note.is_refusal => {
                        names.refusals.push((plain(&atom.name), note.text.clone()));
                    }
                    note => {
                        let name = plain(&atom.name).to_uppercase();
                        let text = note
                            .as_ref()
                            .map_or_else(|| atom.value.to_string(), |note| note.text.clone());
                        names.constants.push(Constant {
                            name: name.clone(),
                            width: atom.width,
                            text,
                        });
                        names.add(&atom.name, name, atom.width, Role::Given);
                    }
                },
                _ => {
                    return Err(ExportError::unsupported(
                        &module.instance,
                        format!("signal {}", atom.name),
                    ));
                }
            }
        }
        for register in &module.registers {
            let (name, text) = (&register.name, plain(&register.name));
            names.add(&format!("{name}$q"), text.clone(), register.width, Role::Value);
            names.add(&format!("{name}$d"), format!("{text}_next"), register.width, Role::Next);
            names.add(&format!("{name}$clock"), "clock".into(), 1, Role::Clock);
        }
        for child in &module.children {
            for atom in child.atoms.iter().filter(|atom| atom.kind.is_parameter()) {
                let flat = format!("{}${}", child.instance, atom.name);
                let role = match (atom.is_clock, atom.kind) {
                    (true, _) => Role::Clock,
                    (_, AtomKind::InputParameter) => Role::ChildInput,
                    _ => Role::Given,
                };
                names.add(&flat, plain(&flat), atom.width, role);
            }
        }
        names.check(&module.instance)?;
        Ok(names)
    }

    /// What a name in the kernel of `module` denotes.
    pub(crate) fn get(&self, module: &str, flat: &str) -> Result<&Name, ExportError> {
        self.known.get(flat).ok_or_else(|| ExportError::unsupported(module, format!("name {flat}")))
    }

    fn add(&mut self, flat: &str, text: String, width: usize, role: Role) {
        self.known.insert(flat.to_owned(), Name { text, width, role });
    }

    /// Adds a port, or an element to a vector, and returns the text of a reference to it.
    fn port(&mut self, atom: &Wire, index: Option<usize>) -> String {
        let name = plain(split_index(&atom.name).0);
        let Wire { width, about, .. } = *atom;
        let output = atom.kind == AtomKind::OutputParameter;
        let port = Port { name: name.clone(), width, output, about };
        let Some(index) = index else {
            self.ports.push(port);
            return name;
        };
        match self.ports.iter_mut().find(|port| port.name == name) {
            Some(port) => port.width += width,
            None => self.ports.push(port),
        }
        slice(&name, index * width, width)
    }

    /// Checks that no two things have the same name.
    fn check(&self, module: &str) -> Result<(), ExportError> {
        let mut seen = BTreeSet::new();
        let signals =
            self.known.values().filter(|name| name.role != Role::Clock).map(|name| &name.text);
        for text in signals {
            if !seen.insert(text) {
                return Err(ExportError::unsupported(module, format!("two signals called {text}")));
            }
        }
        Ok(())
    }
}

/// A slice of a vector: `name[7]` or `name[31:0]`.
pub(crate) fn slice(name: &str, low: usize, width: usize) -> String {
    if width == 1 { format!("{name}[{low}]") } else { format!("{name}[{}:{low}]", low + width - 1) }
}

/// A flat name with `_` in place of `$`: `axis_0` for `axis$0`.
pub(crate) fn plain(flat: &str) -> String {
    flat.replace('$', "_")
}

/// Splits an array element into name and index: `axis$0` is element 0 of `axis`.
pub(crate) fn split_index(flat: &str) -> (&str, Option<usize>) {
    match flat.rsplit_once('$').map(|(base, index)| (base, index.parse())) {
        Some((base, Ok(index))) => (base, Some(index)),
        _ => (flat, None),
    }
}

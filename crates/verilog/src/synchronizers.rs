//! Finds the synchronizers of the asynchronous inputs of a module, and checks them.
//!
//! ```text
//! pin --> (logic) --> first --> second --> (logic)
//! ```
//!
//! An input is asynchronous if its doc comment says so. From there the netlist is followed, down
//! into children and up again: the pin may reach only data inputs of registers, no output and no
//! memory, and only a second register may read such a register, without logic between them.

use crate::ExportError;
use crate::kernel::{Kernel, Step};
use crate::names::{Name, Names, Role, plain, split_index};
use crate::netlist::Module;
use rust_hdl_core::prelude::{AtomKind, Verilog};
use std::collections::BTreeSet;

/// The two registers that synchronize one or more asynchronous inputs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Synchronizer {
    /// The inputs of the top module.
    pub(crate) pins: Vec<String>,
    /// The instances from the top module to the module of the registers.
    pub(crate) path: Vec<String>,
    /// The usual name of this module without its prefix.
    pub(crate) kind: String,
    pub(crate) first: Flops,
    pub(crate) second: Flops,
}

/// The flip-flops of a register.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Flops {
    pub(crate) name: String,
    pub(crate) width: usize,
}

/// Whether a doc comment says that a port is asynchronous.
fn is_asynchronous(about: Option<&str>) -> bool {
    about.is_some_and(|text| text.to_lowercase().contains("asynchronous"))
}

/// The synchronizers of a described module, in the order of its ports.
///
/// # Errors
/// [`ExportError`] if an asynchronous input reaches something else than a synchronizer.
pub(crate) fn of(top: &Module) -> Result<Vec<Synchronizer>, ExportError> {
    let mut all: Vec<Synchronizer> = Vec::new();
    for port in Names::new(top)?.ports {
        if port.output || !is_asynchronous(port.about) {
            continue;
        }
        let reached = follow(top, &port.name)?;
        let refused = |what: String| {
            let what = format!("the asynchronous input {}, which reaches {what}", port.name);
            ExportError::unsupported(&top.instance, what)
        };
        if let Some(output) = reached.outputs.first() {
            return Err(refused(format!("the output {output}")));
        }
        if reached.synchronizers.is_empty() {
            return Err(refused("no register".to_owned()));
        }
        for found in reached.synchronizers {
            let same = |known: &&mut Synchronizer| {
                (&known.path, &known.first) == (&found.path, &found.first)
            };
            match all.iter_mut().find(same) {
                Some(known) => known.pins.push(port.name.clone()),
                None => all.push(Synchronizer { pins: vec![port.name.clone()], ..found }),
            }
        }
    }
    Ok(all)
}

/// What an input of a module reaches without passing a register.
#[derive(Default)]
struct Reached {
    synchronizers: Vec<Synchronizer>,
    outputs: Vec<String>,
}

fn follow(module: &Module, input: &str) -> Result<Reached, ExportError> {
    let refused = |what: String| {
        let what = format!("the asynchronous input {input}, which reaches {what}");
        ExportError::unsupported(&module.instance, what)
    };
    if let Verilog::Custom(_) = module.code {
        return Err(refused("a memory".to_owned()));
    }
    let names = Names::new(module)?;
    let drives = drives(&Kernel::new(module, &names)?);
    let mut found = Reached::default();
    let mut reached = BTreeSet::new();
    let mut open = vec![input.to_owned()];
    while let Some(signal) = open.pop() {
        if !reached.insert(signal.clone()) {
            continue;
        }
        for Drive { target, .. } in drives.iter().filter(|drive| drive.reads(&signal)) {
            match target.role {
                Role::Next => {
                    let one = synchronizer(module, &drives, base(target)).map_err(&refused)?;
                    if !found.synchronizers.contains(&one) {
                        found.synchronizers.push(one);
                    }
                }
                Role::ChildInput => {
                    let (child, port) = child_port(module, &target.text)
                        .ok_or_else(|| refused(target.text.clone()))?;
                    let below = follow(child, port)?;
                    let instance = plain(&child.instance);
                    open.extend(below.outputs.iter().map(|port| format!("{instance}_{port}")));
                    found.synchronizers.extend(below.synchronizers.into_iter().map(|mut one| {
                        one.path.insert(0, instance.clone());
                        one
                    }));
                }
                _ => open.push(base(target).to_owned()),
            }
        }
        if names.ports.iter().any(|port| port.output && port.name == signal) {
            found.outputs.push(signal);
        }
    }
    Ok(found)
}

/// The synchronizer that begins with a register of a module; otherwise what is wrong with it.
fn synchronizer(module: &Module, drives: &[Drive], next: &str) -> Result<Synchronizer, String> {
    let first = next.trim_end_matches("_next");
    let mut readers = drives.iter().filter(|drive| drive.reads(first));
    let (Some(reader), None) = (readers.next(), readers.next()) else {
        return Err(format!("the register {first}, which not exactly one other register reads"));
    };
    if reader.target.role != Role::Next || reader.texts != [first] {
        return Err(format!("the register {first}, behind which there is logic"));
    }
    let second = reader.target.text.trim_end_matches("_next");
    let flops = |name: &str| {
        let register = module.registers.iter().find(|register| plain(&register.name) == name);
        let width = register.map(|register| register.width);
        width.map(|width| Flops { name: name.to_owned(), width }).ok_or_else(|| name.to_owned())
    };
    Ok(Synchronizer {
        pins: Vec::new(),
        path: Vec::new(),
        kind: split_index(&module.instance).0.to_owned(),
        first: flops(first)?,
        second: flops(second)?,
    })
}

/// The child and its input for which this is the name in the parent.
fn child_port<'a>(module: &'a Module, text: &str) -> Option<(&'a Module, &'a str)> {
    let ports = module.children.iter().flat_map(|child| {
        let inputs = child.atoms.iter().filter(|atom| atom.kind == AtomKind::InputParameter);
        inputs.map(move |atom| (child, atom.name.as_str()))
    });
    ports.into_iter().find(|(child, port)| plain(&format!("{}${port}", child.instance)) == text)
}

/// The name of a signal without the index of a vector's element.
fn base(name: &Name) -> &str {
    name.text.split('[').next().unwrap_or(&name.text)
}

/// An assignment: its target, its value, and the conditions under which it takes place.
struct Drive {
    target: Name,
    texts: Vec<String>,
}

impl Drive {
    fn reads(&self, signal: &str) -> bool {
        self.texts.iter().any(|text| crate::kernel::mentions(text, signal))
    }
}

/// All assignments of a kernel.
fn drives(kernel: &Kernel) -> Vec<Drive> {
    let wires = kernel.wires.iter();
    let mut all: Vec<Drive> = wires
        .map(|(target, value)| Drive { target: target.clone(), texts: vec![value.clone()] })
        .collect();
    for step in kernel.blocks.iter().flatten().chain(&kernel.clocked) {
        collect(step, &[], &mut all);
    }
    all
}

fn collect(step: &Step, tests: &[String], all: &mut Vec<Drive>) {
    match step {
        Step::Assign { target, value } => {
            let texts = [std::slice::from_ref(value), tests].concat();
            all.push(Drive { target: target.clone(), texts });
        }
        Step::If { test, then, otherwise } => {
            let tests = [tests, std::slice::from_ref(test)].concat();
            for step in then.iter().chain(otherwise) {
                collect(step, &tests, all);
            }
        }
    }
}

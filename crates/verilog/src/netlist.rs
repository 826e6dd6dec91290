//! Reads the tree of Rust-HDL blocks as data: the ports, registers, children and kernel of each
//! module.

use crate::ExportError;
use carrystep_hdl::primitives::formula::Note;
use carrystep_hdl::primitives::register::NOTE;
use rust_hdl_core::prelude::{Atom, AtomKind, Block, Probe, Verilog, VerilogLiteral};

/// One instance of a module.
#[derive(Debug, Clone)]
pub(crate) struct Module {
    /// Name of the field in its parent; `axis$0` in an array.
    pub(crate) instance: String,
    pub(crate) atoms: Vec<Wire>,
    pub(crate) registers: Vec<Flop>,
    pub(crate) children: Vec<Module>,
    pub(crate) code: Verilog,
}

/// A port, a local signal or a constant.
#[derive(Debug, Clone)]
pub(crate) struct Wire {
    pub(crate) name: String,
    pub(crate) kind: AtomKind,
    pub(crate) width: usize,
    pub(crate) is_clock: bool,
    /// Value after configuration.
    pub(crate) value: Number,
    /// Of a constant that follows from parameters.
    pub(crate) note: Option<Note>,
    /// The doc comment of a port.
    pub(crate) about: Option<&'static str>,
}

/// A register.
#[derive(Debug, Clone)]
pub(crate) struct Flop {
    pub(crate) name: String,
    pub(crate) width: usize,
    pub(crate) initial: Number,
    /// Of an initial value that follows from parameters.
    pub(crate) note: Option<Note>,
}

/// Width and value of a literal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Number {
    pub(crate) width: usize,
    pub(crate) value: u128,
}

impl Number {
    /// Parses a literal. Rust-HDL provides it only as text, such as `16'h2a`.
    pub(crate) fn new(literal: &VerilogLiteral) -> Option<Self> {
        let text = format!("{literal:x}");
        let (width, digits) = text.split_once("'h")?;
        Some(Self { width: width.parse().ok()?, value: u128::from_str_radix(digits, 16).ok()? })
    }
}

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.width {
            1 => write!(f, "1'b{}", self.value),
            2..=32 if self.value <= 0xffff => write!(f, "{}'d{}", self.width, self.value),
            _ => write!(f, "{}'h{:x}", self.width, self.value),
        }
    }
}

/// Reads a block that Rust-HDL has connected and checked.
pub(crate) fn read(block: &dyn Block) -> Result<Module, ExportError> {
    let mut reader = Reader::default();
    block.accept("top", &mut reader);
    match (reader.top, reader.unreadable) {
        (Some(top), None) => Ok(top),
        (_, name) => Err(ExportError::unsupported("top", name.unwrap_or_default())),
    }
}

#[derive(Default)]
struct Reader {
    open: Vec<Module>,
    top: Option<Module>,
    unreadable: Option<String>,
}

impl Module {
    /// Recognises a register: a block with d, q and clock whose Verilog is given as text.
    fn as_register(&self) -> Option<Flop> {
        let names: Vec<&str> = self.atoms.iter().map(|atom| atom.name.as_str()).collect();
        let Verilog::Custom(text) = &self.code else { return None };
        if names != ["d", "q", "clock"] {
            return None;
        }
        let q = &self.atoms[1];
        let note = text.split_once(NOTE).and_then(|(_, note)| Note::read(note));
        Some(Flop { name: self.instance.clone(), width: q.width, initial: q.value, note })
    }
}

impl Probe for Reader {
    fn visit_start_scope(&mut self, name: &str, node: &dyn Block) {
        self.open.push(Module {
            instance: name.to_owned(),
            atoms: Vec::new(),
            registers: Vec::new(),
            children: Vec::new(),
            code: node.hdl(),
        });
    }

    fn visit_start_namespace(&mut self, name: &str, _node: &dyn Block) {
        self.unreadable = Some(format!("interface {name}"));
    }

    fn visit_atom(&mut self, name: &str, signal: &dyn Atom) {
        let Some(value) = Number::new(&signal.verilog()) else {
            self.unreadable = Some(format!("value of {name}"));
            return;
        };
        if let Some(module) = self.open.last_mut() {
            module.atoms.push(Wire {
                name: name.to_owned(),
                kind: signal.kind(),
                width: signal.bits(),
                is_clock: signal.descriptor().name == "clock",
                value,
                note: Note::read(&signal.descriptor().name),
                about: None,
            });
        }
    }

    fn visit_end_namespace(&mut self, _name: &str, _node: &dyn Block) {}

    fn visit_end_scope(&mut self, _name: &str, _node: &dyn Block) {
        let Some(module) = self.open.pop() else { return };
        let Some(parent) = self.open.last_mut() else {
            self.top = Some(module);
            return;
        };
        match module.as_register() {
            Some(register) => parent.registers.push(register),
            None => parent.children.push(module),
        }
    }
}

//! Writes one module as text: Verilog-2005, ANSI ports, registers with initial values.

use crate::ExportError;
use crate::docs::wrapped;
use crate::kernel::{Kernel, Step};
use crate::names::{Constant, Names, Role, plain};
use crate::netlist::Module;
use crate::parameters;
use carrystep_hdl::primitives::constant::ERROR;
use carrystep_hdl::primitives::formula::ParameterValue;
use rust_hdl_core::prelude::{AtomKind, Verilog};

/// The greatest length of a line of comment.
pub(crate) const COLUMNS: usize = 100;

/// The text of `module` under the name `name`; `kinds` are the module names of its children.
pub(crate) fn module_text(
    module: &Module,
    name: &str,
    kinds: &[String],
) -> Result<String, ExportError> {
    let names = Names::new(module)?;
    if let Verilog::Custom(body) = &module.code {
        return primitive(module, &names, name, body);
    }
    let kernel = Kernel::new(module, &names)?;
    let mut page = Page::default();
    head(&mut page, module, &names, name)?;
    ports(&mut page, &names, &kernel);
    page.close(");");
    page.indent += 1;
    constants(&mut page, module, &names);
    refusals(&mut page, &names);
    declarations(&mut page, module, &names, &kernel)?;
    wires(&mut page, &names, &kernel);
    for block in &kernel.blocks {
        page.gap();
        page.open("always @(*) begin");
        steps(&mut page, block, "=");
        page.close("end");
    }
    for (child, kind) in module.children.iter().zip(kinds) {
        page.gap();
        instance(&mut page, &names, &kernel, child, kind)?;
    }
    clocked(&mut page, &kernel);
    page.close("endmodule");
    Ok(page.text)
}

/// A module that has its own body, such as a memory.
fn primitive(
    module: &Module,
    names: &Names,
    name: &str,
    body: &str,
) -> Result<String, ExportError> {
    let mut page = Page::default();
    head(&mut page, module, names, name)?;
    ports(&mut page, names, &Kernel::default());
    page.close(");");
    page.indent += 1;
    for line in body.lines() {
        if line.is_empty() { page.gap() } else { page.line(line) }
    }
    page.close("endmodule");
    Ok(page.text)
}

/// The beginning of a module, with its parameters if it has any.
fn head(page: &mut Page, module: &Module, names: &Names, name: &str) -> Result<(), ExportError> {
    let parameters = parameters::of(module)?;
    let is_twice = |one: &&ParameterValue| {
        names.constants.iter().any(|own| own.name == one.name && own.text != one.name)
    };
    if let Some(one) = parameters.iter().find(is_twice) {
        let what = format!("a constant with the name of the parameter {}", one.name);
        return Err(ExportError::unsupported(&module.instance, what));
    }
    if parameters.is_empty() {
        page.open(&format!("module {name} ("));
        return Ok(());
    }
    page.open(&format!("module {name} #("));
    for line in parameters::head(&parameters) {
        match line.strip_prefix("// ") {
            Some(comment) => page.comment(comment),
            None => page.line(&line),
        }
    }
    page.close(") (");
    page.indent += 1;
    Ok(())
}

fn ports(page: &mut Page, names: &Names, kernel: &Kernel) {
    for (place, port) in names.ports.iter().enumerate() {
        let kind = match port.output {
            false => "input  wire",
            true if kernel.in_block(&port.name) => "output reg ",
            true => "output wire",
        };
        let comma = if place + 1 < names.ports.len() { "," } else { "" };
        let range = if port.width == 1 { String::new() } else { format!("[{}:0]", port.width - 1) };
        page.comment(port.about.unwrap_or_default());
        page.line(&format!("{kind} {range:>7} {}{comma}", port.name));
    }
}

fn constants(page: &mut Page, module: &Module, names: &Names) {
    let initials = module
        .registers
        .iter()
        .filter_map(|register| register.note.as_ref())
        .map(|note| note.text.as_str());
    let texts: Vec<&str> =
        names.constants.iter().map(|constant| constant.text.as_str()).chain(initials).collect();
    for line in parameters::functions(&texts) {
        page.line(&line);
    }
    for Constant { name, width, text } in &names.constants {
        page.line(&format!("localparam {}{name} = {text};", range(*width)));
    }
}

/// Instantiates a module that does not exist where a parameter is out of range: Verilog-2005 knows
/// no other way to stop the elaboration.
fn refusals(page: &mut Page, names: &Names) {
    if names.refusals.is_empty() {
        return;
    }
    page.gap();
    page.open("generate");
    for (name, condition) in &names.refusals {
        page.open(&format!("if ({condition}) begin : {name}"));
        page.line(&format!("{ERROR}{name} error ();"));
        page.close("end");
    }
    page.close("endgenerate");
}

/// Declares the registers, the signals that combinational blocks write, and the outputs of children
/// that the kernel reads.
fn declarations(
    page: &mut Page,
    module: &Module,
    names: &Names,
    kernel: &Kernel,
) -> Result<(), ExportError> {
    page.gap();
    for register in &module.registers {
        let initial =
            register.note.as_ref().map_or(register.initial.to_string(), |note| note.text.clone());
        page.line(&format!("reg {}{} = {initial};", range(register.width), plain(&register.name)));
    }
    for target in kernel.block_targets() {
        if names.ports.iter().all(|port| port.name != target.text) {
            page.line(&format!("reg {}{};", range(target.width), target.text));
        }
    }
    page.gap();
    for child in &module.children {
        for output in child.atoms.iter().filter(|atom| atom.kind == AtomKind::OutputParameter) {
            let name =
                names.get(&module.instance, &format!("{}${}", child.instance, output.name))?;
            if kernel.reads(&name.text) {
                page.line(&format!("wire {}{};", range(name.width), name.text));
            }
        }
    }
    Ok(())
}

/// Writes the continuous assignments: local signals at their declaration, and then the outputs.
fn wires(page: &mut Page, names: &Names, kernel: &Kernel) {
    let is_local = |text: &str| names.locals.iter().any(|local| local == text);
    let driven = kernel.wires.iter().filter(|(target, _)| target.role == Role::Driven);
    let (locals, mut outputs): (Vec<_>, Vec<_>) =
        driven.partition(|(target, _)| is_local(&target.text));
    page.gap();
    for (target, value) in locals {
        page.line(&format!("wire {}{} = {value};", range(target.width), target.text));
    }
    // Sorts the elements of a vector together, in the order of the ports.
    outputs.sort_by_key(|(target, _)| {
        names.ports.iter().position(|port| target.text.split('[').next() == Some(&port.name))
    });
    page.gap();
    for (target, value) in outputs {
        page.line(&format!("assign {} = {value};", target.text));
    }
}

fn instance(
    page: &mut Page,
    names: &Names,
    kernel: &Kernel,
    child: &Module,
    kind: &str,
) -> Result<(), ExportError> {
    let given = parameters::of(child)?;
    if given.is_empty() {
        page.open(&format!("{kind} {} (", plain(&child.instance)));
    } else {
        page.open(&format!("{kind} #("));
        for (place, one) in given.iter().enumerate() {
            let comma = if place + 1 < given.len() { "," } else { "" };
            page.line(&format!(
                ".{}({}){comma}",
                one.name,
                parameters::in_parent(&child.instance, &one.name)
            ));
        }
        page.close(&format!(") {} (", plain(&child.instance)));
        page.indent += 1;
    }
    let ports = Names::new(child)?.ports;
    for (place, port) in ports.iter().enumerate() {
        let name = names.get(&child.instance, &format!("{}${}", child.instance, port.name))?;
        let wire = match kernel.wire(&name.text) {
            _ if name.role == Role::Clock => "clock",
            Some(value) => value,
            None if port.output && !kernel.reads(&name.text) => "",
            None => &name.text,
        };
        let comma = if place + 1 < ports.len() { "," } else { "" };
        page.line(&format!(".{}({wire}){comma}", port.name));
    }
    page.close(");");
    Ok(())
}

fn clocked(page: &mut Page, kernel: &Kernel) {
    if kernel.clocked.is_empty() {
        return;
    }
    page.gap();
    page.open("always @(posedge clock) begin");
    steps(page, &kernel.clocked, "<=");
    page.close("end");
}

/// Writes statements. In a clocked block, the target of a register is the register's own name.
fn steps(page: &mut Page, list: &[Step], sign: &str) {
    for step in list {
        match step {
            Step::Assign { target, value } => {
                let name =
                    if sign == "<=" { target.text.trim_end_matches("_next") } else { &target.text };
                page.line(&format!("{name} {sign} {value};"));
            }
            Step::If { .. } => conditional(page, step, "", sign),
        }
    }
}

fn conditional(page: &mut Page, step: &Step, before: &str, sign: &str) {
    let Step::If { test, then, otherwise } = step else { return };
    page.open(&format!("{before}if ({test}) begin"));
    steps(page, then, sign);
    page.indent -= 1;
    match otherwise.as_slice() {
        [] => page.line("end"),
        [next @ Step::If { .. }] => conditional(page, next, "end else ", sign),
        rest => {
            page.open("end else begin");
            steps(page, rest, sign);
            page.close("end");
        }
    }
}

/// The range of a vector, `[63:0] `; empty for a single bit.
fn range(width: usize) -> String {
    if width == 1 { String::new() } else { format!("[{}:0] ", width - 1) }
}

/// Lines of text with indentation.
#[derive(Debug, Default)]
struct Page {
    text: String,
    indent: usize,
}

impl Page {
    fn line(&mut self, line: &str) {
        self.text.extend(std::iter::repeat_n("    ", self.indent));
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Adds a comment; nothing if the text is empty.
    fn comment(&mut self, text: &str) {
        for line in wrapped(text, "// ", COLUMNS - 4 * self.indent) {
            self.line(&line);
        }
    }

    fn open(&mut self, line: &str) {
        self.line(line);
        self.indent += 1;
    }

    fn close(&mut self, line: &str) {
        self.indent -= 1;
        self.line(line);
    }

    /// Adds an empty line between paragraphs, never two in a row.
    fn gap(&mut self) {
        if !self.text.ends_with("\n\n") {
            self.text.push('\n');
        }
    }
}

//! One module as text: Verilog-2005, ANSI ports, registers with their initial values.

use crate::ExportError;
use crate::kernel::{Kernel, Step, mentions};
use crate::names::{Names, Role, plain};
use crate::netlist::{Flop, Module};
use std::fmt::Write;

/// Lines with their indent.
#[derive(Debug, Default)]
struct Page {
    text: String,
    indent: usize,
}

impl Page {
    fn line(&mut self, line: &str) {
        if !line.is_empty() {
            self.text.extend(std::iter::repeat_n("    ", self.indent));
        }
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn open(&mut self, line: &str) {
        self.line(line);
        self.indent += 1;
    }

    fn close(&mut self, line: &str) {
        self.indent -= 1;
        self.line(line);
    }

    /// An empty line before a paragraph, but not after another or at the start.
    fn gap(&mut self) {
        if !self.text.ends_with("\n\n") {
            self.line("");
        }
    }
}

/// The text of `module` under the name `name`; `kinds` are the module names of its children.
pub(crate) fn module_text(module: &Module, name: &str, kinds: &[String]) -> Result<String, ExportError> {
    let names = Names::new(module)?;
    let kernel = Kernel::new(module, &names)?;
    let mut page = Page::default();
    page.open(&format!("module {name} ("));
    ports(&mut page, &names, &kernel);
    page.line("");
    page.indent += 1;
    declarations(&mut page, module, &names, &kernel);
    wires(&mut page, &names, &kernel);
    for block in &kernel.blocks {
        page.gap();
        page.open("always @(*) begin");
        steps(&mut page, block, Assignment::Blocking);
        page.close("end");
    }
    for (child, kind) in module.children.iter().zip(kinds) {
        page.gap();
        instance(&mut page, &names, &kernel, child, kind)?;
    }
    clocked(&mut page, module, &kernel);
    page.close("endmodule");
    let unread = module_outputs(module, &names)?;
    Ok(without_unread(page.text, &unread))
}

fn ports(page: &mut Page, names: &Names, kernel: &Kernel) {
    let computed = kernel.block_targets();
    for (place, port) in names.ports.iter().enumerate() {
        let kind = match port.output {
            false => "input  wire",
            true if computed.iter().any(|target| target.text == port.name) => "output reg ",
            true => "output wire",
        };
        let comma = if place + 1 < names.ports.len() { "," } else { "" };
        page.line(&format!("{kind} {:>8}{}{comma}", range(port.width), port.name));
    }
    page.close(");");
}

fn declarations(page: &mut Page, module: &Module, names: &Names, kernel: &Kernel) {
    for (name, value) in &names.constants {
        page.line(&format!("localparam {}{name} = {value};", range(value.width)));
    }
    page.gap();
    for Flop { name, width, initial } in &module.registers {
        page.line(&format!("reg {}{} = {initial};", range(*width), plain(name)));
    }
    for target in kernel.block_targets() {
        if names.ports.iter().all(|port| port.name != target.text) {
            page.line(&format!("reg {}{};", range(target.width), target.text));
        }
    }
    page.gap();
    for child in &module.children {
        for output in child.outputs() {
            page.line(&format!("wire {}{};", range(output.width), plain(&format!("{}${}", child.instance, output.name))));
        }
    }
}

//! The files beside the Verilog for those who instantiate it: a template of the instance, and the
//! constraints of the synchronizers.

use crate::ExportError;
use crate::docs::wrapped;
use crate::module::COLUMNS;
use crate::names::Names;
use crate::netlist::Module;
use crate::parameters;
use crate::prefix::Prefix;
use crate::synchronizers::{Flops, Synchronizer};
use std::fmt::Write as _;

const LICENSE: &str = "SPDX-License-Identifier: MIT OR Apache-2.0";

/// An instance of the module `name`, to be copied: each parameter with its default, each port with
/// its direction and its width.
///
/// # Errors
/// [`ExportError`] if the ports or the parameters of the module have no unique names.
pub(crate) fn template(module: &Module, name: &str) -> Result<String, ExportError> {
    let about = format!(
        "An instance of {name} to be copied into a design. The values of the parameters are the \
         defaults, and may be left out. Ports without a comment on their width have one bit; the \
         comments in {name}.v describe the ports. An output that is not used stays empty; each \
         input needs a value. This file is generated: change the generator instead."
    );
    let mut text = format!("// {LICENSE}\n//\n{}\n", wrapped(&about, "// ", COLUMNS).join("\n"));
    let given = parameters::of(module)?;
    text.push_str(name);
    if !given.is_empty() {
        let lines = given.iter().map(|one| format!("    .{}({})", one.name, one.literal));
        let _ = write!(text, " #(\n{}\n)", lines.collect::<Vec<_>>().join(",\n"));
    }
    let _ = writeln!(text, " {} (", module.instance);
    let ports = Names::new(module)?.ports;
    let longest = ports.iter().map(|port| port.name.len()).max().unwrap_or_default();
    for (place, port) in ports.iter().enumerate() {
        let comma = if place + 1 < ports.len() { "," } else { "" };
        let way = if port.output { "output" } else { "input" };
        let range = match port.width {
            1 => String::new(),
            width => format!(" [{}:0]", width - 1),
        };
        let connection = format!(".{}(){comma}", port.name);
        let _ = writeln!(text, "    {connection:<0$} // {way}{range}", longest + 4);
    }
    Ok(text + ");\n")
}

/// The head of a file of constraints; `how` are the lines that say how to use it.
fn constraints_head(name: &str, tool: &str, how: &str) -> String {
    let about = format!(
        "The synchronizers of the asynchronous inputs of {name}, for {tool}. The inputs have no \
         relation to the clock. Each of them reaches only first flip-flops of synchronizers, so the \
         paths to these are false paths, and the second flip-flop must be placed next to the first. \
         This file is generated from the netlist: change the generator instead. It has not been \
         tested, because {tool} was not available."
    );
    format!("# {LICENSE}\n#\n{}\n#\n{how}", wrapped(&about, "# ", COLUMNS).join("\n"))
}

/// The constraints for Vivado, to be read for all instances of the module `name`.
pub(crate) fn xdc(name: &str, synchronizers: &[Synchronizer]) -> String {
    let how = format!(
        "# They apply to all instances of {name}, if the file is read with\n\
         #     read_xdc -ref {name} {name}.xdc\n"
    );
    let mut text = constraints_head(name, "Vivado", &how);
    for Synchronizer { pins, path, first, second, .. } in synchronizers {
        let path: String = path.iter().map(|instance| format!("{instance}/")).collect();
        let bits = |flops: &Flops| if flops.width == 1 { "" } else { "[*]" };
        let cell = |flops: &Flops| format!("{path}{}_reg{}", flops.name, bits(flops));
        let _ = write!(
            text,
            "\n# {}\nset_property ASYNC_REG TRUE [get_cells {{{} {}}}]\n\
             set_false_path -to [get_pins {{{}/D}}]\n",
            pins.join(", "),
            cell(first),
            cell(second),
            cell(first),
        );
    }
    text
}

/// The constraints for Quartus. They apply to all instances of the modules with the registers.
pub(crate) fn sdc(name: &str, prefix: &Prefix, synchronizers: &[Synchronizer]) -> String {
    let how = "\
# Add the file to the project as an SDC_FILE. The lines of set_instance_assignment belong in the .qsf
# file of the project, without the # before them.
";
    let mut text = constraints_head(name, "Quartus", how);
    for Synchronizer { pins, kind, first, second, .. } in synchronizers {
        let module = prefix.name(kind);
        let bits = |flops: &Flops| if flops.width == 1 { "" } else { "[*]" };
        let register = |flops: &Flops| format!("*{module}:*|{}{}", flops.name, bits(flops));
        let _ = write!(
            text,
            "\n# {}\nset_false_path -to [get_keepers {{{}}}]\n",
            pins.join(", "),
            register(first)
        );
        for flops in [first, second] {
            let _ = writeln!(
                text,
                "# set_instance_assignment -name SYNCHRONIZER_IDENTIFICATION FORCED -to \"{}\"",
                register(flops)
            );
        }
    }
    text
}

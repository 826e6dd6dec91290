//! Describes the folder of the cores to FuseSoC, in its format CAPI2.

use crate::ExportError;
use crate::core::Exported;
use crate::docs::wrapped;
use crate::module::COLUMNS;
use crate::parameters;
use crate::purposes::{ENGINE_NAME, PARALLEL};
use crate::write::TextFile;
use carrystep_hdl::parameters::described;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The file, beside those that it lists.
const FILE: &str = "carrystep.core";

const HEAD: &str = "\
CAPI=2:
# SPDX-License-Identifier: MIT OR Apache-2.0
#
# The gateware of carrystep for FuseSoC. This file is generated: change the generator instead.
#
# The target `default` gives a design the engine, the host link and both lines to the host. The
# target `parallel_6` gives it the parallel core of six axes, which has modules of the same names as
# the engine: a design that needs both exports one of them anew, with `carrystep verilog --prefix`.
#
# The .xdc files have the type `user`, because Vivado must read them with `read_xdc -ref MODULE`,
# which FuseSoC does not do. The .veo files are templates of instances.
#
# Parameters of 64 bits (BUILD_ID and STOP_ACCEL_0 ...) are not listed, because Verilator refuses
# numbers of more than 32 bits from FuseSoC. The instance in your design overrides them.
";

/// The fileset of a core is named as its module, without the prefix.
fn fileset(core: &Exported) -> &str {
    &core.top.instance
}

/// The description of these cores, which are in one folder.
///
/// # Errors
/// [`ExportError`] if the parameters of a core have no unique names.
pub(crate) fn description(cores: &[Exported]) -> Result<TextFile, ExportError> {
    // Writing to a string cannot fail.
    let mut text = HEAD.to_owned();
    let _ = write!(
        text,
        "name: carrystep:gateware:cores:{}\ndescription: Step and direction for the axes of a machine\n\
         \nfilesets:\n",
        env!("CARGO_PKG_VERSION")
    );
    let mut targets = String::new();
    let mut together = Vec::new();
    let mut all = BTreeMap::new();
    for core in cores {
        let set = fileset(core);
        let _ = write!(text, "  {set}:\n    files:\n");
        let mut quartus = None;
        for name in core.files()?.into_iter().map(|file| file.name) {
            match name.rsplit('.').next() {
                Some("v") => {
                    let _ = writeln!(text, "      - {name}: {{file_type: verilogSource-2005}}");
                }
                Some("vlt") => {
                    let _ = writeln!(text, "      - {name}: {{file_type: vlt}}");
                }
                Some("sdc") => quartus = Some(name),
                _ => {
                    let _ = writeln!(text, "      - {name}: {{file_type: user}}");
                }
            }
        }
        let mut sets = set.to_owned();
        if let Some(name) = quartus {
            let _ =
                write!(text, "  {set}_quartus:\n    files:\n      - {name}: {{file_type: SDC}}\n");
            let _ = write!(sets, ", \"tool_quartus? ({set}_quartus)\"");
        }
        let mut own = parameters::of(&core.top)?;
        own.retain(|one| one.bits <= 32);
        let names: Vec<_> = own.iter().map(|one| one.name.as_str()).collect();
        let lint = if core.name == ENGINE_NAME { "lint".to_owned() } else { format!("lint_{set}") };
        let _ = write!(
            targets,
            "  {set}:\n    description: {name} alone\n    filesets: [{sets}]\n    toplevel: {name}\n    \
             parameters: &{set}_parameters\n      [{list}]\n  \
             {lint}:\n    description: Verilator's warnings on {name}\n    flow: lint\n    \
             flow_options:\n      tool: verilator\n      verilator_options: [-Wall]\n    \
             filesets: [{set}]\n    toplevel: {name}\n    parameters: *{set}_parameters\n",
            name = core.name,
            list = wrapped(&names.join(", "), "       ", COLUMNS).join("\n").trim_start()
        );
        if !core.name.starts_with(PARALLEL) {
            together.push(sets);
        }
        all.extend(own.into_iter().map(|one| (one.name.clone(), one)));
    }
    text.push_str("\nparameters:\n");
    for one in all.values() {
        let what = described(&one.name).map_or_else(String::new, |(known, axis)| {
            let of = axis.map_or_else(String::new, |axis| format!("axis {axis}: "));
            format!("{of}{}; {}", known.what, known.range)
        });
        let kind = if one.bits == 0 { "str" } else { "int" };
        let _ = write!(
            text,
            "  {}:\n    datatype: {kind}\n    paramtype: vlogparam\n    description: {:?}\n",
            one.name, what
        );
    }
    let _ = write!(
        text,
        "\ntargets:\n  default:\n    description: Engine, host link and lines, for a design that \
         instantiates them\n    filesets: [{}]\n{targets}",
        together.join(", ")
    );
    Ok(TextFile::new(FILE, text))
}

//! `carrystep verilog`: writes the gateware of a machine as Verilog; with a board, all files that
//! its toolchain needs.

use crate::arguments::{Core, Verilog};
use crate::commands::boards;
use crate::failure::Failure;
use crate::gateware;
use crate::{output, shipped};
use carrystep_core::engine::GuardFigures;
use carrystep_core::link::Uart;
use carrystep_files::Machine;
use carrystep_verilog::{ENGINE_NAME, ExportError, Prefix, parallel_name};
use schemars::JsonSchema;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct WrittenVerilog {
    passed: bool,
    top: String,
    /// The tick that is built in, ns.
    tick_ns: u64,
    /// How the tick was chosen, if the machine file gives none and the clock is not the default.
    tick_note: Option<String>,
    /// The guard's times as the gateware counts them; the parallel core has no guard.
    #[serde(skip_serializing_if = "Option::is_none")]
    guard: Option<GuardFigures>,
    pub(super) files: Vec<PathBuf>,
}

/// The machine that `hdl-out/core` is made from.
const SHIPPED: &str = "sim/six-axis.toml";

/// Writes the Verilog and its lint waivers, or all gateware of a board.
pub fn run(arguments: &Verilog) -> Result<(), Failure> {
    if let Some(board) = &arguments.board {
        return of_board(arguments, board);
    }
    let (machine, name) = match &arguments.machine {
        Some(path) => (Machine::load(path)?, path.display().to_string()),
        None => (shipped::machine()?, SHIPPED.to_owned()),
    };
    let out = arguments.out.as_deref().unwrap_or(Path::new("hdl-out/core"));
    let written = write(arguments.core, out, &machine, &arguments.prefix, &name)?;
    if arguments.json {
        return output::print_json(&written);
    }
    output::print(&listed(&written.files, written.tick_note.as_deref()))
}

/// The list of written files, and the note on the chosen tick.
fn listed(files: &[PathBuf], note: Option<&str>) -> String {
    let note = note.map_or_else(String::new, |note| note.replace("; ", "\n") + "\n");
    files.iter().map(|file| format!("wrote {}\n", file.display())).chain([note]).collect()
}

/// What `--json` prints of a board's gateware.
#[derive(JsonSchema, Serialize)]
pub struct WrittenForBoard<'a> {
    passed: bool,
    top: String,
    board: &'a str,
    part: String,
    build_id: String,
    baud: Option<u32>,
    tick_ns: u64,
    tick_note: Option<String>,
    guard: GuardFigures,
    files: Vec<PathBuf>,
}

/// Writes all files of a board's folder.
fn of_board(arguments: &Verilog, board: &str) -> Result<(), Failure> {
    let board = boards::find(board)?;
    let gateware =
        boards::gateware(&board, arguments.part.as_deref(), arguments.machine.as_deref())?
            .with_prefix(arguments.prefix.clone());
    let out = arguments.out.clone().unwrap_or_else(|| Path::new("sim/out").join(&board.name));
    let files = carrystep_verilog::write(&out, &gateware.files()?)?;
    let tick_note = gateware.chosen_tick().map(|chosen| chosen.to_string());
    if arguments.json {
        return output::print_json(&WrittenForBoard {
            passed: true,
            top: gateware.top(),
            board: &board.name,
            part: gateware.part().ordered(),
            build_id: gateware.build_id().to_string(),
            baud: gateware.uart().map(Uart::baud),
            tick_ns: gateware.build().timebase.tick_ns(),
            tick_note,
            guard: gateware.build().guard_figures(),
            files,
        });
    }
    output::print(&listed(&files, tick_note.as_deref()))
}

/// Writes a core's Verilog for a machine.
pub fn write(
    core: Core,
    out: &Path,
    machine: &Machine,
    prefix: &Prefix,
    name: &str,
) -> Result<WrittenVerilog, Failure> {
    let refused = |error: ExportError| match error {
        ExportError::Io { .. } => Failure::input(error.to_string()),
        _ => Failure::input(format!("{name}: {error}")),
    };
    let (tick_ns, tick_note) =
        (machine.timebase.tick_ns(), machine.chosen_tick.map(|chosen| chosen.to_string()));
    match core {
        Core::Parallel => {
            let build =
                machine.build().map_err(|error| Failure::input(format!("{name}: {error}")))?;
            let axes = machine.axes.len();
            let files = carrystep_verilog::write_parallel(out, &build, axes, prefix, name)
                .map_err(refused)?;
            let top = prefix.name(&parallel_name(axes));
            Ok(WrittenVerilog { passed: true, top, tick_ns, tick_note, guard: None, files })
        }
        Core::Engine => {
            let build = gateware::engine(machine, name)?;
            let files =
                carrystep_verilog::write_engine(out, &build, prefix, name).map_err(refused)?;
            Ok(WrittenVerilog {
                passed: true,
                top: prefix.name(ENGINE_NAME),
                tick_ns,
                tick_note,
                guard: Some(build.guard_figures()),
                files,
            })
        }
    }
}

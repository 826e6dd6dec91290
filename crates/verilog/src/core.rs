//! Writes a core as one file: a header, and then every module once, children first.

use crate::ExportError;
use crate::guard;
use crate::module::module_text;
use crate::names::{Names, split_index};
use crate::netlist::{self, Module};
use crate::parameters;
use crate::write::{TextFile, write};
use carrystep_core::link::{BYTE_PORTS, Line};
use carrystep_core::{Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_hdl::primitives::formula::ParameterValue;
use carrystep_hdl::{HdlError, SixAxis, Spi, UartLine, engine, link};
use rust_hdl::prelude::{Block, check_all};
use std::path::{Path, PathBuf};

/// Name of the six-axis core's top module and of its files.
pub const CORE_NAME: &str = "carrystep_six_axis";

/// Name of the engine's top module and of its files.
pub const ENGINE_NAME: &str = "carrystep_engine";

/// Name of the host link's top module and of its file.
pub const LINK_NAME: &str = "carrystep_link";

/// Verilator's waivers for the parallel core, each with its reason.
pub const CORE_WAIVERS: &str = include_str!("carrystep_six_axis.vlt");

/// Verilator's waivers for the engine, each with its reason.
pub const ENGINE_WAIVERS: &str = include_str!("carrystep_engine.vlt");

/// The version that the workspace pins.
const RUST_HDL: &str = "0.46.0";

/// The purpose of each module, in one line.
const PURPOSES: [(&str, &str); 33] = [
    (
        "carrystep_tick",
        "The beat: a strobe in the last cycle of each tick, and the phases in between.",
    ),
    ("carrystep_sequencer", "The running and the waiting segment of an axis."),
    (
        "carrystep_step_edge",
        "When in its tick a step is due: bisection, then the request to the shaper.",
    ),
    (
        "carrystep_axis",
        "One axis: P, V, A and J. Every carry is a step. The last five ports are there to be watched.",
    ),
    (
        "carrystep_shaper",
        "STEP and DIR with the width, gap, set-up and hold that the driver asks for.",
    ),
    (CORE_NAME, "Six axes on one tick, the door for segments and starts, and the freeze."),
    ("carrystep_turn", "Whose turn it is: one axis after the other, thirteen beats each."),
    (
        "carrystep_adder",
        "The one adder: P + V, V + A, A + J, ticks - 1, positions, and the bisection.",
    ),
    ("carrystep_control", "The control words of the axes."),
    ("carrystep_lasts", "Which segments are the last of their move."),
    ("carrystep_queue", "Which segment an axis runs, and which ones wait."),
    (
        "carrystep_segments",
        "Segments, which are also registers, and what an axis keeps between moves.",
    ),
    ("carrystep_store", "Where everything is in the memory of the axes."),
    ("carrystep_rim", "What the pins do in each phase of four ticks."),
    ("carrystep_wheel", "Events on their way to the pins."),
    (
        "carrystep_pulser",
        "STEP and DIR with the width, gap, set-up and hold that the driver asks for.",
    ),
    ("carrystep_switches", "What is believed of each limit switch."),
    ("carrystep_limits", "The limit switches, one look in a turn."),
    ("carrystep_stops", "Who stops the axes, and how far the stop has come."),
    ("carrystep_watch", "The e-stop, the host's signs of life, the drivers' power."),
    ("carrystep_uart_in", "Bytes from the line."),
    ("carrystep_uart_out", "Bytes to the line."),
    ("carrystep_uart", "A UART, both directions."),
    ("carrystep_spi", "SPI mode 0, the host's clock up to a fifth of this one."),
    ("carrystep_check", "The CRC of frames."),
    ("carrystep_machine", "The little machine that reads requests and writes answers."),
    ("carrystep_instructions", "What it does."),
    ("carrystep_facts", "What can be read."),
    ("carrystep_known", "Facts of the build, and what the engine has last said of its axes."),
    ("carrystep_data", "A request and the answer to it, constants, and what is remembered."),
    ("carrystep_ring", "Received bytes that wait."),
    (LINK_NAME, "The host link: bytes in, words of segments out."),
    (ENGINE_NAME, "Axes on one adder, their queues, starts, and the guard."),
];

/// The six-axis core of this build as Verilog-2005 with the top module [`CORE_NAME`]. `description`
/// is a line that names the source of the build. The same build always gives the same text.
///
/// # Errors
/// [`ExportError`] if the core cannot be generated.
pub fn six_axis_verilog(build: &Build, description: &str) -> Result<String, ExportError> {
    let facts = Facts::of_axes(&build.timebase, build.phase, &build.pins, "");
    file_text(&mut SixAxis::new(build)?, CORE_NAME, &facts, description)
}

/// The engine of this build as Verilog-2005 with the top module [`ENGINE_NAME`]. Otherwise as
/// [`six_axis_verilog`].
///
/// # Errors
/// [`ExportError`] if the engine cannot be generated.
pub fn engine_verilog(build: &EngineBuild, description: &str) -> Result<String, ExportError> {
    let facts = Facts::of_axes(&build.timebase, build.phase, &build.pins, &guard::lines(build));
    file_text(engine(build)?.as_mut(), ENGINE_NAME, &facts, description)
}

/// The host link of this build as Verilog-2005 with the top module [`LINK_NAME`]. Otherwise as
/// [`six_axis_verilog`].
///
/// # Errors
/// [`ExportError`] if the link cannot be generated.
pub fn link_verilog(
    build: &EngineBuild,
    line: Line,
    description: &str,
) -> Result<String, ExportError> {
    let id = line.build_id(build);
    let lines = format!(
        "// Clock        {} Hz\n// Line         {line}\n// Build id     {id}\n",
        build.timebase.clock_hz()
    );
    let facts = Facts { title: "the host link of an engine".to_owned(), lines };
    file_text(link(build, id)?.as_mut(), LINK_NAME, &facts, description)
}

/// The line to the host as Verilog-2005 with the top module [`line_name`]. Otherwise as
/// [`six_axis_verilog`].
///
/// # Errors
/// [`ExportError`] if the module cannot be generated.
pub fn line_verilog(line: Line, description: &str) -> Result<String, ExportError> {
    let facts = Facts {
        title: "the line to the host".to_owned(),
        lines: format!("// Line         {line}\n"),
    };
    file_text(line_block(line).as_mut(), line_name(line), &facts, description)
}

fn line_block(line: Line) -> Box<dyn Block> {
    match line {
        Line::Uart(uart) => Box::new(UartLine::new(uart)),
        Line::Spi => Box::new(Spi::new()),
    }
}

/// The parameters of a build's modules, with its values.
#[derive(Debug)]
pub(crate) struct Overrides {
    pub(crate) line: Vec<ParameterValue>,
    pub(crate) link: Vec<ParameterValue>,
    pub(crate) engine: Vec<ParameterValue>,
}

impl Overrides {
    pub(crate) fn of(build: &EngineBuild, line: Line) -> Result<Self, ExportError> {
        let of = |block: &mut dyn Block| {
            block.connect_all();
            parameters::of(&netlist::read(block)?)
        };
        Ok(Self {
            line: of(line_block(line).as_mut())?,
            link: of(link(build, line.build_id(build))?.as_mut())?,
            engine: of(engine(build)?.as_mut())?,
        })
    }
}

/// Name of a line's top module and of its file.
pub const fn line_name(line: Line) -> &'static str {
    match line {
        Line::Uart(_) => "carrystep_uart",
        Line::Spi => "carrystep_spi",
    }
}

/// Names and widths of ports.
pub(crate) type Ports = Vec<(String, usize)>;

/// The ports between link and line, and the ports between link and engine.
pub(crate) fn link_ports(build: &EngineBuild, line: Line) -> Result<(Ports, Ports), ExportError> {
    let mut link = link(build, line.build_id(build))?;
    link.connect_all();
    let ports = Names::new(&netlist::read(link.as_ref())?)?.ports.into_iter();
    let ports = ports.filter(|port| port.name != "clock").map(|port| (port.name, port.width));
    Ok(ports.partition(|(name, _)| BYTE_PORTS.iter().any(|port| port.name == name.as_str())))
}

/// Contents of the header.
struct Facts {
    title: String,
    lines: String,
}

fn file_text(
    core: &mut dyn Block,
    name: &str,
    build: &Facts,
    description: &str,
) -> Result<String, ExportError> {
    core.connect_all();
    check_all(core).map_err(|error| HdlError::Check(format!("{error:?}")))?;
    let mut top = netlist::read(core)?;
    top.instance = name.trim_start_matches("carrystep_").into();
    let mut library = Library::default();
    library.add(&top)?;
    let mut text = header(name, build, description);
    for Written { name, text: module, .. } in &library.modules {
        let purpose = PURPOSES
            .iter()
            .find(|(kind, _)| name.starts_with(kind))
            .map_or("", |(_, purpose)| purpose);
        text.push_str(&format!("\n// {purpose}\n{module}"));
    }
    text.push_str("\n`default_nettype wire\n");
    Ok(text)
}

/// Writes the six-axis core's Verilog and its waivers into `dir`. Each file appears completely or
/// not at all.
///
/// # Errors
/// [`ExportError`] if the core cannot be generated or a file cannot be written.
pub fn write_core(
    dir: &Path,
    build: &Build,
    description: &str,
) -> Result<Vec<PathBuf>, ExportError> {
    write(dir, &files(CORE_NAME, six_axis_verilog(build, description)?, CORE_WAIVERS))
}

/// Writes the engine's Verilog and its waivers into `dir`. Otherwise as [`write_core`].
///
/// # Errors
/// [`ExportError`] if the engine cannot be generated or a file cannot be written.
pub fn write_engine(
    dir: &Path,
    build: &EngineBuild,
    description: &str,
) -> Result<Vec<PathBuf>, ExportError> {
    write(dir, &files(ENGINE_NAME, engine_verilog(build, description)?, ENGINE_WAIVERS))
}

fn files(name: &str, verilog: String, waivers: &str) -> [TextFile; 2] {
    [TextFile::new(format!("{name}.v"), verilog), TextFile::new(format!("{name}.vlt"), waivers)]
}

/// The modules collected so far, children first.
#[derive(Default)]
struct Library {
    modules: Vec<Written>,
}

/// A module in Verilog.
struct Written {
    name: String,
    /// Its text without the values of its parameters.
    neutral: String,
    /// Its text; its parameters have the values of its first instance.
    text: String,
}

impl Library {
    /// Adds a module and its children, and returns the module's name.
    fn add(&mut self, module: &Module) -> Result<String, ExportError> {
        let kinds =
            module.children.iter().map(|child| self.add(child)).collect::<Result<Vec<_>, _>>()?;
        let name = format!("carrystep_{}", split_index(&module.instance).0);
        let neutral = module_text(&module.without_values(), &name, &kinds)?;
        match self.modules.iter().find(|known| known.name == name) {
            None => {
                let text = module_text(module, &name, &kinds)?;
                self.modules.push(Written { name: name.clone(), neutral, text });
            }
            Some(known) if known.neutral == neutral => {}
            Some(_) => return Err(ExportError::SameName(name)),
        }
        Ok(name)
    }
}

impl Facts {
    fn of_axes(time: &Timebase, phase: StartPhase, pins: &[PinTiming], guard: &str) -> Self {
        let start = match phase {
            StartPhase::Half => "half a step",
            StartPhase::Zero => "0",
        };
        let mut lines = format!(
            "\
// Clock        {clock} Hz
// Tick         {tick} ns, {clocks} clocks in {phases} phases
// Latency      {latency} clocks from the load of a move to the edge of its tick 1, phase 0
// P starts at  {start}
// Pins         in clocks: STEP high, STEP low, DIR before STEP, DIR after STEP
",
            clock = time.clock_hz(),
            tick = time.tick_ns(),
            clocks = time.clocks_per_tick(),
            phases = time.phases(),
            latency = time.latency_clocks(),
        );
        for (axis, PinTiming { width, gap, setup, hold }) in pins.iter().enumerate() {
            lines.push_str(&format!(
                "//   axis {axis}     W {width}, S {gap}, D {setup}, H {hold}\n"
            ));
        }
        let count =
            ["no", "one", "two", "three", "four", "five", "six", "seven", "eight"].get(pins.len());
        let title = format!("step and direction for {} axes", count.unwrap_or(&"many"));
        Self { title, lines: lines + guard }
    }
}

fn header(name: &str, facts: &Facts, description: &str) -> String {
    let description = description.replace(['\n', '\r'], " ");
    let Facts { title, lines } = facts;
    format!(
        "\
// SPDX-License-Identifier: MIT OR Apache-2.0
//
// {name}: {title}. Generated: change the generator, not this file.
//
// Made from    {description}
// Made by      carrystep {version}, with Rust-HDL {RUST_HDL}
//
// Numbers are parameters. Whoever overrides one must override BUILD_ID of the host link too: the host plans moves for
// the parameters that it knows by this id, so with an id of other parameters it is unsafe. The defaults:
//
{lines}
`default_nettype none
",
        version = env!("CARGO_PKG_VERSION"),
    )
}

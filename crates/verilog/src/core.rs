//! Writes a core as one file: a header, and then every module once, children first.

use crate::docs::{self, wrapped};
use crate::module::{COLUMNS, module_text};
use crate::names::{Names, split_index};
use crate::netlist::{self, Module};
use crate::prefix::Prefix;
use crate::synchronizers::{self, Synchronizer};
use crate::write::{TextFile, write};
use crate::{ExportError, guard, instances, parameters};
use carrystep_core::link::{BYTE_PORTS, LineKind};
use carrystep_core::{Build, EngineBuild, PinTiming, StartPhase, Timebase};
use carrystep_hdl::primitives::formula::ParameterValue;
use carrystep_hdl::{HdlError, Spi, UartLine, engine, link, parallel_core};
use rust_hdl::prelude::{Block, check_all};
use std::path::{Path, PathBuf};

/// Name of the parallel core's top module and of its files, without the number of axes.
pub(crate) const PARALLEL: &str = "carrystep_parallel";

/// Name of the parallel core's top module and of its files, for a core of this number of axes.
pub fn parallel_name(axes: usize) -> String {
    format!("{PARALLEL}_{axes}")
}

/// Name of the engine's top module and of its files.
pub const ENGINE_NAME: &str = "carrystep_engine";

/// Name of the host link's top module and of its file.
pub const LINK_NAME: &str = "carrystep_link";

/// Verilator's waivers for the parallel core of any number of axes, each with its reason.
pub const PARALLEL_WAIVERS: &str = include_str!("carrystep_parallel.vlt");

/// Verilator's waivers for the engine, each with its reason.
pub const ENGINE_WAIVERS: &str = include_str!("carrystep_engine.vlt");

/// Verilator's waivers for the host link, each with its reason.
const LINK_WAIVERS: &str = include_str!("carrystep_link.vlt");

/// Verilator's waivers for the UART, each with its reason.
const UART_WAIVERS: &str = include_str!("carrystep_uart.vlt");

/// The version that the workspace pins.
const RUST_HDL: &str = "0.46.0";

/// The purpose of each module, in one line.
const PURPOSES: [(&str, &str); 35] = [
    (
        "carrystep_tick",
        "The tick counter: a strobe in the last clock of each tick, and the phases of a tick.",
    ),
    ("carrystep_sequencer", "Holds the running segment of an axis and one waiting segment."),
    (
        "carrystep_step_edge",
        "Finds the phase of a step in its tick by bisection; requests the step in that phase.",
    ),
    (
        "carrystep_axis",
        "One axis: P, V, A, J. Each carry of P is a step. The last five ports are for observation.",
    ),
    (
        "carrystep_shaper",
        "Drives STEP and DIR of one axis with the pulse width, gap, set-up and hold of its driver.",
    ),
    (
        PARALLEL,
        "Parallel axes on one tick counter: accepts segments and starts, freezes at a fault.",
    ),
    (
        "carrystep_time_slot",
        "The schedule: in each tick every axis has a time slot of thirteen clocks (beats).",
    ),
    (
        "carrystep_adder",
        "The only adder, 32 bits: P + V, V + A, A + J, remaining ticks, positions, bisection.",
    ),
    ("carrystep_control", "Memory of the control words: the queue state and flags of each axis."),
    ("carrystep_lasts", "Memory of one bit per segment: the segment is the last of its move."),
    (
        "carrystep_queue",
        "The segment queue of each axis: which segment runs, and which segments wait.",
    ),
    (
        "carrystep_segments",
        "Memory of the segments, also used as registers, and of an axis' state between moves.",
    ),
    (
        "carrystep_store",
        "The segment memory with its address selection: reads and writes the words of a time slot.",
    ),
    (
        "carrystep_event_memory",
        "Memory of the event wheel: the steps of all axes in each phase of four ticks.",
    ),
    (
        "carrystep_event_wheel",
        "The event wheel: holds the pending steps of all axes, ordered by tick and phase.",
    ),
    (
        "carrystep_pulser",
        "Drives STEP and DIR of one axis with the pulse width, gap, set-up and hold of its driver.",
    ),
    (
        "carrystep_switches",
        "Memory of the debounced state of each limit switch, and its count of deviating samples.",
    ),
    (
        "carrystep_limits",
        "Samples and debounces the limit switches, each in the time slot of its axis.",
    ),
    (
        "carrystep_resets",
        "The reset: freezes the engine, waits for rest, and restores the state at configuration.",
    ),
    (
        "carrystep_homing_control",
        "Homing: which axes wait for their limit, and which ones have reached it and ramp down.",
    ),
    (
        "carrystep_stops",
        "Latches the first cause of a stop, and controls the stop until the host clears it.",
    ),
    (
        "carrystep_supervisor",
        "Monitors the e-stop and the host (watchdog), and times the power of the drivers.",
    ),
    ("carrystep_uart_in", "The UART receiver: eight data bits, no parity, one stop bit."),
    ("carrystep_uart_out", "The UART transmitter: eight data bits, no parity, one stop bit."),
    ("carrystep_uart", "A UART: receiver and transmitter."),
    ("carrystep_spi", "An SPI peripheral in mode 0; SCK may be up to a fifth of the clock."),
    (
        "carrystep_crc",
        "Computes the CRC-32 of frames, and assembles words from bytes; one bit per clock.",
    ),
    (
        "carrystep_processor",
        "A small processor that reads the host's requests, executes them and writes the answers.",
    ),
    ("carrystep_instructions", "Program memory of the processor carrystep_processor."),
    (
        "carrystep_register_mirror",
        "What the host can read: constants of the build, and the last known state of each axis.",
    ),
    (
        "carrystep_known",
        "Memory of carrystep_register_mirror: constants of the build, and the last known state of each axis.",
    ),
    (
        "carrystep_data",
        "Data memory of carrystep_processor: the request, its answer, constants and variables.",
    ),
    ("carrystep_ring", "Ring buffer of the received bytes that the processor has not read yet."),
    (
        LINK_NAME,
        "The host link: receives requests, passes segments to the engine and sends answers.",
    ),
    (ENGINE_NAME, "The engine: all axes on one adder, with their queues, starts, stops and pins."),
];

/// The parallel core of this build with this number of axes, 1 to 6, as Verilog-2005 with the top
/// module [`parallel_name`]. `description` is a line that names the source of the build. The same
/// build always gives the same text.
///
/// # Errors
/// [`ExportError`] if the core cannot be generated.
pub fn parallel_verilog(
    build: &Build,
    axes: usize,
    description: &str,
) -> Result<String, ExportError> {
    Ok(parallel_of(build, axes, &Prefix::default(), description)?.text)
}

/// The engine of this build as Verilog-2005 with the top module [`ENGINE_NAME`]. Otherwise as
/// [`parallel_verilog`].
///
/// # Errors
/// [`ExportError`] if the engine cannot be generated.
pub fn engine_verilog(build: &EngineBuild, description: &str) -> Result<String, ExportError> {
    Ok(engine_of(build, &Prefix::default(), description)?.text)
}

/// The host link of this build as Verilog-2005 with the top module [`LINK_NAME`]. Otherwise as
/// [`parallel_verilog`].
///
/// # Errors
/// [`ExportError`] if the link cannot be generated.
pub fn link_verilog(
    build: &EngineBuild,
    line: LineKind,
    description: &str,
) -> Result<String, ExportError> {
    Ok(link_of(build, line, &Prefix::default(), description)?.text)
}

/// The line to the host as Verilog-2005 with the top module [`line_name`]. Otherwise as
/// [`parallel_verilog`].
///
/// # Errors
/// [`ExportError`] if the module cannot be generated.
pub fn line_verilog(line: LineKind, description: &str) -> Result<String, ExportError> {
    Ok(line_of(line, &Prefix::default(), description)?.text)
}

/// The parallel core, exported.
pub(crate) fn parallel_of(
    build: &Build,
    axes: usize,
    prefix: &Prefix,
    description: &str,
) -> Result<Exported, ExportError> {
    let mut core = parallel_core(build, axes)?;
    let facts = Facts::of_axes(&build.timebase, build.phase, build.pins.iter().take(axes), "");
    let name = parallel_name(axes);
    let top = Top { name: &name, kind: "ParallelCore", waivers: Some(PARALLEL_WAIVERS) };
    Exported::new(core.as_mut(), top, prefix, &facts, description)
}

/// The engine, exported.
pub(crate) fn engine_of(
    build: &EngineBuild,
    prefix: &Prefix,
    description: &str,
) -> Result<Exported, ExportError> {
    let facts =
        Facts::of_axes(&build.timebase, build.phase, build.pins.iter(), &guard::lines(build));
    let top = Top { name: ENGINE_NAME, kind: "Engine", waivers: Some(ENGINE_WAIVERS) };
    Exported::new(engine(build)?.as_mut(), top, prefix, &facts, description)
}

/// The host link, exported.
pub(crate) fn link_of(
    build: &EngineBuild,
    line: LineKind,
    prefix: &Prefix,
    description: &str,
) -> Result<Exported, ExportError> {
    let id = line.build_id(build);
    let lines = format!(
        "// Clock        {} Hz\n// Line         {line}\n// Build id     {id}\n",
        build.timebase.clock_hz()
    );
    let facts = Facts { title: "the host link of an engine".to_owned(), lines };
    let top = Top { name: LINK_NAME, kind: "Link", waivers: Some(LINK_WAIVERS) };
    Exported::new(link(build, id)?.as_mut(), top, prefix, &facts, description)
}

/// The line to the host, exported.
pub(crate) fn line_of(
    line: LineKind,
    prefix: &Prefix,
    description: &str,
) -> Result<Exported, ExportError> {
    let facts = Facts {
        title: "the line to the host".to_owned(),
        lines: format!("// Line         {line}\n"),
    };
    let (kind, waivers) = match line {
        LineKind::Uart(_) => ("UartLine", Some(UART_WAIVERS)),
        LineKind::Spi => ("Spi", None),
    };
    let top = Top { name: line_name(line), kind, waivers };
    Exported::new(line_block(line).as_mut(), top, prefix, &facts, description)
}

fn line_block(line: LineKind) -> Box<dyn Block> {
    match line {
        LineKind::Uart(uart) => Box::new(UartLine::new(uart)),
        LineKind::Spi => Box::new(Spi::new()),
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
    pub(crate) fn of(build: &EngineBuild, line: LineKind) -> Result<Self, ExportError> {
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
pub const fn line_name(line: LineKind) -> &'static str {
    match line {
        LineKind::Uart(_) => "carrystep_uart",
        LineKind::Spi => "carrystep_spi",
    }
}

/// Names and widths of ports.
pub(crate) type Ports = Vec<(String, usize)>;

/// The ports between link and line, and the ports between link and engine.
pub(crate) fn link_ports(
    build: &EngineBuild,
    line: LineKind,
) -> Result<(Ports, Ports), ExportError> {
    let mut link = link(build, line.build_id(build))?;
    link.connect_all();
    let ports = Names::new(&netlist::read(link.as_ref())?)?.ports.into_iter();
    let ports = ports.filter(|port| port.name != "clock").map(|port| (port.name, port.width));
    Ok(ports.partition(|(name, _)| BYTE_PORTS.iter().any(|port| port.name == name.as_str())))
}

/// The name of a module without its number of axes, if it has one: `carrystep_parallel` for
/// `carrystep_parallel_3`.
fn without_axes(usual: &str) -> &str {
    match usual.rsplit_once('_') {
        Some((name, axes)) if axes.parse::<usize>().is_ok() => name,
        _ => usual,
    }
}

/// Contents of the header.
struct Facts {
    title: String,
    lines: String,
}

/// A top module that can be exported.
struct Top<'a> {
    /// Its usual name.
    name: &'a str,
    /// The struct that it is in Rust.
    kind: &'static str,
    waivers: Option<&'static str>,
}

/// A core as Verilog, and what else its files are made from.
pub(crate) struct Exported {
    /// Name of the top module and of the files.
    pub(crate) name: String,
    /// The Verilog.
    pub(crate) text: String,
    pub(crate) top: Module,
    pub(crate) synchronizers: Vec<Synchronizer>,
    prefix: Prefix,
    waivers: Option<&'static str>,
}

impl Exported {
    fn new(
        core: &mut dyn Block,
        Top { name: usual, kind, waivers }: Top<'_>,
        prefix: &Prefix,
        build: &Facts,
        description: &str,
    ) -> Result<Self, ExportError> {
        core.connect_all();
        check_all(core).map_err(|error| HdlError::Check(format!("{error:?}")))?;
        let mut top = netlist::read(core)?;
        top.instance = usual.trim_start_matches("carrystep_").into();
        docs::describe(&mut top, kind)?;
        let synchronizers = synchronizers::of(&top)?;
        let mut library = Library { prefix, modules: Vec::new() };
        let name = library.add(&top)?;
        let mut text = header(&name, build, description);
        for Written { usual, text: module, .. } in &library.modules {
            let (_, purpose) = PURPOSES
                .iter()
                .find(|(kind, _)| without_axes(usual) == *kind)
                .ok_or_else(|| ExportError::undescribed(usual, "the module"))?;
            let purpose = wrapped(&prefix.in_text(purpose), "// ", COLUMNS).join("\n");
            text.push_str(&format!("\n{purpose}\n{module}"));
        }
        text.push_str("\n`default_nettype wire\n");
        Ok(Self { name, text, top, synchronizers, prefix: prefix.clone(), waivers })
    }

    /// The Verilog as a file.
    pub(crate) fn verilog(self) -> TextFile {
        TextFile::new(format!("{}.v", self.name), self.text)
    }

    /// All files: the Verilog, its waivers, a template of an instance, and the constraints of its
    /// synchronizers if it has any.
    pub(crate) fn files(&self) -> Result<Vec<TextFile>, ExportError> {
        let Self { name, prefix, synchronizers, .. } = self;
        let file = |extension: &str, text| TextFile::new(format!("{name}.{extension}"), text);
        let mut files: Vec<TextFile> =
            self.waivers.iter().map(|waivers| file("vlt", prefix.in_text(waivers))).collect();
        files.push(file("veo", instances::template(&self.top, name)?));
        if !synchronizers.is_empty() {
            files.push(file("xdc", instances::xdc(name, synchronizers)));
            files.push(file("sdc", instances::sdc(name, prefix, synchronizers)));
        }
        files.insert(0, file("v", self.text.clone()));
        Ok(files)
    }
}

/// Writes the parallel core of this number of axes, 1 to 6, into `dir`: its Verilog, its waivers
/// and a template of an instance. Each file appears completely or not at all.
///
/// # Errors
/// [`ExportError`] if the core cannot be generated or a file cannot be written.
pub fn write_parallel(
    dir: &Path,
    build: &Build,
    axes: usize,
    prefix: &Prefix,
    description: &str,
) -> Result<Vec<PathBuf>, ExportError> {
    write(dir, &parallel_of(build, axes, prefix, description)?.files()?)
}

/// Writes the engine into `dir`, with the constraints of its synchronizers. Otherwise as
/// [`write_parallel`].
///
/// # Errors
/// [`ExportError`] if the engine cannot be generated or a file cannot be written.
pub fn write_engine(
    dir: &Path,
    build: &EngineBuild,
    prefix: &Prefix,
    description: &str,
) -> Result<Vec<PathBuf>, ExportError> {
    write(dir, &engine_of(build, prefix, description)?.files()?)
}

/// The modules collected so far, children first.
struct Library<'a> {
    prefix: &'a Prefix,
    modules: Vec<Written>,
}

/// A module in Verilog.
struct Written {
    /// Its name with the usual prefix.
    usual: String,
    /// Its text without the values of its parameters.
    neutral: String,
    /// Its text; its parameters have the values of its first instance.
    text: String,
}

impl Library<'_> {
    /// Adds a module and its children, and returns the module's name.
    fn add(&mut self, module: &Module) -> Result<String, ExportError> {
        let kinds =
            module.children.iter().map(|child| self.add(child)).collect::<Result<Vec<_>, _>>()?;
        let usual = format!("carrystep_{}", split_index(&module.instance).0);
        let name = self.prefix.name(&usual);
        let neutral = module_text(&module.without_values(), &name, &kinds)?;
        match self.modules.iter().find(|known| known.usual == usual) {
            None => {
                let text = module_text(module, &name, &kinds)?;
                self.modules.push(Written { usual, neutral, text });
            }
            Some(known) if known.neutral == neutral => {}
            Some(_) => return Err(ExportError::SameName(name)),
        }
        Ok(name)
    }
}

impl Facts {
    fn of_axes<'a>(
        time: &Timebase,
        phase: StartPhase,
        pins: impl ExactSizeIterator<Item = &'a PinTiming>,
        guard: &str,
    ) -> Self {
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
        let axes = match pins.len() {
            1 => "one axis".to_owned(),
            count => {
                let numbers = ["two", "three", "four", "five", "six", "seven", "eight"];
                let number = count.checked_sub(2).and_then(|place| numbers.get(place));
                format!("{} axes", number.unwrap_or(&"many"))
            }
        };
        for (axis, PinTiming { step_high, step_low, dir_setup, dir_hold }) in pins.enumerate() {
            lines.push_str(&format!(
                "//   axis {axis}     STEP_HIGH {step_high}, STEP_LOW {step_low}, DIR_SETUP {dir_setup}, DIR_HOLD {dir_hold}\n"
            ));
        }
        Self { title: format!("step and direction for {axes}"), lines: lines + guard }
    }
}

fn header(name: &str, facts: &Facts, description: &str) -> String {
    let description = description.replace(['\n', '\r'], " ");
    let Facts { title, lines } = facts;
    format!(
        "\
// SPDX-License-Identifier: MIT OR Apache-2.0
//
// {name}: {title}.
// This file is generated: change the generator instead.
//
// Made from    {description}
// Made by      carrystep {version}, with Rust-HDL {RUST_HDL}
//
// Ports: inputs are sampled at the rising edge of `clock`, and outputs change after it; an output
// can also depend on inputs of the same clock. Signals are active high. The comment of a port says
// if it is otherwise; an asynchronous input may come directly from a pin. P is in 2^-64 step, V in
// 2^-64 step per tick, A in 2^-64 step per tick^2, and J in 2^-64 step per tick^3.
//
// The numbers of a build are parameters of the modules. If you override one, override BUILD_ID of
// the host link too: by this id the host knows the parameters for which it plans moves. With the id
// of other parameters it plans wrong moves, which is unsafe. The defaults of the parameters:
//
{lines}
`default_nettype none
",
        version = env!("CARGO_PKG_VERSION"),
    )
}

//! Writes a core as one file: a header, and then every module once, children first.

use crate::docs::{self, wrapped};
use crate::header::{Facts, MOTION, SELF_TEST, header};
use crate::module::{COLUMNS, module_text};
use crate::names::{Names, split_index};
use crate::netlist::{self, Module};
use crate::prefix::Prefix;
use crate::purposes::{ENGINE_NAME, LINK_NAME, SELF_TEST_NAME, parallel_name, purpose};
use crate::synchronizers::{self, Synchronizer};
use crate::write::{TextFile, write};
use crate::{ExportError, guard, instances, parameters};
use carrystep_core::link::{BYTE_PORTS, LineKind};
use carrystep_core::{Build, EngineBuild, SelfTest};
use carrystep_hdl::primitives::formula::ParameterValue;
use carrystep_hdl::{HdlError, Spi, UartLine, engine, link, parallel_core};
use rust_hdl_core::prelude::{Block, check_all};
use std::path::{Path, PathBuf};

/// Verilator's waivers for the parallel core of any number of axes, each with its reason.
pub const PARALLEL_WAIVERS: &str = include_str!("carrystep_parallel.vlt");

/// Verilator's waivers for the engine, each with its reason.
pub const ENGINE_WAIVERS: &str = include_str!("carrystep_engine.vlt");

/// Verilator's waivers for the host link, each with its reason.
const LINK_WAIVERS: &str = include_str!("carrystep_link.vlt");

/// Verilator's waivers for the UART, each with its reason.
const UART_WAIVERS: &str = include_str!("carrystep_uart.vlt");

/// Verilator's waivers for the self-test, each with its reason.
pub const SELF_TEST_WAIVERS: &str = include_str!("carrystep_self_test.vlt");

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

/// The self-test of this build as Verilog-2005 with the top module [`SELF_TEST_NAME`]. Otherwise as
/// [`parallel_verilog`].
///
/// # Errors
/// [`ExportError`] if the module cannot be generated.
pub fn self_test_verilog(test: &SelfTest, description: &str) -> Result<String, ExportError> {
    Ok(self_test_of(test, &Prefix::default(), description)?.text)
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
    let kind = if build.adders > 1 { "WideEngine" } else { "Engine" };
    let top = Top { name: ENGINE_NAME, kind, waivers: Some(ENGINE_WAIVERS) };
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
    let facts = Facts { title: "the host link of an engine".to_owned(), notes: MOTION, lines };
    let kind = if build.adders > 1 { "WideLink" } else { "Link" };
    let top = Top { name: LINK_NAME, kind, waivers: Some(LINK_WAIVERS) };
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
        notes: MOTION,
        lines: format!("// Line         {line}\n"),
    };
    let (kind, waivers) = match line {
        LineKind::Uart(_) => ("UartLine", Some(UART_WAIVERS)),
        LineKind::Spi => ("Spi", None),
    };
    let top = Top { name: line_name(line), kind, waivers };
    Exported::new(line_block(line).as_mut(), top, prefix, &facts, description)
}

/// The self-test, exported.
pub(crate) fn self_test_of(
    test: &SelfTest,
    prefix: &Prefix,
    description: &str,
) -> Result<Exported, ExportError> {
    let lines =
        format!("// Line         {}\n// Rows         {}\n", test.uart(), test.last_row() + 1);
    let title = "the self-test of a board".to_owned();
    let facts = Facts { title, notes: SELF_TEST, lines };
    let top = Top { name: SELF_TEST_NAME, kind: "SelfTest", waivers: Some(SELF_TEST_WAIVERS) };
    Exported::new(&mut carrystep_hdl::SelfTest::new(test), top, prefix, &facts, description)
}

/// The parameters of the self-test's module, with their values in this build.
pub(crate) fn self_test_parameters(test: &SelfTest) -> Result<Vec<ParameterValue>, ExportError> {
    let mut block = carrystep_hdl::SelfTest::new(test);
    block.connect_all();
    parameters::of(&netlist::read(&block)?)
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
            let purpose = purpose(usual)?;
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

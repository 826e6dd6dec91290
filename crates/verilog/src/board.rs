//! What a board's toolchain needs beside the gateware: the clock, constraints, a build script, the wiring.
//!
//! The top level is whoever's who calls: it says which ports it has, and this says where they go.

mod clock;
mod gateware;
mod page;

pub use gateware::{Gateware, shipped_machine};
pub(crate) use page::pages;

use crate::ExportError;
use crate::write::TextFile;
use carrystep_boards::{Board, BoardError, OSCILLATOR, PORTS, Part, Place, Port, Tie, Toolchain, Way, Wire};
use carrystep_core::link::Uart;
use carrystep_core::tick::mhz;
use minijinja::syntax::SyntaxConfig;
use minijinja::{Environment, UndefinedBehavior, Value, context};

/// A top level for a board.
#[derive(Debug, Clone)]
pub struct Design<'a> {
    /// The board.
    pub board: &'a Board,
    /// One of its parts.
    pub part: &'a Part,
    /// Hz; the board's PLL, DCM or MMCM must be able to make it.
    pub clock_hz: u64,
    /// The host link's UART, where it has one.
    pub uart: Option<Uart>,
    /// Name of the top module, and of all files.
    pub top: String,
    /// Its Verilog, file names in the folder of the script.
    pub sources: &'a [&'a str],
    /// Its ports, bit by bit, of those in [`PORTS`]: `uart_rx`, `step[0]`. Each top level also has the port
    /// [`OSCILLATOR`] and those of the board's ties and of its gate.
    pub ports: &'a [String],
}

/// The clock's module, instantiated by the top level: `oscillator` in, `clock` out.
pub const CLOCK_NAME: &str = "carrystep_clock";

/// Constraints, template and extension.
const PCF: (&str, &str) = (include_str!("../templates/board/top.pcf"), "pcf");
const UCF: (&str, &str) = (include_str!("../templates/board/top.ucf"), "ucf");
const XDC: (&str, &str) = (include_str!("../templates/board/top.xdc"), "xdc");

const README: &str = include_str!("../templates/board/readme.md");

/// Scripts: file and template; `TOP` becomes the top module's name.
const OPEN: &[(&str, &str)] = &[("build.sh", include_str!("../templates/board/open.sh"))];
const ISE: &[(&str, &str)] = &[
    ("build.sh", include_str!("../templates/board/ise.sh")),
    ("TOP.xst", include_str!("../templates/board/top.xst")),
    ("TOP.prj", include_str!("../templates/board/top.prj")),
];
const VIVADO: &[(&str, &str)] = &[("build.tcl", include_str!("../templates/board/vivado.tcl"))];

impl Design<'_> {
    /// Everything but the gateware: the clock's Verilog, constraints, scripts, and what a person reads, in this order.
    ///
    /// # Errors
    /// [`ExportError::Board`]: a port without a pin, or a clock that the board cannot make.
    pub fn files(&self) -> Result<Vec<TextFile>, ExportError> {
        let mut files = vec![self.clock()?, self.constraints()?];
        files.extend(self.scripts()?);
        files.push(self.readme()?);
        Ok(files)
    }

    /// The module that makes the clock.
    ///
    /// # Errors
    /// [`ExportError::Board`]: the board cannot make it.
    pub fn clock(&self) -> Result<TextFile, ExportError> {
        let text = clock::verilog(self.board, self.clock_hz)?;
        Ok(TextFile::new(format!("{CLOCK_NAME}.v"), text))
    }

    /// Which port goes to which pin.
    ///
    /// # Errors
    /// [`ExportError::Board`]: a port without a pin.
    pub fn constraints(&self) -> Result<TextFile, ExportError> {
        let (template, extension) = match self.board.family.toolchain() {
            Toolchain::Open => PCF,
            Toolchain::Ise => UCF,
            Toolchain::Vivado => XDC,
        };
        Ok(TextFile::new(format!("{}.{extension}", self.top), self.render(template)?))
    }

    /// What makes a bitstream of it.
    ///
    /// # Errors
    /// [`ExportError::Board`]: a port without a pin.
    pub fn scripts(&self) -> Result<Vec<TextFile>, ExportError> {
        let scripts = match self.board.family.toolchain() {
            Toolchain::Open => OPEN,
            Toolchain::Ise => ISE,
            Toolchain::Vivado => VIVADO,
        };
        let file = |&(name, template): &(&str, &str)| {
            let name = name.replace("TOP", &self.top);
            let executable = name.ends_with(".sh");
            Ok(TextFile { name, text: self.render(template)?, executable })
        };
        scripts.iter().map(file).collect()
    }

    /// Wiring, and how to make and load the bitstream.
    ///
    /// # Errors
    /// [`ExportError::Board`]: a port without a pin.
    pub fn readme(&self) -> Result<TextFile, ExportError> {
        Ok(TextFile::new("README.md".to_owned(), self.render(README)?))
    }

    fn render(&self, template: &str) -> Result<String, ExportError> {
        let Self { board, part, clock_hz, ref top, sources, .. } = *self;
        let pins = self.ports.iter().map(|port| self.pin(port)).collect::<Result<Vec<_>, _>>()?;
        let bitstream = format!("{top}.{}", board.bitstream);
        let values = context! {
            board => context! { name => &board.name, title => &board.title },
            part => context! { name => &part.name, package => &part.package, ordered => part.ordered() },
            top,
            sources => sources.iter().map(|&source| Value::from(source)).collect::<Vec<_>>(),
            pins,
            ties => ties(board),
            gate => gate(board, clock_hz),
            notes => &board.notes,
            toolchain => match board.family.toolchain() {
                Toolchain::Open => "open",
                Toolchain::Ise => "ise",
                Toolchain::Vivado => "vivado",
            },
            io => board.io.name(),
            vccaux => &board.vccaux,
            oscillator => context! {
                port => OSCILLATOR,
                pin => &board.oscillator.pin,
                io => board.oscillator.io.name(),
                mhz => mhz(board.oscillator.hz),
                period_ns => period_ns(board.oscillator.hz),
            },
            mhz => mhz(clock_hz),
            baud => self.uart.map(Uart::baud),
            yosys => board.family.yosys(),
            bitgen => &board.bitgen,
            flash => board.flash.replace("FILE", &bitstream),
            bitstream,
        };
        rendered(template, values)
    }

    /// A port, its pin, and where that is.
    fn pin(&self, port: &str) -> Result<Value, BoardError> {
        let wire = self.wire(port)?;
        let (connector, label) = place(wire);
        let known = kind(wire);
        // Xilinx' tools write a bit of a bus in angles.
        let angles = port.replace('[', "<").replace(']', ">");
        let pulled_up = known.is_some_and(|known| known.way == Way::PulledUp);
        let what = known.map_or("", |known| known.what);
        Ok(context! { port, angles, pin => &wire.pin, connector, label, pulled_up, what })
    }

    /// The only bit of a bus goes without a number.
    fn wire(&self, port: &str) -> Result<&Wire, BoardError> {
        self.board.wire(port).or_else(|error| self.board.wire(&format!("{port}[0]")).map_err(|_| error))
    }
}

/// Blocks leave no empty lines, and a name that a template does not get is an error.
fn rendered(template: &str, values: Value) -> Result<String, ExportError> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_syntax(SyntaxConfig::builder().trim_blocks(true).build().unwrap_or_default());
    Ok(environment.render_str(template, values)?.trim_end().to_owned() + "\n")
}

/// Connector and label of a wire, as a person looks for them.
fn place(wire: &Wire) -> (&str, &str) {
    wire.at.as_ref().map_or(("on the board", ""), |Place { connector, label }| (connector, label))
}

/// What kind of port a wire belongs to.
fn kind(wire: &Wire) -> Option<&'static Port> {
    let name = wire.port.split('[').next();
    PORTS.iter().find(|port| Some(port.name) == name)
}

/// The ties, as templates see them.
fn ties(board: &Board) -> Vec<Value> {
    let row = |tie: &Tie| context! { port => &tie.port, pin => &tie.pin, level => tie.level, why => &tie.why };
    board.ties.iter().map(row).collect()
}

/// The gate, as templates see it; none where there is none.
fn gate(board: &Board, clock_hz: u64) -> Option<Value> {
    board.gate.as_ref().map(|gate| {
        let bits = gate.counter_bits(clock_hz);
        let clocks = 1_u64 << (bits - 1);
        context! { port => &gate.port, pin => &gate.pin, why => &gate.why, bits, clocks }
    })
}

/// A period in ns, rounded down to ps: no slower clock is promised.
fn period_ns(hz: u64) -> String {
    let ps = 1_000_000_000_000 / hz.max(1);
    format!("{}.{:03}", ps / 1000, ps % 1000)
}

//! Generates the files that a board's toolchain needs beside the gateware: clock module,
//! constraints, build script and wiring.
//!
//! The caller provides the top level. It lists the ports of the top level; this module assigns them
//! to pins.

mod clock;
mod gateware;
mod page;
mod self_test;

pub use gateware::{Gateware, shipped_machine};
pub(crate) use page::pages;
pub use self_test::SelfTestGateware;

use crate::ExportError;
use crate::prefix::Prefix;
use crate::write::TextFile;
use carrystep_boards::{
    Board, BoardError, BoardPort, Ice40Synthesis, OSCILLATOR, PORTS, Part, Place, Tie, Way, Wire,
};
use carrystep_core::link::Uart;
use carrystep_core::tick::mhz;
use minijinja::syntax::SyntaxConfig;
use minijinja::{Environment, UndefinedBehavior, Value, context};
use std::sync::LazyLock;

/// A top level for a board.
#[derive(Debug, Clone)]
pub struct Design<'a> {
    /// The board.
    pub board: &'a Board,
    /// The part on the board; one of the parts that the board is sold with.
    pub part: &'a Part,
    /// Clock of the gateware, Hz. The board's PLL, DCM or MMCM must be able to make it.
    pub clock_hz: u64,
    /// The host link's UART, if the link has one.
    pub uart: Option<Uart>,
    /// Name of the top module, and base name of all files.
    pub top: String,
    /// The beginning of the name of the clock module.
    pub prefix: &'a Prefix,
    /// Names of the Verilog files, in the directory of the script.
    pub sources: &'a [&'a str],
    /// The bits of the top level's ports, such as `uart_rx` or `step[0]`, out of those of
    /// [`PORTS`]. In addition, each top level has the port [`OSCILLATOR`], and the ports of the
    /// board's ties and of its gate.
    pub ports: &'a [String],
}

/// Usual name of the clock module, which the top level instantiates. It has the ports `oscillator`
/// (in) and `clock` (out).
pub const CLOCK_NAME: &str = "carrystep_clock";

impl Design<'_> {
    /// All files except the gateware, in this order: the clock's Verilog, constraints, scripts,
    /// readme.
    ///
    /// # Errors
    /// [`ExportError::Board`] if a port has no pin, or if the board cannot make the clock.
    pub fn files(&self) -> Result<Vec<TextFile>, ExportError> {
        let mut files = vec![self.clock()?, self.constraints()?];
        files.extend(self.scripts()?);
        files.push(self.readme()?);
        Ok(files)
    }

    /// The Verilog module that makes the clock.
    ///
    /// # Errors
    /// [`ExportError::Board`] if the board cannot make the clock.
    pub fn clock(&self) -> Result<TextFile, ExportError> {
        let name = self.prefix.name(CLOCK_NAME);
        let text = clock::verilog(self.board, self.part, self.clock_hz, &name)?;
        Ok(TextFile::new(format!("{name}.v"), text))
    }

    /// The constraint file, which assigns each port to a pin.
    ///
    /// # Errors
    /// [`ExportError::Board`] if a port has no pin.
    pub fn constraints(&self) -> Result<TextFile, ExportError> {
        let template = self.board.family.facts().toolchain().constraints;
        let extension = template.rsplit('.').next().unwrap_or_default();
        Ok(TextFile::new(format!("{}.{extension}", self.top), self.render(template)?))
    }

    /// The build scripts.
    ///
    /// # Errors
    /// [`ExportError::Board`] if a port has no pin.
    pub fn scripts(&self) -> Result<Vec<TextFile>, ExportError> {
        let file = |&(name, template): &(&str, &str)| {
            let name = name.replace("TOP", &self.top);
            let executable = name.ends_with(".sh");
            Ok(TextFile { name, text: self.render(template)?, executable })
        };
        self.board.family.facts().toolchain().scripts.iter().map(file).collect()
    }

    /// The readme: the wiring, and how to build and load the bitstream.
    ///
    /// # Errors
    /// [`ExportError::Board`] if a port has no pin.
    pub fn readme(&self) -> Result<TextFile, ExportError> {
        Ok(TextFile::new("README.md".to_owned(), self.render("readme.md")?))
    }

    fn render(&self, template: &str) -> Result<String, ExportError> {
        let Self { board, part, clock_hz, ref top, sources, .. } = *self;
        let pins = self.ports.iter().map(|port| self.pin(port)).collect::<Result<Vec<_>, _>>()?;
        let bitstream = format!("{top}.{}", board.bitstream);
        let family = board.family.facts();
        let values = context! {
            board => context! { name => &board.name, title => &board.title },
            part => context! {
                name => &part.name,
                package => &part.package,
                ordered => part.ordered(),
                synthesis => Ice40Synthesis::of(&part.name, top).commands(),
                nextpnr => part.nextpnr().join(" "),
                die => part.die(),
            },
            top,
            sources => sources.iter().map(|&source| Value::from(source)).collect::<Vec<_>>(),
            pins,
            ties => ties(board),
            gate => gate(board, clock_hz),
            notes => &board.notes,
            commands => family.toolchain().commands.to_vec(),
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
            yosys => family.yosys(),
            bitgen => &board.bitgen,
            flash => board.flash.replace("FILE", &bitstream),
            bitstream,
        };
        rendered(template, values)
    }

    /// A port, its pin, and the place of the pin on a connector.
    fn pin(&self, port: &str) -> Result<Value, BoardError> {
        let wire = self.wire(port)?;
        let (connector, label) = place(wire);
        let known = kind(wire);
        // The tools of Xilinx write the bit of a bus in angle brackets.
        let angles = port.replace('[', "<").replace(']', ">");
        let pulled_up = known.is_some_and(|known| known.way == Way::PulledUp);
        let what = known.map_or("", |known| known.what);
        let io = wire.io.unwrap_or(self.board.io).name();
        Ok(context! { port, angles, pin => &wire.pin, io, connector, label, pulled_up, what })
    }

    /// The wire of a port. If a bus has one bit only, its port name has no number.
    fn wire(&self, port: &str) -> Result<&Wire, BoardError> {
        self.board
            .wire(port)
            .or_else(|error| self.board.wire(&format!("{port}[0]")).map_err(|_| error))
    }
}

/// Renders a template of `templates/board`. Lines of block tags leave no empty lines; a name that
/// has no value is an error.
fn rendered(template: &str, values: Value) -> Result<String, ExportError> {
    #[allow(
        unused_qualifications,
        elided_lifetimes_in_paths,
        reason = "in the text of minijinja-embed"
    )]
    static ENVIRONMENT: LazyLock<Environment<'static>> = LazyLock::new(|| {
        let mut environment = Environment::new();
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        environment
            .set_syntax(SyntaxConfig::builder().trim_blocks(true).build().unwrap_or_default());
        minijinja_embed::load_templates!(environment);
        environment
    });
    Ok(ENVIRONMENT.get_template(template)?.render(values)?.trim_end().to_owned() + "\n")
}

/// Connector and label of a wire.
fn place(wire: &Wire) -> (&str, &str) {
    wire.at.as_ref().map_or(("on the board", ""), |Place { connector, label }| (connector, label))
}

/// The port of [`PORTS`] to which a wire belongs.
fn kind(wire: &Wire) -> Option<&'static BoardPort> {
    let name = wire.port.split('[').next();
    PORTS.iter().find(|port| Some(port.name) == name)
}

/// The ties, as values for the templates.
fn ties(board: &Board) -> Vec<Value> {
    let row = |tie: &Tie| context! { port => &tie.port, pin => &tie.pin, level => tie.level, why => &tie.why };
    board.ties.iter().map(row).collect()
}

/// The gate, as values for the templates; `None` if the board has none.
fn gate(board: &Board, clock_hz: u64) -> Option<Value> {
    board.gate.as_ref().map(|gate| {
        let bits = gate.counter_bits(clock_hz);
        let clocks = 1_u64 << (bits - 1);
        context! { port => &gate.port, pin => &gate.pin, why => &gate.why, bits, clocks }
    })
}

/// A clock period in ns, rounded down to ps, so that the constraint is never slower than the clock.
fn period_ns(hz: u64) -> String {
    let ps = 1_000_000_000_000 / hz.max(1);
    format!("{}.{:03}", ps / 1000, ps % 1000)
}

//! Generates the whole gateware of a machine for a board: a top level that connects clock, link and
//! engine to the pins, and all files for the board's toolchain.

use super::{CLOCK_NAME, Design, rendered};
use crate::ExportError;
use crate::core::{Overrides, Ports, engine_of, line_name, line_of, link_of, link_ports};
use crate::parameters::overrides;
use crate::prefix::Prefix;
use crate::purposes::{ENGINE_NAME, LINK_NAME};
use crate::write::TextFile;
use carrystep_boards::{Board, Clocking, Part};
use carrystep_core::ChosenTick;
use carrystep_core::engine::{ENGINE_PORTS, EngineBuild};
use carrystep_core::link::{BuildId, LineKind, Uart};
use carrystep_core::ports::{Direction, Peer, Port};
use carrystep_files::{Machine, SourceText};
use carrystep_hdl::parameters::EVENT_MEMORY;
use minijinja::{Value, context};
use pins::{INPUTS, limit_bits};

mod pins;

/// The list of the Verilog files, one in a line, in the format of the option `-f` of Icarus and
/// Verilator.
pub(super) const FILE_LIST: &str = "files.f";

/// The machine that boards are built for where no other is asked for; clock, tick and limits are
/// put before its axes.
const SHIPPED: &str = include_str!("../../../../sim/six-axis.toml");

/// The gateware of a machine for a board, after all checks.
#[derive(Debug, Clone)]
pub struct Gateware<'a> {
    board: &'a Board,
    part: &'a Part,
    build: EngineBuild,
    line: LineKind,
    chosen_tick: Option<ChosenTick>,
    prefix: Prefix,
    /// The machine file. It is exported with the gateware, because moves are planned from it.
    machine: SourceText,
}

impl<'a> Gateware<'a> {
    /// Checks the gateware of this machine file for a board.
    ///
    /// # Errors
    /// [`ExportError`] if the board lacks pins or cannot make the clock or the baud rate, if the
    /// engine's parameters are out of range, or if the file is no valid machine file.
    pub fn new(board: &'a Board, part: &'a Part, machine: SourceText) -> Result<Self, ExportError> {
        let read = Machine::from_source(&machine)?;
        let (build, line) = (read.engine(), read.line()?);
        board.clock(build.timebase.clock_hz())?;
        board.has_adders(build.adders)?;
        let axes: Vec<&str> = read.axes.iter().map(|axis| &*axis.name).collect();
        board.carries(&axes, build.guard.limits)?;
        board.connects(&build, matches!(line, LineKind::Uart(_)))?;
        if let LineKind::Uart(uart) = line {
            board.takes(uart.baud())?;
        }
        build.check().map_err(carrystep_hdl::HdlError::from)?;
        board.holds(part, &build)?;
        let (chosen_tick, prefix) = (read.chosen_tick, Prefix::default());
        let gateware = Self { board, part, build, line, chosen_tick, prefix, machine };
        // Checks that each port has a pin; the error names the first one that has none.
        gateware.design(&gateware.ports(), &[]).constraints()?;
        Ok(gateware)
    }

    /// The gateware of the shipped machine at the board's first clock.
    ///
    /// # Errors
    /// As [`Gateware::new`].
    pub fn shipped(board: &'a Board, part: &'a Part) -> Result<Self, ExportError> {
        let text = shipped_machine(board, &board.clocks[0])?;
        Self::new(board, part, SourceText { path: "machine.toml".into(), text: text.into() })
    }

    /// The same gateware with other names of modules and files.
    #[must_use]
    pub fn with_prefix(self, prefix: Prefix) -> Self {
        Self { prefix, ..self }
    }

    /// Name of the top module, `carrystep_BOARD_top` with the usual prefix.
    pub fn top(&self) -> String {
        format!("{}{}_top", self.prefix, self.board.name.replace('-', "_"))
    }

    /// Build id, which the host compares before it uses the gateware.
    pub fn build_id(&self) -> BuildId {
        self.line.build_id(&self.build)
    }

    /// Build parameters of the engine.
    pub fn build(&self) -> &EngineBuild {
        &self.build
    }

    /// How the tick was chosen, if the machine file gives none.
    pub fn chosen_tick(&self) -> Option<ChosenTick> {
        self.chosen_tick
    }

    /// The link's UART; `None` if the link is an SPI.
    pub fn uart(&self) -> Option<Uart> {
        match self.line {
            LineKind::Uart(uart) => Some(uart),
            LineKind::Spi => None,
        }
    }

    /// The part for which the gateware is built.
    pub fn part(&self) -> &Part {
        self.part
    }

    /// The Verilog of all modules with their file names, the top level first.
    ///
    /// # Errors
    /// [`ExportError`] if a module cannot be generated.
    pub fn verilog(&self) -> Result<Vec<TextFile>, ExportError> {
        let description = format!("{} for {}", self.machine.path.display(), self.board.title);
        Ok(vec![
            TextFile::new(format!("{}.v", self.top()), self.top_level()?),
            self.design(&[], &[]).clock()?,
            line_of(self.line, &self.prefix, &description)?.verilog(),
            link_of(&self.build, self.line, &self.prefix, &description)?.verilog(),
            engine_of(&self.build, &self.prefix, &description)?.verilog(),
        ])
    }

    /// All files of a directory that contains all modules of the board.
    ///
    /// # Errors
    /// [`ExportError`] if a module cannot be generated.
    pub fn files(&self) -> Result<Vec<TextFile>, ExportError> {
        let verilog = self.verilog()?;
        let sources: Vec<_> = verilog.iter().map(|file| file.name.clone()).collect();
        self.files_with(verilog, &sources)
    }

    /// All files of a directory that takes the modules of link and engine from another one, which
    /// the top level's directory reaches as `core`.
    ///
    /// # Errors
    /// [`ExportError`] if a module cannot be generated.
    pub fn files_beside(&self, core: &str) -> Result<Vec<TextFile>, ExportError> {
        let all = self.verilog()?;
        let is_own = |file: &TextFile| {
            let clock = self.prefix.name(CLOCK_NAME);
            [self.top(), clock].iter().any(|own| file.name == format!("{own}.v"))
        };
        let source = |file: &TextFile| {
            if is_own(file) { file.name.clone() } else { format!("{core}/{}", file.name) }
        };
        let sources: Vec<_> = all.iter().map(source).collect();
        self.files_with(all.into_iter().filter(is_own).collect(), &sources)
    }

    fn files_with(
        &self,
        verilog: Vec<TextFile>,
        sources: &[String],
    ) -> Result<Vec<TextFile>, ExportError> {
        let mut files = verilog;
        files.push(TextFile::new(FILE_LIST, sources.join("\n") + "\n"));
        let sources: Vec<&str> = sources.iter().map(String::as_str).collect();
        let ports = self.ports();
        let design = self.design(&ports, &sources);
        files.push(design.constraints()?);
        files.extend(design.scripts()?);
        files.push(design.readme()?);
        files.push(TextFile::new("machine.toml".to_owned(), self.machine.text.to_string()));
        Ok(files)
    }

    fn design<'b>(&'b self, ports: &'b [String], sources: &'b [&'b str]) -> Design<'b> {
        Design {
            board: self.board,
            part: self.part,
            clock_hz: self.build.timebase.clock_hz(),
            uart: self.uart(),
            top: self.top(),
            prefix: &self.prefix,
            sources,
            ports,
        }
    }

    fn top_level(&self) -> Result<String, ExportError> {
        let axes = self.build.axes();
        let (low, high) = limit_bits(&self.build);
        // An output of the link is connected to the engine's input of the same name, and vice
        // versa.
        let (bytes, between) = link_ports(&self.build, self.line)?;
        let mut given = Overrides::of(&self.build, self.line)?;
        // Where block RAMs write whole words only, the memory that is written bit by bit lies in
        // LUTs.
        if !self.board.family.facts().writes_parts_of_words() {
            for memory in given.engine.iter_mut().filter(|one| one.name == EVENT_MEMORY.name) {
                memory.literal = "\"distributed\"".to_owned();
            }
        }
        let row = |(name, width): &(String, usize)| context! { name, range => range(*width) };
        let values = context! {
            title => &self.board.title,
            top => self.top(),
            clock => self.prefix.name(CLOCK_NAME),
            line => self.prefix.name(line_name(self.line)),
            link => self.prefix.name(LINK_NAME),
            engine => self.prefix.name(ENGINE_NAME),
            line_parameters => overrides(&given.line),
            link_parameters => overrides(&given.link),
            engine_parameters => overrides(&given.engine),
            axes => range(axes),
            low => (low > 0).then(|| range(low)),
            high => (high > 0).then(|| range(high)),
            one_for_all => low == 1 && axes > 1,
            others => axes - 1,
            count => axes,
            switches => self.switches().map(|(port, pin)| {
                let inactive = format!("1'b{}", self.inactive(port.name).unwrap_or_default());
                let wire = match port.name {
                    "latch" if !self.build.guard.latches.is_empty() => self.latches()[0].clone(),
                    name if pin => name.to_owned(),
                    _ => inactive,
                };
                context! { name => port.name, pin, wire, range => range(self.pins_of(port.name).max(1)) }
            }).collect::<Vec<Value>>(),
            more_latches => self.build.has_several_latches().then(|| {
                let [_, latches @ ..] = self.latches();
                latches.into_iter().rev().collect::<Vec<_>>().join(", ")
            }),
            inputs => [0, 1].map(|row| {
                context! { name => INPUTS[row].0, bits => self.row_of_inputs(row) }
            }),
            firsts => [0, 1].into_iter().filter(|&row| self.build.guard.inputs[row].exist & 1 == 1)
                .map(|row| INPUTS[row].1).collect::<Vec<_>>(),
            general => match self.general().count() { 0 => None, count => Some(range(count)) },
            outputs => match self.outputs() { 0 => None, count => Some(range(count)) },
            last_output => self.outputs().saturating_sub(1),
            pwm => self.has_pwm(),
            unlinked => unlinked(&between).map(|port| {
                let zero = format!("{}'d0", port.width.of(axes));
                let tied = if port.direction == Direction::Input { zero } else { String::new() };
                context! { name => port.name, tied }
            }).collect::<Vec<Value>>(),
            led => self.has_led(),
            led_low => self.board.led_low,
            line_pins => self.line_pins().map(|(port, pin)| {
                let out = port.direction == Direction::Output;
                let held = self.board.gate.as_ref().is_some_and(|gate| gate.holds.iter().any(|held| held == pin));
                context! { port => port.name, pin, out, held }
            }).collect::<Vec<Value>>(),
            bytes => bytes.iter().map(row).collect::<Vec<Value>>(),
            between => between.iter().map(row).collect::<Vec<Value>>(),
            ties => super::ties(self.board),
            gate => super::gate(self.board, self.build.timebase.clock_hz()),
        };
        rendered("top.v", values)
    }
}

/// The text of the shipped machine file at a clock of the board, at the board's fastest baud rate,
/// and with its deepest queues.
///
/// # Errors
/// [`ExportError::Baud`] if the clock makes no usual baud rate.
pub fn shipped_machine(board: &Board, clock: &Clocking) -> Result<String, ExportError> {
    let axes = SHIPPED.find("[[machine.axis]]").map_or("", |begin| &SHIPPED[begin..]);
    let Clocking { clock_hz, tick_ns, phases, .. } = clock;
    let (baud, depth) = (board.uart(*clock_hz)?.baud(), board.queue_depth);
    Ok(format!(
        "# The shipped machine (sim/six-axis.toml) for {}.\n[machine]\nclock_hz = {clock_hz}\ntick_ns = {tick_ns}\n\
         phases = {phases}\nphase = \"half\"\nqueue_depth = {depth}\n\n[machine.guard]\nlimits = \"each\"\n\n[machine.link]\nbaud = {baud}\n\n{axes}",
        board.title
    ))
}

/// The engine's ports for a host that the link does not have. They are tied to 0 or left open.
fn unlinked(between: &Ports) -> impl Iterator<Item = &'static Port> {
    let is_linked = |port: &&Port| between.iter().any(|(name, _)| name == port.name);
    ENGINE_PORTS.iter().filter(move |port| port.peer == Peer::Host && !is_linked(port))
}

/// The range of a vector, `[5:0] `; empty for a single bit.
pub(super) fn range(width: usize) -> String {
    if width == 1 { String::new() } else { format!("[{}:0] ", width - 1) }
}

//! Generates the self-test of a board (docs/self-test.md): a top level that connects clock and
//! self-test to the pins, and all files for the board's toolchain.

use super::gateware::{FILE_LIST, range};
use super::{CLOCK_NAME, Design, rendered};
use crate::ExportError;
use crate::core::{self_test_of, self_test_parameters};
use crate::parameters::overrides;
use crate::prefix::Prefix;
use crate::purposes::SELF_TEST_NAME;
use crate::write::TextFile;
use carrystep_boards::{Board, BoardSelfTest, PORTS, Part, Way};
use carrystep_core::SelfTest;
use carrystep_core::self_test::MAX_ROWS;
use minijinja::{Value, context};

/// The self-test of a board, after all checks.
#[derive(Debug, Clone)]
pub struct SelfTestGateware<'a> {
    board: &'a Board,
    part: &'a Part,
    clock_hz: u64,
    rows: BoardSelfTest,
    prefix: Prefix,
}

impl<'a> SelfTestGateware<'a> {
    /// Checks the self-test of a board at the board's first clock. With `spi`, a host is wired to
    /// the SPI: pins that the SPI shares with other ports are then those of the SPI.
    ///
    /// # Errors
    /// [`ExportError::Board`] if the board lacks pins, or cannot make the clock or the baud rate.
    pub fn new(board: &'a Board, part: &'a Part, spi: bool) -> Result<Self, ExportError> {
        let clock_hz = board.clocks[0].clock_hz;
        board.clock(clock_hz)?;
        let rows = board.self_test(clock_hz, spi)?;
        Ok(Self { board, part, clock_hz, rows, prefix: Prefix::default() })
    }

    /// Name of the top module, `carrystep_BOARD_selftest`.
    pub fn top(&self) -> String {
        format!("{}{}_selftest", self.prefix, self.board.name.replace('-', "_"))
    }

    /// The rows, and the ports that belong to them.
    pub fn rows(&self) -> &BoardSelfTest {
        &self.rows
    }

    /// What the module of the self-test is made from.
    pub fn test(&self) -> &SelfTest {
        &self.rows.test
    }

    /// Clock, Hz.
    pub fn clock_hz(&self) -> u64 {
        self.clock_hz
    }

    /// The part for which the self-test is built.
    pub fn part(&self) -> &Part {
        self.part
    }

    /// The ports of the top level that are lists or single bits, each with its direction and its
    /// number of bits. Ties, the gate and the oscillator are not among them.
    pub fn ports(&self) -> Vec<(&'static str, Way, usize)> {
        let bits = |name| {
            let of = |port: &&String| port.split('[').next() == Some(name);
            self.rows.ports.iter().filter(of).count()
        };
        let all = PORTS.iter().map(|port| (port.name, port.way, bits(port.name)));
        all.filter(|(_, _, bits)| *bits > 0).collect()
    }

    /// The Verilog of all modules with their file names, the top level first.
    ///
    /// # Errors
    /// [`ExportError`] if a module cannot be generated.
    pub fn verilog(&self) -> Result<Vec<TextFile>, ExportError> {
        let description = format!("the self-test of {}", self.board.title);
        Ok(vec![
            TextFile::new(format!("{}.v", self.top()), self.top_level()?),
            self.design(&[], &[]).clock()?,
            self_test_of(self.test(), &self.prefix, &description)?.verilog(),
        ])
    }

    /// All files of a directory that contains all modules.
    ///
    /// # Errors
    /// [`ExportError`] if a module cannot be generated.
    pub fn files(&self) -> Result<Vec<TextFile>, ExportError> {
        let mut files = self.verilog()?;
        let sources: Vec<_> = files.iter().map(|file| file.name.clone()).collect();
        files.push(TextFile::new(FILE_LIST, sources.join("\n") + "\n"));
        let sources: Vec<&str> = sources.iter().map(String::as_str).collect();
        let ports: Vec<String> = self.rows.ports.iter().map(|port| self.name_of(port)).collect();
        let design = self.design(&ports, &sources);
        files.push(design.constraints()?);
        files.extend(design.scripts()?);
        files.push(TextFile::new("README.md", design.render("selftest.md")?));
        Ok(files)
    }

    fn design<'b>(&'b self, ports: &'b [String], sources: &'b [&'b str]) -> Design<'b> {
        Design {
            board: self.board,
            part: self.part,
            clock_hz: self.clock_hz,
            uart: Some(self.test().uart()),
            top: self.top(),
            prefix: &self.prefix,
            sources,
            ports,
        }
    }

    /// The name of a port's bit in the top level: a port of one bit has no number.
    fn name_of(&self, port: &str) -> String {
        let name = port.split('[').next().unwrap_or(port);
        let is_alone = self.ports().iter().any(|(other, _, bits)| *other == name && *bits == 1);
        if is_alone { name.to_owned() } else { port.to_owned() }
    }

    fn top_level(&self) -> Result<String, ExportError> {
        let test = self.test();
        let is_held = |port: &str| {
            let held = |gate: &carrystep_boards::Gate| gate.holds.iter().any(|held| held == port);
            self.board.gate.as_ref().is_some_and(held)
        };
        let row = |(index, port): (usize, &String), first: usize| {
            context! { port => self.name_of(port), row => first + index, held => is_held(port) }
        };
        let rows = |ports: &[String], first| {
            ports.iter().enumerate().map(|port| row(port, first)).collect::<Vec<Value>>()
        };
        let (first, last) = (test.first_input(), test.last_input());
        let values = context! {
            title => &self.board.title,
            top => self.top(),
            clock => self.prefix.name(CLOCK_NAME),
            self_test => self.prefix.name(SELF_TEST_NAME),
            parameters => overrides(&self_test_parameters(test)?),
            ports => self.ports().iter().map(|(name, way, bits)| {
                context! { name => *name, out => *way == Way::Out, range => range(*bits) }
            }).collect::<Vec<Value>>(),
            outputs => rows(&self.rows.outputs, 1),
            inputs => rows(&self.rows.inputs, first),
            below => first,
            above => MAX_ROWS - 1 - last,
            next => last + 1,
            top_row => MAX_ROWS - 1,
            led => self.board.bits("led") > 0,
            led_low => self.board.led_low,
            enable => self.board.bits("enable_n") > 0,
            tx_held => is_held("uart_tx"),
            ties => super::ties(self.board),
            gate => super::gate(self.board, self.clock_hz),
        };
        rendered("selftest.v", values)
    }
}

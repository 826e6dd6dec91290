//! Line, link and engine of a board in Verilator: a process that runs for a given number of clocks,
//! and reports the changes at its pins.

use crate::tool::{self, VERILATOR};
use crate::verilator::Simulation;
use crate::{LevelError, bench};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{Cause, EngineInputs, ports_of};
use carrystep_core::link::LineKind;
use carrystep_core::ports::{Direction, Peer, Port};
use carrystep_verilog::{engine_verilog, line_verilog, link_verilog};
use std::io::{BufRead as _, BufReader, BufWriter, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// Levels of a board's input pins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Levels {
    /// The line from the host: level of RX, or of MOSI.
    pub rx: bool,
    /// Levels of SCK and of the active-low chip select.
    pub spi: [bool; 2],
    /// Levels of the engine's pins; its other inputs have no effect.
    pub pins: EngineInputs,
}

/// An event of a board, with the first cycle in which it is visible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Did {
    /// The line to the host changed: new level of TX, or of MISO.
    Tx(u64, bool),
    /// Levels of STEP and DIR of all axes changed.
    Pins(u64, [u8; 2]),
    /// Levels of the outputs, of the PWM's pin, or of the request for the drivers' power changed.
    Outputs(u64, SwitchedPins),
    /// A start loaded its first segments.
    Load(u64),
    /// A stop came into force, with its cause.
    Stop(u64, Cause),
}

/// Levels of the pins that do not belong to an axis; 1 is active.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SwitchedPins {
    /// The outputs that programs switch, one bit each.
    pub outputs: u8,
    /// The pin of the PWM.
    pub pwm: bool,
    /// Whether the drivers are to have power.
    pub enabled: bool,
}

/// State of the board between two runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Standing {
    /// Number of the clock cycle.
    pub cycle: u64,
    /// Whether no axis moves.
    pub idle: bool,
    /// Whether all axes rest after a stop.
    pub halted: bool,
    /// The stop in force: its cause, and the mask of the axes that caused it.
    pub fault: Option<(Cause, u8)>,
}

/// The process; it is ended when this is dropped.
#[derive(Debug)]
pub struct BoardProcess {
    /// Whether the engine has several latches, and their ports.
    several: bool,
    child: Child,
    to: BufWriter<ChildStdin>,
    from: BufReader<ChildStdout>,
}

impl BoardProcess {
    /// The exported Verilog of this build with this line, in cycle 0.
    ///
    /// # Errors
    /// [`LevelError`] if Verilator is missing or fails, or if there is no such gateware.
    pub fn new(build: &EngineBuild, line: LineKind) -> Result<Self, LevelError> {
        let what = "a simulation";
        let parts = [
            line_verilog(line, what),
            link_verilog(build, line, what),
            engine_verilog(build, what),
        ];
        // The exported files are Verilog-2005; the top level of the bench uses more.
        let several = build.has_several_latches();
        let top = bench::board(several, build.adders)?;
        let mut verilog = format!("{top}`begin_keywords \"1364-2005\"\n");
        for part in parts {
            verilog += &part.map_err(|error| LevelError::Gateware(error.to_string()))?;
        }
        verilog += "`end_keywords\n";
        let axes = format!("-GAXES={}", build.axes());
        let define = if line == LineKind::Spi { "-DSPI" } else { "-DUART" };
        let options: &[&str] = &[&axes, define];
        let bench = bench::board_process(several, build.adders)?;
        let board = Simulation { name: "board", top: "board_bench", bench: &bench, options };
        let mut command = Command::new(board.compiled(&verilog)?);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().map_err(tool::io("cannot start the simulation"))?;
        let (Some(to), Some(from)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(gone("no pipes"));
        };
        Ok(Self { several, child, to: BufWriter::new(to), from: BufReader::new(from) })
    }

    /// Runs for the given number of clocks with each of these levels, and returns the state at the
    /// end.
    ///
    /// All of `stimuli` must fit into a pipe; some thousands of entries do.
    ///
    /// # Errors
    /// [`LevelError`] if the process has failed.
    pub fn run(
        &mut self,
        stimuli: &[(u64, Levels)],
        to: &mut dyn FnMut(Did),
    ) -> Result<Standing, LevelError> {
        let last = stimuli.last().map(|&(_, levels)| (0, levels));
        for (count, Levels { rx, spi: [sck, select_n], pins }) in
            stimuli.iter().copied().chain(last)
        {
            let bits =
                [select_n, sck, rx].into_iter().fold(0, |bits, pin| bits << 1 | u8::from(pin));
            let mut line = format!("{count} {bits:x}");
            let levels = ports_of(Direction::Input).zip(pins.at_ports());
            let is_pin = |port: &Port| port.peer == Peer::Pins && bench::has(self.several, port);
            for (_, (_, level)) in levels.filter(|(port, _)| is_pin(port)) {
                line += &format!(" {:x}", level.unwrap_or(0));
            }
            writeln!(self.to, "{line}").map_err(tool::io("the simulation is gone"))?;
        }
        self.to.flush().map_err(tool::io("the simulation is gone"))?;
        let mut line = String::new();
        loop {
            line.clear();
            self.from.read_line(&mut line).map_err(tool::io("the simulation is gone"))?;
            match parsed(&line).ok_or_else(|| gone(&line))? {
                Heard::Did(did) => to(did),
                Heard::Standing(standing) => return Ok(standing),
            }
        }
    }
}

impl Drop for BoardProcess {
    fn drop(&mut self) {
        // The process may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A line that the bench prints.
enum Heard {
    Did(Did),
    Standing(Standing),
}

fn parsed(line: &str) -> Option<Heard> {
    let mut words = line.split_whitespace();
    let kind = words.next()?;
    let cycle = words.next()?.parse().ok()?;
    let mut hex = || u8::from_str_radix(words.next()?, 16).ok();
    let cause = Cause::from_number;
    Some(Heard::Did(match kind {
        "t" => Did::Tx(cycle, hex()? == 1),
        "p" => Did::Pins(cycle, [hex()?, hex()?]),
        "o" => {
            let (outputs, pwm, enabled) = (hex()?, hex()? == 1, hex()? == 1);
            Did::Outputs(cycle, SwitchedPins { outputs, pwm, enabled })
        }
        "l" => Did::Load(cycle),
        "f" => Did::Stop(cycle, cause(hex()?)?),
        "." => {
            let (idle, halted, stopped) = (hex()? == 1, hex()? == 1, hex()? == 1);
            let fault = (cause(hex()?)?, hex()?);
            return Some(Heard::Standing(Standing {
                cycle,
                idle,
                halted,
                fault: stopped.then_some(fault),
            }));
        }
        _ => return None,
    }))
}

fn gone(line: &str) -> LevelError {
    LevelError::Tool {
        tool: VERILATOR.name,
        message: format!("the simulation of the board said {line:?}"),
    }
}

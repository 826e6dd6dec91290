//! Replays the inputs of a run of the model to the exported Verilog in Icarus or Verilator.
//!
//! The host runs once, with the model. Its inputs are then applied to the Verilog cycle by cycle.
//! The outputs must equal those of the model in every clock. The words of state, of which there are
//! some in almost every clock, are compared by a checksum.

use crate::bench;
use crate::engine::{EngineHost, Events};
use crate::tool::{self, ICARUS, VERILATOR, VVP};
use crate::verilator::Simulation;
use crate::{Halt, HowFar, Level, LevelError, halted, how_far, no_verilog};
use carrystep_core::engine::{EngineInputs, EngineOutputs, is_recorded, ports_of};
use carrystep_core::ports::{Direction, Port};
use carrystep_core::{EngineBuild, Program};
use carrystep_model::Engine;
use carrystep_tools::kept;
use std::fmt::Write as _;
use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// P (low and high word), position and discarded steps of each axis.
pub type Kept = Vec<[u32; 4]>;

/// A recorded run of the model: its inputs and its outputs.
#[derive(Debug, Clone)]
pub struct Recording {
    /// Inputs, each with the number of cycles for which it was applied.
    pub stimuli: Vec<(u64, EngineInputs)>,
    /// Outputs of each cycle in which any of them changed, words of state aside.
    pub outputs: Vec<(u64, EngineOutputs)>,
    /// For each of these cycles, the checksum of the words of state before it.
    sums: Vec<u64>,
    /// The checksum of all words of state.
    sum: u64,
    /// Total number of cycles.
    pub clocks: u64,
    /// What is kept at the end.
    pub kept: Kept,
    /// Whether the engine has several latches, and their ports.
    several: bool,
    /// Number of adders of the engine.
    adders: usize,
    /// [`Self::text`] and [`Self::lines`], made once: a recording may be replayed on hundreds of
    /// mutants.
    text: OnceLock<String>,
    lines: OnceLock<Vec<Line>>,
}

impl Recording {
    /// Runs a program with its events on the model until the program is over and all axes rest, or
    /// for `max_clocks`. Adds the ticks of rest after which every step has been counted.
    pub fn new(build: &EngineBuild, program: &Program, events: &Events, max_clocks: u64) -> Self {
        Self::of(build, EngineHost::new(build, program, events), max_clocks, &[], None)
    }

    /// As [`Self::new`], for any host; ends early if `halt` is set.
    pub(super) fn of(
        build: &EngineBuild,
        mut host: EngineHost<'_>,
        max_clocks: u64,
        halt: Halt<'_>,
        how_far: Option<&HowFar>,
    ) -> Self {
        let mut model = Engine::new(build);
        let mut recording = Self {
            stimuli: Vec::new(),
            outputs: Vec::new(),
            sums: Vec::new(),
            sum: 0,
            clocks: 0,
            kept: Kept::default(),
            several: build.has_several_latches(),
            adders: build.adders,
            text: OnceLock::new(),
            lines: OnceLock::new(),
        };
        let settle = settle(build);
        let mut quiet = 0;
        while quiet < settle && recording.clocks < max_clocks && !halted(halt) {
            how_far::tell(how_far, recording.clocks);
            let (inputs, outputs) = host.step(&mut model);
            recording.add(inputs, outputs);
            quiet = if host.is_done() && (outputs.idle || outputs.halted) { quiet + 1 } else { 0 };
        }
        let kept = |axis| {
            let (p, shaper) = (model.fraction(axis), model.shaper(axis));
            [p as u32, (p >> 32) as u32, shaper.position.cast_unsigned(), shaper.discarded]
        };
        recording.kept = (0..build.axes()).map(kept).collect();
        recording
    }

    /// Number of axes of the engine.
    fn axes(&self) -> usize {
        self.kept.len()
    }

    fn add(&mut self, inputs: EngineInputs, outputs: EngineOutputs) {
        match self.stimuli.last_mut() {
            Some((count, same)) if *same == inputs => *count += 1,
            _ => self.stimuli.push((1, inputs)),
        }
        let recorded = outputs.recorded();
        if self.outputs.last().is_none_or(|(_, before)| *before != recorded) {
            self.outputs.push((self.clocks, recorded));
            self.sums.push(self.sum);
        }
        self.sum = outputs.state_sum(self.sum);
        self.clocks += 1;
    }

    /// The stimuli as text, a line for each: the number of cycles, then the inputs in hexadecimal
    /// in the order of the engine's table of ports.
    fn text(&self) -> &str {
        self.text.get_or_init(|| {
            let mut text = String::new();
            for (count, inputs) in &self.stimuli {
                // Writing to a string cannot fail.
                let _ = write!(text, "{count}");
                for value in self.driven(Direction::Input, &inputs.at_ports()) {
                    let _ = write!(text, " {value:x}");
                }
                text.push('\n');
            }
            text
        })
    }

    /// The value of each recorded port of this direction, cut to its width; 0 where it is not
    /// valid.
    fn driven(
        &self,
        direction: Direction,
        values: &[(&str, Option<u64>)],
    ) -> impl Iterator<Item = u64> {
        let recorded = ports_of(direction).zip(values).filter(|(port, _)| self.has(port));
        recorded
            .zip(self.widths(direction))
            .map(|((_, (_, value)), width)| value.unwrap_or(0) & ((1 << width) - 1))
    }

    /// True if the engine has this port and benches print it.
    fn has(&self, port: &Port) -> bool {
        bench::has(self.several, port) && is_recorded(port)
    }

    /// The widths of the ports of this direction that benches print.
    fn widths(&self, direction: Direction) -> impl Iterator<Item = u32> {
        let (axes, ports) = (self.axes(), ports_of(direction).filter(|port| self.has(port)));
        ports.map(move |port| port.width.of(axes))
    }

    /// What a bench has to print.
    fn lines(&self) -> &[Line] {
        self.lines.get_or_init(|| {
            let outputs = self.outputs.iter().zip(&self.sums).map(|((cycle, outputs), sum)| {
                Line::Outputs { cycle: *cycle, bits: self.packed(outputs), sum: *sum }
            });
            outputs.chain([Line::End { sum: self.sum }]).collect()
        })
    }

    /// Packs the outputs in the order of the benches, which is that of the engine's table of ports.
    fn packed(&self, outputs: &EngineOutputs) -> u128 {
        self.widths(Direction::Output)
            .zip(self.driven(Direction::Output, &outputs.at_ports()))
            .fold(0, |all, (width, value)| all << width | u128::from(value))
    }
}

/// Number of cycles of rest after which every step has been counted.
pub(super) fn settle(build: &EngineBuild) -> u64 {
    12 * u64::from(build.timebase.clocks_per_tick())
}

/// The first difference between a recording and its replay on the Verilog of an engine; `None` if
/// there is none. A replay whose output is known from an earlier run is not repeated, see
/// [`kept::difference`].
///
/// # Errors
/// [`LevelError`] if a tool is missing or fails, or if the level has no Verilog.
pub fn difference(
    level: Level,
    verilog: &str,
    recording: &Recording,
) -> Result<Option<String>, LevelError> {
    match level {
        Level::Icarus => {
            tool::find(&ICARUS)?;
            let bench = bench::icarus(recording.several, recording.adders)?;
            let stimuli = recording.text();
            let question = (verilog, &bench, recording.axes(), stimuli);
            kept::difference(&ICARUS, question, recording.lines(), || {
                let folder =
                    tempfile::tempdir().map_err(tool::io("cannot make a temporary folder"))?;
                let files = [("core.v", verilog), ("bench.v", &bench), ("stimuli.txt", stimuli)];
                tool::put(folder.path(), &files)?;
                first_difference(&mut icarus(folder.path(), recording.axes())?, recording)
            })
        }
        Level::Verilator => difference_of_mutant(verilog, 0, recording),
        Level::Fast | Level::Model | Level::RustHdl => Err(no_verilog(level)),
    }
}

/// As [`difference`], in Verilator. If the Verilog contains mutants, `mutant` selects one; 0
/// selects none.
///
/// # Errors
/// [`LevelError`] if a tool is missing or fails.
pub fn difference_of_mutant(
    verilog: &str,
    mutant: usize,
    recording: &Recording,
) -> Result<Option<String>, LevelError> {
    tool::find(&VERILATOR)?;
    let bench = bench::verilator(recording.several, recording.adders)?;
    let flags = format!("-DAXES={}", recording.axes());
    let options = ["-CFLAGS", &flags];
    let top = "carrystep_engine";
    let compiled = Simulation { name: "engine", top, bench: &bench, options: &options };
    let stimuli = recording.text();
    let question = (compiled.hash(verilog), mutant, stimuli);
    kept::difference(&VERILATOR, question, recording.lines(), || {
        let folder = tempfile::tempdir().map_err(tool::io("cannot make a temporary folder"))?;
        tool::put(folder.path(), &[("stimuli.txt", stimuli)])?;
        let mut simulation = Command::new(compiled.compiled(verilog)?);
        simulation.arg(folder.path().join("stimuli.txt")).arg(format!("+mutant={mutant}"));
        first_difference(&mut simulation, recording)
    })
}

/// Runs a simulation until it differs from the recording, or to its end.
fn first_difference(
    simulation: &mut Command,
    recording: &Recording,
) -> Result<Option<String>, LevelError> {
    let mut running = simulation
        .stdout(Stdio::piped())
        .spawn()
        .map_err(tool::io("cannot start the simulation"))?;
    let lines = running.stdout.take().map(|output| BufReader::new(output).lines());
    let mut found = lines.into_iter().flatten().map_while(Result::ok);
    let difference = compare(&mut found, recording);
    // The simulation may have ended, or may still print lines that nobody reads.
    let _ = running.kill();
    running.wait().map_err(tool::io("cannot end the simulation"))?;
    Ok(difference)
}

/// A line of a bench.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Line {
    /// A cycle in which an output changed: the packed outputs, and the checksum of the words of
    /// state before it.
    Outputs { cycle: u64, bits: u128, sum: u64 },
    /// The last line: the checksum of all words of state.
    End { sum: u64 },
}

impl Line {
    /// Parses a line of a bench: cycle, packed outputs and checksum, or `S` and the checksum.
    fn parse(line: &str) -> Option<Self> {
        let (first, rest) = line.split_once(' ')?;
        let sum = |digits| u64::from_str_radix(digits, 16).ok();
        if first == "S" {
            return Some(Self::End { sum: sum(rest)? });
        }
        let (bits, digits) = rest.split_once(' ')?;
        let bits = u128::from_str_radix(bits, 16).ok()?;
        Some(Self::Outputs { cycle: first.parse().ok()?, bits, sum: sum(digits)? })
    }
}

fn compare(found: &mut impl Iterator<Item = String>, recording: &Recording) -> Option<String> {
    for (place, expected) in recording.lines().iter().enumerate() {
        let line = found.next().unwrap_or_else(|| "nothing".to_owned());
        if Line::parse(&line) != Some(*expected) {
            let outputs = recording.outputs.get(place).map(|(_, outputs)| outputs);
            return Some(format!("expected {expected:x?}, {outputs:?}; found {line}"));
        }
    }
    found.next().map(|line| format!("expected nothing more, found {line}"))
}

/// Compiles the Verilog in a folder for Icarus; the command that runs it.
fn icarus(folder: &Path, axes: usize) -> Result<Command, LevelError> {
    let parameter = format!("-Pengine_bench.AXES={axes}");
    let arguments = ["-g2005", &parameter, "-o", "bench.vvp", "bench.v", "core.v"];
    tool::complete(&ICARUS, Command::new(ICARUS.name).args(arguments).current_dir(folder))?;
    let mut simulation = Command::new(VVP.name);
    simulation.args(["-n", "bench.vvp", "+stimuli=stimuli.txt"]).current_dir(folder);
    Ok(simulation)
}

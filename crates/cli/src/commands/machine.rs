//! `carrystep machine new`: makes a machine file from options or answers, and reads it back as any
//! machine file before it is written.

mod ask;
mod axis;

use crate::arguments::{MachineArguments as Arguments, MachineCommand, MachineNew};
use crate::commands::boards;
use crate::failure::Failure;
use crate::output::{self, OutputFile};
use axis::AxisKeys;
use carrystep_boards::Board;
use carrystep_core::tick::{Ticks, mhz};
use carrystep_core::{ChosenTick, Timebase};
use carrystep_files::{InputError, Machine, SourceText};
use carrystep_verilog::Gateware;
use schemars::JsonSchema;
use serde::Serialize;
use std::borrow::Cow;
use std::io::IsTerminal as _;
use std::path::Path;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct WrittenMachine<'a> {
    passed: bool,
    file: &'a Path,
    clock_hz: u64,
    tick_ns: u64,
    phases: u32,
    axes: Vec<String>,
    build_id: String,
}

/// The source of the clock.
pub enum ClockSource {
    Board(Box<Cow<'static, Board>>),
    Hz(u64),
}

/// The content of the new file, as far as it is known.
pub struct Wishes {
    clock: Option<ClockSource>,
    limits: Option<String>,
    axes: Vec<AxisKeys>,
}

/// Runs a subcommand of `machine`.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        MachineCommand::New(new) => self::new(new),
    }
}

/// Writes a new machine file.
fn new(arguments: &MachineNew) -> Result<(), Failure> {
    let path = &arguments.file;
    if path.exists() && !arguments.force {
        let message = format!("{} is there already", path.display());
        return Err(Failure::Input(
            InputError::new(message).help("take another name, or replace it with --force"),
        ));
    }
    let board = arguments
        .board
        .as_deref()
        .map(boards::find)
        .transpose()?
        .map(|board| ClockSource::Board(Box::new(board)));
    let mut wishes = Wishes {
        clock: board.or(arguments.clock_hz.map(ClockSource::Hz)),
        limits: arguments.limits.clone(),
        axes: arguments
            .axes
            .iter()
            .map(|option| AxisKeys::parse(option))
            .collect::<Result<_, _>>()?,
    };
    let missing = wishes.missing();
    if !missing.is_empty() {
        if !std::io::stdin().is_terminal() {
            let help = "give them as options, or run it on a terminal, where it asks; --help has an example";
            let message = format!(
                "to write {} these are missing:\n  {}",
                path.display(),
                missing.join("\n  ")
            );
            return Err(Failure::Input(InputError::new(message).help(help)));
        }
        ask::complete(&mut wishes)?;
    }
    let source = SourceText { path: path.clone(), text: wishes.text()?.into() };
    let (machine, build_id) = wishes.check(&source)?;
    let mut file = OutputFile::create(path)?;
    file.text(&source.text)?;
    file.keep()?;
    let timebase = &machine.timebase;
    let written = WrittenMachine {
        passed: true,
        file: path,
        clock_hz: timebase.clock_hz(),
        tick_ns: timebase.tick_ns(),
        phases: timebase.phases(),
        axes: machine.axes.iter().map(|axis| axis.name.clone()).collect(),
        build_id,
    };
    if arguments.json {
        return output::print_json(&written);
    }
    let WrittenMachine { clock_hz, tick_ns, phases, axes, build_id, .. } = &written;
    let shown = path.display();
    let next = match &wishes.clock {
        Some(ClockSource::Board(board)) => {
            format!("carrystep build --board {} --machine {shown}", board.name)
        }
        _ => format!("carrystep verilog --machine {shown}"),
    };
    output::print(&format!(
        "wrote {shown}: axes {}, {} MHz, ticks of {tick_ns} ns in {phases} phases, build {build_id}\n\
         its gateware: {next}\nname it in a move file: machine_file = {:?}\n",
        axes.join(", "),
        mhz(*clock_hz),
        path.file_name().unwrap_or_default()
    ))
}

impl Wishes {
    /// The open points, one line each.
    fn missing(&self) -> Vec<String> {
        let mut missing = Vec::new();
        if self.clock.is_none() {
            missing.push("--board BOARD, or --clock-hz HZ".to_owned());
        }
        if self.limits.is_none() {
            missing.push("--limits pair, each, one or none".to_owned());
        }
        if self.axes.is_empty() {
            missing.push("--axis NAME,KEY=VALUE,... for each axis".to_owned());
        }
        for axis in &self.axes {
            missing.extend(
                axis.missing()
                    .into_iter()
                    .map(|(_, ways)| format!("of axis {}: {ways}", axis.name)),
            );
        }
        missing
    }

    /// The text of the file.
    fn text(&self) -> Result<String, Failure> {
        let (clock_hz, tick_ns, phases, why) = self.time()?;
        let title = match &self.clock {
            Some(ClockSource::Board(board)) => format!(" for the {}", board.title),
            _ => String::new(),
        };
        let link = match &self.clock {
            Some(ClockSource::Board(board)) => {
                let baud =
                    board.uart(clock_hz).map_err(|error| Failure::input(error.to_string()))?.baud();
                format!(
                    "\n[machine.link]\nbaud = {baud:<21} # the fastest that board and clock make exactly enough\n"
                )
            }
            _ => String::new(),
        };
        let queues = match &self.clock {
            Some(ClockSource::Board(board)) => {
                let depth = format!("queue_depth = {}", board.queue_depth);
                format!(
                    "{depth:<28} # segments that wait for an axis: the most that fit the board\n"
                )
            }
            _ => String::new(),
        };
        let limits = self.limits.as_deref().unwrap_or("none");
        let clock = format!("clock_hz = {clock_hz}");
        let tick = format!("tick_ns = {tick_ns}");
        let phased = format!("phases = {phases}");
        let wired = format!("limits = {limits:?}");
        let axes: Vec<String> = self.axes.iter().map(AxisKeys::text).collect();
        Ok(format!(
            "# A machine{title}, written by `carrystep machine new`. Every key is explained in docs/machine-files.md.\n\
             [machine]\n\
             {clock:<28} # Hz\n\
             {tick:<28} # from one addition to the next: {why}\n\
             {phased:<28} # an edge is placed to a tick divided by this\n\
             {queues}\
             \n\
             [machine.guard]\n\
             {wired:<28} # pair: two switches an axis, each: one an axis, one: one for all, none\n\
             {:<28} # the level of a limit that is reached: a switch that opens, with a pull-up\n\
             {:<28} # the level of an e-stop that is pressed; tie the pin low where there is none\n\
             {:<28} # silence of the host after which all axes ramp down\n\
             {link}\n{}",
            "limit_level = \"high\"",
            "estop = \"high\"",
            "watchdog_ms = 100",
            axes.join("\n")
        ))
    }

    /// Clock (Hz), tick (ns), number of phases, and the reason for this tick.
    fn time(&self) -> Result<(u64, u64, u32, String), Failure> {
        let axes = self.axes.len();
        let no_tick = |hz: u64| {
            Failure::input(format!(
                "no tick at {} MHz holds the time slots of {axes} axes",
                mhz(hz)
            ))
        };
        match self.clock.as_ref() {
            Some(ClockSource::Board(board)) => {
                let clocking = &board.clocks[0];
                let (hz, phases) = (clocking.clock_hz, clocking.phases);
                let fits = Timebase::new(hz, clocking.tick_ns, phases)
                    .is_ok_and(|time| carrystep_core::engine::check_schedule(axes, &time).is_ok());
                if fits {
                    return Ok((hz, clocking.tick_ns, phases, "the board's".to_owned()));
                }
                let tick_ns = Ticks::for_engine(hz, phases, axes).ok_or_else(|| no_tick(hz))?;
                Ok((hz, tick_ns, phases, format!("the shortest that {axes} axes take")))
            }
            Some(&ClockSource::Hz(hz)) => {
                let chosen = ChosenTick::new(hz, 16, axes).ok_or_else(|| no_tick(hz))?;
                let why = "the shortest that these axes take".to_owned();
                match chosen.fewer_phases_ns {
                    Some(shorter) => Ok((
                        hz,
                        shorter,
                        4,
                        format!("{why}; in 16 phases it would be {}", chosen.tick_ns),
                    )),
                    None => Ok((hz, chosen.tick_ns, 16, why)),
                }
            }
            None => Err(Failure::input("no clock")),
        }
    }

    /// Reads the text as any machine file is read, and checks that its engine can be built, on the
    /// board if there is one.
    fn check(&self, source: &SourceText) -> Result<(Machine, String), Failure> {
        let machine = Machine::from_source(source)?;
        let refused = |error: String| Failure::input(format!("{}: {error}", source.path.display()));
        let engine = machine.engine();
        engine.check().map_err(|error| refused(error.to_string()))?;
        if let Some(ClockSource::Board(board)) = &self.clock {
            Gateware::new(board, board.part(None)?, source.clone())?;
        }
        let line = machine.line().map_err(|error| refused(error.to_string()))?;
        let id = line.build_id(&engine).to_string();
        Ok((machine, id))
    }
}

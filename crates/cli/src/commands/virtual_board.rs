//! `carrystep virtual-board`: runs the gateware of a machine behind a pseudo-terminal.

use crate::arguments::{BoardLevel, VirtualBoard};
use crate::connection;
use crate::failure::Failure;
use crate::gateware;
use crate::operated::{OperatedBoard, ahead};
use crate::output::{self, OutputFile};
use crate::switches::SwitchPanel;
use carrystep_check::{OwnCapture, PinsVcd};
use carrystep_core::EngineBuild;
use carrystep_core::engine::EngineOutputs;
use carrystep_files::Machine;
use carrystep_simulators::pins::PinFeed;
use carrystep_simulators::replay::Replay;
use carrystep_virtual_board::{
    ModelBoard, Pace, RealTimeBoard, SimulatedBoard, Terminal, VerilatedBoard,
};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct Served {
    passed: bool,
    /// Time of the board, in seconds.
    seconds: f64,
    clocks: u64,
    fault: Option<String>,
    axes: Vec<AxisServed>,
    files: Vec<PathBuf>,
}

#[derive(JsonSchema, Serialize)]
struct AxisServed {
    axis: String,
    position: i32,
    /// Discarded steps, if the level can report them.
    discarded: Option<u32>,
}

/// Runs until Ctrl-C, or `end` on standard input.
pub fn run(arguments: &VirtualBoard) -> Result<(), Failure> {
    let machine = Machine::load(&arguments.machine)?;
    let (uart, _) = connection::wanted(&machine, &arguments.machine)?;
    let build = machine.engine();
    match arguments.level {
        BoardLevel::Model => serve(ModelBoard::new(&build, uart), &machine, arguments),
        BoardLevel::Verilator => serve(VerilatedBoard::new(&build, uart)?, &machine, arguments),
    }
}

fn serve(
    board: impl SimulatedBoard,
    machine: &Machine,
    arguments: &VirtualBoard,
) -> Result<(), Failure> {
    let build = machine.engine();
    let (uart, id) = connection::wanted(machine, &arguments.machine)?;
    let panel = SwitchPanel::new(machine, &arguments.min, &arguments.max, &arguments.probe)?;
    let mut vcd = arguments.vcd.as_deref().map(OutputFile::create).transpose()?;
    let terminal =
        Terminal::new().map_err(|error| Failure::Run(format!("no pseudo-terminal: {error}")))?;
    let told = format!("{}: {} baud, build {}\n", terminal.name(), uart.baud(), id);
    if arguments.json {
        // If this write fails, there is no channel left to report it.
        let _ = std::io::stderr().write_all(told.as_bytes());
    } else {
        output::print(&told)?;
    }
    let clock_hz = build.timebase.clock_hz();
    let pace =
        if arguments.fast { Pace::fast(clock_hz, ahead(&build)) } else { Pace::real(clock_hz) };
    let mut operated =
        OperatedBoard { real_time: RealTimeBoard::new(board, terminal, pace, clock_hz), panel };
    match &mut vcd {
        None => while operated.step(&mut ())? {},
        Some(out) => capture(&mut operated, machine, &build, out)?,
    }
    let files = vcd.map(OutputFile::appear).transpose()?.into_iter().collect();
    tell(&served(&operated.real_time.board, machine, files), arguments.json)
}

/// Runs the board and records its pins. The capture begins at the first start, because no pin
/// changes before it.
fn capture(
    operated: &mut OperatedBoard<impl SimulatedBoard>,
    machine: &Machine,
    build: &EngineBuild,
    out: &mut OutputFile,
) -> Result<(), Failure> {
    let goes_on = operated.until_start()?;
    let time = build.timebase;
    let load = operated.real_time.board.loads().first().copied().unwrap_or(0);
    let origin_ps = time.clock_to_ps(load + time.latency_clocks()).cast_signed();
    let names = machine.axes.iter().map(|axis| axis.name.as_str());
    let own = OwnCapture { origin_ps, timebase: time, is_part: false };
    let mut vcd = PinsVcd::new(out, own, names, gateware::output_pins(build))?;
    let mut feed = PinFeed::new(time, machine.axes.len(), &mut vcd);
    let mut tell = |cycle: u64, outputs: &EngineOutputs| {
        feed.pins(cycle, outputs.step, outputs.dir);
        feed.outputs(cycle, outputs.outputs);
        feed.pwm(cycle, outputs.pwm);
    };
    let mut replay = Replay::new(&build.pins, &mut tell).with_pwm(build.outputs.pwm_divider);
    while goes_on && operated.step(&mut replay)? {
        replay.reach(operated.real_time.board.cycle());
    }
    // The replay reports the last outputs when the next cycle begins.
    replay.reach(operated.real_time.board.cycle() + 1);
    Ok(feed.end(operated.real_time.board.cycle())?)
}

fn served(board: &impl SimulatedBoard, machine: &Machine, files: Vec<PathBuf>) -> Served {
    let axis = |(number, axis): (usize, &carrystep_files::Axis)| AxisServed {
        axis: axis.name.clone(),
        position: board.position(number),
        discarded: board.discarded(number),
    };
    Served {
        passed: true,
        seconds: board.cycle() as f64 / machine.engine().timebase.clock_hz() as f64,
        clocks: board.cycle(),
        fault: board.fault().map(gateware::told),
        axes: machine.axes.iter().enumerate().map(axis).collect(),
        files,
    }
}

fn tell(served: &Served, json: bool) -> Result<(), Failure> {
    if json {
        return output::print_json(served);
    }
    let mut text = format!("{:.3} s of the board's time\n", served.seconds);
    // Writing to a string cannot fail.
    for AxisServed { axis, position, discarded } in &served.axes {
        let lost = discarded
            .filter(|&count| count > 0)
            .map_or(String::new(), |count| format!(", {count} discarded"));
        let _ = writeln!(text, "{axis} at {position}{lost}");
    }
    if let Some(fault) = &served.fault {
        let _ = writeln!(text, "stopped: {fault}");
    }
    for file in &served.files {
        let _ = writeln!(text, "wrote {}", file.display());
    }
    output::print(&text)
}

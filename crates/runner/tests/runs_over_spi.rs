//! A program on six axes over SPI, with the parts of `carrystep run` that know no serial port: its
//! pulses are those over a UART, and those that `carrystep simulate` makes. Held, and with an
//! override, it ends at the same place. What has gone over the bus then reaches the exported Verilog
//! in the same clocks: all pins are the same in every clock.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::support::bus::Bus;
use crate::support::recorder::{Recorder, Recording, edges_between};
use crate::support::wire::Faults;
use crate::support::{End, SESSION};
use carrystep_core::Command;
use carrystep_core::link::{LineKind, Uart};
use carrystep_files::{Machine, SourceText};
use carrystep_job::{Hold, Pace};
use carrystep_link::{Clock, Ended, Host, Line, Patience, Progress, Wish};
use carrystep_model::fast::{Change, Edge};
use carrystep_program::{ProgramFile, Rows, Settings};
use carrystep_runner::{OverrideSetting, Stretches, Wait, kept_ticks};
use carrystep_simulators::Level;
use carrystep_simulators::engine::run::EngineJob;
use carrystep_virtual_board::{ModelBoard, PinLevels, SimulatedBoard as _, VerilatedBoard};
use std::cell::RefCell;
use std::fmt::Debug;
use std::rc::Rc;
use tempfile::TempDir;

/// The clock, Hz, the clocks of a millisecond, and the rate of the bus. They are slow, because each
/// clock of the Verilog and each edge of the bus takes the simulation time.
const CLOCK_HZ: u64 = 12_000_000;
const MS: u64 = CLOCK_HZ / 1000;
const SCK_HZ: u64 = 1_000_000;

/// All axes move, and output 2 is switched in motion.
const JOB: &str = "G21 G90 G64 P0.05 F3000\nM3 S12000\nG1 X3 Y2 A10\nM62 P2\nG3 X3 Y2 I-1 J1 B6 C9\n\
    M63 P2\nG1 X-2 Z0.6 A-5\nG1 X0 Y0.5 Z0 B0 C-3\nM2\n";

/// Where it ends, steps.
const END: [i32; 6] = [0, 40, 0, -200, 0, -30];

fn machine(link: &str) -> Machine {
    let mut text = format!(
        "[machine]\nclock_hz = {CLOCK_HZ}\ntick_ns = 8000\nqueue_depth = 31\ncuts = true\n\
         [machine.link]\n{link}\n[machine.outputs]\ncount = 3\npwm_divider = 2\nspindle = 0\n\
         spindle_rpm = 24_000\n"
    );
    for (name, steps, driver) in [
        ("x", 80, "tmc2209"),
        ("y", 80, "a4988"),
        ("z", 400, "drv8825"),
        ("a", 40, "dm542"),
        ("b", 44, "tmc5160"),
        ("c", 10, "tb6600"),
    ] {
        text += &format!(
            "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = {steps}\nspeed_limit = 150\n\
             accel_limit = 4000\ndriver = \"{driver}\"\n"
        );
    }
    Machine::from_source(&SourceText { path: "machine.toml".into(), text: text.into() }).unwrap()
}

/// The program on a machine, and the folder in which it is.
struct Job {
    machine: Machine,
    file: ProgramFile,
    _folder: TempDir,
}

fn job(link: &str) -> Job {
    let (machine, folder) = (machine(link), tempfile::tempdir().unwrap());
    let path = folder.path().join("job.ngc");
    std::fs::write(&path, JOB).unwrap();
    let settings = Settings::default();
    let file =
        ProgramFile::open(&path, machine.clone(), "machine.toml".as_ref(), settings).unwrap();
    Job { machine, file, _folder: folder }
}

/// What is asked of a program, and when, ms of the board's time.
#[derive(Debug, Clone, Copy)]
enum Request {
    Hold(u64),
    Feed(u64, u8),
}

/// Streams the program, and returns the number of cuts and of holds. `now` is the board's cycle.
fn drives<L: Line, C: Clock, const N: usize>(
    host: &mut Host<L, C, N>,
    file: &ProgramFile,
    requests: &[Request],
    now: impl Fn() -> u64,
) -> (u32, usize)
where
    L::Error: Debug + PartialEq,
{
    let machine = file.machine();
    let rows = Rows::new(file).unwrap().map(Result::unwrap);
    let (hold, kept) = (Hold::new(machine).unwrap(), kept_ticks(machine.timebase.tick_ns()));
    let start = file.start_steps();
    let pace = Pace::new(machine, &start).unwrap();
    let stretches = Stretches::new(rows, &start, hold, pace, machine.queue).with_cuts(kept);
    let stretches = RefCell::new(stretches);
    host.enable().unwrap();
    let (mut cuts, mut holds) = (0, 0);
    while let Some(waits) = { stretches.borrow_mut().begin() } {
        holds += waits.iter().filter(|wait| matches!(wait, Wait::Hold(_))).count();
        let mut granted = 0;
        let ended = host.stream(&stretches, |progress: &Progress<'_>| {
            let (queues, mut stretches) = (progress.queues.unwrap(), stretches.borrow_mut());
            granted = queues.cuts;
            let mut wish = Wish::GoOn;
            for request in requests {
                let keep = match *request {
                    Request::Hold(at) if now() >= at * MS && holds == 0 && !stretches.is_held() => {
                        stretches.hold_in(queues)
                    }
                    Request::Feed(at, feed)
                        if now() >= at * MS && stretches.overrides().feed != feed =>
                    {
                        let wanted = OverrideSetting { feed, ..OverrideSetting::NONE };
                        stretches.set_overrides_in(wanted, queues)
                    }
                    _ => continue,
                };
                if let Some(keep) = keep {
                    wish = Wish::Cut { keep };
                    break;
                }
            }
            wish
        });
        assert_eq!(ended, Ok(Ended::Done));
        cuts += granted;
    }
    assert_eq!(host.status().positions[..6], END);
    (cuts, holds)
}

/// What a run has done.
struct Run {
    recording: Recording,
    /// The cycle in which the first segments were loaded.
    load: u64,
    cuts: u32,
    holds: usize,
}

impl Run {
    fn new(board: Recorder, (cuts, holds): (u32, usize)) -> Self {
        let load = board.loads()[0];
        Self { recording: board.finish(), load, cuts, holds }
    }

    fn seen(&self) -> Seen {
        since(self.load, &self.recording.edges, &self.recording.levels)
    }
}

fn over_uart(Job { machine, file, .. }: &Job) -> Run {
    let (engine, uart) = (machine.engine(), Uart::new(CLOCK_HZ, machine.baud).unwrap());
    let board = Recorder::new(ModelBoard::new(&engine, uart));
    let end = End::of(board, uart, Faults::default(), 1).clocked(CLOCK_HZ, 1);
    let mut host = end.connect_to(uart.build_id(&engine), Patience::default()).unwrap();
    host.open(SESSION).unwrap();
    let asked = drives(&mut host, file, &[], || end.0.borrow().board.cycle());
    drop(host);
    Run::new(Rc::into_inner(end.0).unwrap().into_inner().board, asked)
}

fn over_spi(Job { machine, file, .. }: &Job, requests: &[Request]) -> Run {
    let engine = machine.engine();
    let board = Recorder::new(ModelBoard::on_spi(&engine, SCK_HZ));
    let bus = Bus::of(board, SCK_HZ, Faults::default(), 1).clocked(CLOCK_HZ);
    let mut host = bus.connect_to(LineKind::Spi.build_id(&engine));
    let asked = drives(&mut host, file, requests, || bus.0.borrow().board.cycle());
    drop(host);
    Run::new(Rc::into_inner(bus.0).unwrap().into_inner().board, asked)
}

/// The edges from a cycle on, and the levels of the outputs, with clocks counted from there.
type Seen = (Vec<Edge>, Vec<(u64, u8)>);

fn since(load: u64, edges: &[Edge], levels: &[(u64, u8)]) -> Seen {
    let edges = edges.iter().map(|edge| Edge { clock: edge.clock - load, ..*edge }).collect();
    (edges, levels.iter().map(|&(clock, levels)| (clock - load, levels)).collect())
}

/// Those that the rows make on the engine's own host, as `carrystep simulate` runs them.
fn simulated(Job { machine, file, .. }: &Job) -> Seen {
    let engine = machine.engine();
    let (mut program, mut ticks, mut outputs) = (Vec::new(), 0, file.row_outputs());
    for row in Rows::new(file).unwrap().map(Result::unwrap) {
        program.extend(
            Some(outputs.change(&row)).filter(|change| !change.is_none()).map(Command::Outputs),
        );
        program.extend(
            (0..).zip(row.segments).map(|(axis, segment)| Command::Segment { axis, segment }),
        );
        if ticks == 0 {
            program.push(Command::Start { mask: 0b11_1111 });
        }
        ticks += u64::from(row.ticks);
    }
    let (mut edges, mut levels, mut load) = (Vec::new(), Vec::new(), 0);
    let mut before = PinLevels::default();
    EngineJob::new(&engine, &program, ticks)
        .run(Level::Fast, &mut |clock, now| {
            let pins = PinLevels { step: now.step, dir: now.dir, outputs: now.outputs, ..before };
            edges.extend(edges_between(clock, before, pins));
            if pins.outputs != before.outputs {
                levels.push((clock, pins.outputs));
            }
            before = pins;
            if now.started {
                load = clock + 1;
            }
        })
        .unwrap();
    since(load, &edges, &levels)
}

/// The pulses of an axis, without their times.
fn pulses(recording: &Recording, axis: u8) -> Vec<bool> {
    let is_pulse = |edge: &&Edge| edge.axis == axis && edge.change == Change::Rise;
    recording.edges.iter().filter(is_pulse).map(|edge| edge.backward).collect()
}

#[test]
fn pulses_over_spi_are_those_over_uart_and_those_of_the_plan() {
    let [spi, uart] = ["spi = true", "baud = 1_500_000"].map(job);
    let planned = simulated(&spi);
    assert!(planned.0.len() > 2000 && planned.1.len() == 4, "{} edges", planned.0.len());
    assert!(planned == simulated(&uart), "the line changes the plan");
    assert!(over_spi(&spi, &[]).seen() == planned, "over SPI");
    assert!(over_uart(&uart).seen() == planned, "over UART");
}

#[test]
fn held_run_over_spi_replayed_on_the_verilog_is_the_same_in_every_clock() {
    let job = job("spi = true");
    let engine = job.machine.engine();
    let plain = over_spi(&job, &[]);
    let begun = plain.load / MS;
    let held = over_spi(&job, &[Request::Hold(begun + 60), Request::Feed(begun + 200, 50)]);
    assert_eq!((held.cuts, held.holds), (2, 1));
    let recording = &held.recording;
    for axis in 0..6 {
        assert_eq!(pulses(recording, axis), pulses(&plain.recording, axis), "axis {axis}");
    }
    let pins = recording.pins(ModelBoard::on_spi(&engine, SCK_HZ));
    let verilog = || VerilatedBoard::on_spi(&engine, SCK_HZ).unwrap();
    assert_eq!(recording.difference(verilog(), &pins), None);
    eprintln!(
        "{} clocks, {} bytes each way, {} changes of pins: no difference",
        recording.clocks,
        recording.answers.len(),
        pins.len(),
    );
    assert!(recording.with_a_wrong_bit().difference(verilog(), &pins).is_some(), "a wrong bit");
}

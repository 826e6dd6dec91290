//! The programs that are shipped, on a board of models: driven with the parts of `carrystep run`
//! that know no serial port, and as `carrystep simulate` runs them. Time is the board's.
//!
//! ```text
//! program -> rows -> Stretches -> Host::stream -> line -> ModelBoard -> edges, levels of outputs
//!              '---> EngineJob at the fast level -----------------------> the same
//! ```
//!
//! A board may rest for any time between two stretches, and `simulate` does not. So clocks are
//! counted from where each stretch would begin if it followed the one before at once.

use crate::support::bus::Bus;
use crate::support::recorder::{Recorder, edges_between};
use crate::support::wire::Faults;
use crate::support::{Died, End, SESSION};
use carrystep_core::Command;
use carrystep_core::link::{LineKind, Uart};
use carrystep_files::{Machine, SourceText};
use carrystep_job::{Hold, Pace};
use carrystep_link::{Clock, Ended, Host, HostError, Line, Patience, Progress, Wish};
use carrystep_model::fast::Edge;
use carrystep_program::{ProgramFile, Row, Rows, Settings, sync_points};
use carrystep_runner::Stretches;
use carrystep_simulators::Level;
use carrystep_simulators::engine::run::EngineJob;
use carrystep_virtual_board::{ModelBoard, PinLevels, SimulatedBoard as _};
use std::cell::RefCell;
use std::path::Path;
use std::rc::Rc;

/// The shipped programs with their machines, in `sim`.
pub const PROGRAMS: [(&str, &str); 7] = [
    ("jobs/square_and_arc.ngc", "jobs/machine.toml"),
    ("jobs/outputs.ngc", "jobs/outputs.toml"),
    ("jobs/laser.ngc", "jobs/laser.toml"),
    ("touch_off.ngc", "touch_off.toml"),
    ("jobs/chords_and_star.ngc", "jobs/machine.toml"),
    ("jobs/trochoid.ngc", "jobs/machine.toml"),
    ("jobs/relief.ngc", "jobs/machine.toml"),
];

/// The rows of a program that a board works through.
pub type Way = RefCell<Stretches<Box<dyn Iterator<Item = Row>>>>;

/// A program and its machine.
pub struct Job {
    pub name: &'static str,
    pub machine: Machine,
    file: ProgramFile,
    /// The tick in which each stretch begins if nothing comes between them.
    begins: Vec<u64>,
    /// The length of the program.
    ticks: u64,
}

impl Job {
    /// A program with its machine as it is shipped, but for these lines in the table `[machine]`.
    pub fn new((name, machine): (&'static str, &str), lines: &str) -> Self {
        let sim = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim");
        let shipped = std::fs::read_to_string(sim.join(machine)).unwrap();
        let text = shipped.replacen("[machine]\n", &format!("[machine]\n{lines}"), 1);
        assert!(lines.is_empty() || text != shipped, "{machine} has a table [machine]");
        let text = SourceText { path: machine.into(), text: text.into() };
        let machine = Machine::from_source(&text).unwrap();
        let settings = Settings::default();
        let file = ProgramFile::open(&sim.join(name), machine.clone(), &text.path, settings);
        let file = file.unwrap();
        let (mut begins, mut ticks) = (vec![0], 0);
        for row in Rows::new(&file).unwrap().map(Result::unwrap) {
            if ticks > 0 && sync_points(&row).next().is_some() {
                begins.push(ticks);
            }
            ticks += u64::from(row.ticks);
        }
        Self { name, machine, file, begins, ticks }
    }

    /// Clocks of the gateware in a millisecond.
    pub fn ms(&self) -> u64 {
        self.machine.timebase.clock_hz() / 1000
    }

    /// How long the program lasts, waits left out, s.
    pub fn seconds(&self) -> f64 {
        self.ticks as f64 * self.machine.timebase.tick_seconds()
    }

    fn clocks_per_tick(&self) -> u64 {
        self.machine.timebase.clocks_per_tick().into()
    }

    /// Drives a board through the program. `look` is called after each exchange with the line.
    pub fn run(&self, look: impl FnMut(&End<Recorder>, &Way, &Progress<'_>) -> Wish) -> Run {
        self.run_with(|_| (), look)
    }

    /// The same, with what is set before anything is sent.
    pub fn run_with(
        &self,
        set: impl FnOnce(&Way),
        mut look: impl FnMut(&End<Recorder>, &Way, &Progress<'_>) -> Wish,
    ) -> Run {
        let machine = &self.machine;
        let (time, way) = (&machine.timebase, self.way());
        set(&way);
        let (engine, uart) = (machine.engine(), Uart::new(time.clock_hz(), machine.baud).unwrap());
        let board = Recorder::new(ModelBoard::new(&engine, uart));
        let end = End::of(board, uart, Faults::default(), 1).clocked(time.clock_hz(), 1);
        let mut host = end.connect_to(uart.build_id(&engine), Patience::default()).unwrap();
        host.open(SESSION).unwrap();
        host.enable().unwrap();
        let ended = drive(&mut host, &way, |progress| look(&end, &way, progress));
        drop(host);
        let board = Rc::into_inner(end.0).unwrap().into_inner().board;
        Run::of(board, ended)
    }

    /// Drives a board on an SPI bus of this rate, Hz, through the program. `look` is called after
    /// each exchange.
    pub fn run_on_bus(&self, sck_hz: u64, mut look: impl FnMut(&Bus<Recorder>) -> Wish) -> Run {
        let machine = &self.machine;
        let (engine, way) = (machine.engine(), self.way());
        let board = Recorder::new(ModelBoard::on_spi(&engine, sck_hz));
        let bus = Bus::of(board, sck_hz, Faults::default(), 1);
        let bus = bus.clocked(machine.timebase.clock_hz());
        let mut host = bus.connect_to(LineKind::Spi.build_id(&engine));
        host.enable().unwrap();
        let ended = drive(&mut host, &way, |_| look(&bus));
        drop(host);
        let board = Rc::into_inner(bus.0).unwrap().into_inner().board;
        Run::of(board, Ok(ended.unwrap()))
    }

    /// The rows of the program, as `run` sends them.
    fn way(&self) -> Way {
        let Self { machine, file, .. } = self;
        let rows: Box<dyn Iterator<Item = Row>> =
            Box::new(Rows::new(file).unwrap().map(Result::unwrap));
        let (start, hold) = (file.start_steps(), Hold::new(machine).unwrap());
        let pace = Pace::new(machine, &start).unwrap();
        let way = Stretches::new(rows, &start, hold, pace, machine.queue);
        let way = way.with_outputs(file.row_outputs());
        RefCell::new(way.for_holds(machine.cuts, machine.timebase.tick_ns()))
    }

    /// What a run has done, with clocks as those of [`Self::simulated`], up to this tick of the plan.
    pub fn seen(&self, run: &Run, until: u64) -> Pins {
        assert!(run.loads.len() <= self.begins.len(), "a stretch that the plan does not have");
        let per_tick = self.clocks_per_tick();
        let since = |clock: u64| {
            let stretch = run.loads.partition_point(|&load| load <= clock) - 1;
            clock - run.loads[stretch] + self.begins[stretch] * per_tick
        };
        let pins = Pins {
            edges: run
                .edges
                .iter()
                .map(|edge| Edge { clock: since(edge.clock), ..*edge })
                .collect(),
            levels: run.levels.iter().map(|&(clock, levels)| (since(clock), levels)).collect(),
        };
        pins.until(until.saturating_mul(per_tick))
    }

    /// What the segments do in the fast model, as `carrystep simulate` runs them, up to this tick.
    /// Clocks are counted from the one in which the first segments are loaded.
    pub fn simulated(&self, until: u64) -> Pins {
        let engine = self.machine.engine();
        let (mut program, mut ticks, mut outputs) = (Vec::new(), 0, self.file.row_outputs());
        let mut rows = Rows::new(&self.file).unwrap().map(Result::unwrap);
        while let Some(row) = rows.next().filter(|_| ticks < until) {
            let whole = ticks + u64::from(row.ticks) >= until;
            let change = Some(outputs.change(&row)).filter(|change| !change.is_none());
            program.extend(change.map(Command::Outputs));
            let axes = row.segments.len();
            program.extend((0..).zip(row.segments).map(|(axis, mut segment)| {
                segment.last |= whole;
                Command::Segment { axis, segment }
            }));
            if ticks == 0 {
                program.push(Command::Start { mask: ((1_u16 << axes) - 1) as u8 });
            }
            ticks += u64::from(row.ticks);
        }
        let (mut pins, mut load, mut before) = (Pins::default(), 0, PinLevels::default());
        EngineJob::new(&engine, &program, ticks)
            .run(Level::Fast, &mut |clock, now| {
                let levels =
                    PinLevels { step: now.step, dir: now.dir, outputs: now.outputs, ..before };
                pins.edges.extend(edges_between(clock, before, levels));
                if levels.outputs != before.outputs {
                    pins.levels.push((clock, levels.outputs));
                }
                before = levels;
                if now.started {
                    load = clock + 1;
                }
            })
            .unwrap();
        pins.edges.iter_mut().for_each(|edge| edge.clock -= load);
        pins.levels.iter_mut().for_each(|(clock, _)| *clock -= load);
        pins.until(until.saturating_mul(self.clocks_per_tick()))
    }
}

/// Drives a board through all stretches, as long as they are done. Returns how the last one ended.
fn drive<L: Line, C: Clock, const N: usize>(
    host: &mut Host<L, C, N>,
    way: &Way,
    mut look: impl FnMut(&Progress<'_>) -> Wish,
) -> Result<Ended, HostError<L::Error>> {
    let mut ended = Ok(Ended::Done);
    while matches!(ended, Ok(Ended::Done)) && { way.borrow_mut().begin() }.is_some() {
        ended = host.stream(way, &mut look);
    }
    ended
}

/// What a run came to.
pub struct Run {
    pub edges: Vec<Edge>,
    pub levels: Vec<(u64, u8)>,
    /// The clocks in which the first segments of the stretches were loaded.
    pub loads: Vec<u64>,
    pub ended: Result<Ended, HostError<Died>>,
}

impl Run {
    fn of(board: Recorder, ended: Result<Ended, HostError<Died>>) -> Self {
        let loads = board.loads().to_vec();
        let recording = board.finish();
        Self { edges: recording.edges, levels: recording.levels, loads, ended }
    }
}

/// Every edge of STEP and DIR, and every change of the outputs.
#[derive(Default, PartialEq, Eq)]
pub struct Pins {
    pub edges: Vec<Edge>,
    pub levels: Vec<(u64, u8)>,
}

impl Pins {
    fn until(mut self, clock: u64) -> Self {
        self.edges.retain(|edge| edge.clock < clock);
        self.levels.retain(|&(at, _)| at < clock);
        self
    }

    /// The first difference, for a message.
    pub fn difference(&self, other: &Self) -> Option<String> {
        let edges = (self.edges.iter().map(Some).chain([None]))
            .zip(other.edges.iter().map(Some).chain([None]))
            .find(|(one, other)| one != other);
        let levels = || Some(format!("outputs: {:?}, {:?}", self.levels, other.levels));
        match edges {
            Some((one, other)) => Some(format!("{one:?}, {other:?}")),
            None => levels().filter(|_| self.levels != other.levels),
        }
    }
}

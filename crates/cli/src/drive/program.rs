//! A G-code program as a board is driven through it.

use super::itinerary::{Itinerary, Plan, Rest};
use super::outcome::ProgramDriven;
use super::place::Place;
use super::reading;
use crate::failure::Failure;
use crate::interrupt;
use crate::pass::{Kept, RowsAhead};
use crate::program;
use carrystep_core::{OutputChange, Segment};
use carrystep_files::Axis;
use carrystep_job::{Hold, Pace};
use carrystep_link::supply::{Starved, Supply};
use carrystep_link::{Command, Queues, SegmentSource, Status, Wish};
use carrystep_plan::exact::travel;
use carrystep_program::{
    AXIS_LETTERS, AxisSurvey, Found, Offsets, Point, ProgramFile, Resumed, Row, Rows, Stop, Survey,
    Switch, SwitchCount,
};
use carrystep_report::Detail;
use carrystep_runner::{BlockAt, Horizon, OverrideSetting, Stretches, Wait};
use std::cell::{Cell, RefCell};

/// The row in which the outputs of a program that is ended go off, seconds.
const LAST_ROW: f64 = 0.004;

/// Half a step in units of 2^-64 step.
const HALF_STEP: i128 = 1 << 63;

/// The message where the planning was ended.
const STOPPED: &str = "stopped while the program was planned; nothing was sent";

/// Number of rows between two looks at requests for a stop while a program is planned.
const ROWS_OF_A_LOOK: u64 = 1024;

/// A program that was planned once to its end, and that the link can send.
pub struct PlannedProgram<'a> {
    file: &'a ProgramFile,
    survey: Survey,
    seconds: f64,
    first: Vec<i8>,
    horizon: Horizon,
    soft_limits: Vec<String>,
    /// Whether the work offsets behind the program are kept.
    keeps: bool,
}

impl<'a> PlannedProgram<'a> {
    /// Plans a program to its end. `keeps` says whether its work offsets are kept. `wish` is called
    /// now and then; the planner ends when it is a stop.
    ///
    /// # Errors
    /// A mistake in the program, a line that is too slow to keep the queues full, or a stop.
    pub fn new(
        file: &'a ProgramFile,
        place: &Place,
        keeps: bool,
        mut wish: impl FnMut() -> Wish,
    ) -> Result<Self, Failure> {
        let machine = file.machine();
        let mut look = RowsLook::new(file);
        let planned = program::survey(file, Detail::Figures, |row| look.see(row, &mut wish));
        // A signal ends the planning, too.
        let stopped = || Failure::Run(STOPPED.to_owned());
        let (survey, _) =
            planned.map_err(|error| if interrupt::is_asked() { stopped() } else { error })?;
        let first = look.finish()?;
        reading::refuse_missing(file, &survey)?;
        let named = |(axis, soft): (&Axis, &bool)| soft.then(|| axis.name.clone());
        let soft_limits = machine.axes.iter().zip(&place.soft).filter_map(named).collect();
        let horizon = Horizon::of_board(machine.queue as u64, machine.cuts);
        let seconds = survey.ticks as f64 * machine.timebase.tick_seconds();
        Ok(Self { file, survey, seconds, first, horizon, soft_limits, keeps })
    }

    /// What the program switches and the machine does not, each with its first line.
    pub fn unswitched(&self) -> impl Iterator<Item = String> + '_ {
        let waits = |one: &&SwitchCount| {
            use Switch::{Input, Pause, Probe, ToolChange};
            !matches!(one.switch, Pause | ToolChange | Probe | Input)
        };
        self.survey.counts.switches.iter().filter(waits).map(
            |SwitchCount { switch, line, .. }| {
                format!("line {line}: {switch}: {}", switch.instead())
            },
        )
    }

    /// A warning if a host that is loaded may well be late.
    pub fn warning(&self) -> Option<String> {
        let ms = self.horizon.ms();
        self.horizon.is_short().then(|| {
            format!(
                "the queues of the board hold {ms} ms of motion: if this computer is busy for longer, \
                 the axes ramp down. queue_depth in the machine file makes them deeper where the part \
                 has the memory"
            )
        })
    }

    /// What the board is to do.
    pub fn plan(&self) -> Plan<'_> {
        Plan {
            machine: self.file.machine(),
            seconds: self.seconds,
            first: &self.first,
            steps: self.survey.axes.iter().map(AxisSurvey::steps).collect(),
            program: Some(ProgramDriven {
                lines: self.survey.counts.lines,
                soft_limits: self.soft_limits.clone(),
                horizon_ms: self.horizon.ms(),
                waits: 0,
                cuts: 0,
                overrides: OverrideSetting::NONE.into(),
                block: None,
                began_at: began_at(self.file),
            }),
        }
    }

    /// Runs `drive` with the way there, which is planned again while it is sent.
    ///
    /// # Errors
    /// As [`Rows::new`] and [`Hold::new`].
    pub fn along<T>(
        &self,
        drive: impl FnOnce(&dyn Itinerary) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let kept = Kept::default();
        let stretches = RefCell::new(way(self.file, &kept)?);
        drive(&ProgramStretches {
            first: self.file,
            start_steps: self.file.start_steps(),
            now: RefCell::new(self.file.clone()),
            kept: &kept,
            stretches,
            offsets: RefCell::new(self.survey.offsets.clone()),
            keeps: self.keeps,
            passed: Cell::new(0),
        })
    }
}

/// The machine place where a program began, as `--began-at` takes it.
fn began_at(file: &ProgramFile) -> String {
    let start = file.entry().map_or(file.settings().start, |entry| entry.program_start());
    let axis = |&letter: &usize| format!("{}={}", AXIS_LETTERS[letter], start[letter]);
    file.letters().all().iter().map(axis).collect::<Vec<_>>().join(",")
}

/// What looks at the rows of a program before anything is sent.
struct RowsLook<'a> {
    file: &'a ProgramFile,
    supply: Supply,
    /// The numbers of the axes x and y of crossed belts.
    belts: Option<[usize; 2]>,
    gone: Vec<i128>,
    first: Vec<i8>,
    rows: u64,
}

impl<'a> RowsLook<'a> {
    fn new(file: &'a ProgramFile) -> Self {
        let machine = file.machine();
        let axes = machine.axes.len();
        let tick_ns = machine.timebase.tick_ns();
        let supply = Supply::new(axes as u8, machine.timebase, machine.queue, machine.baud);
        let supply = match machine.cuts {
            true => supply,
            false => supply.with_enough(Horizon::enough_ticks(tick_ns) * tick_ns),
        };
        let (gone, first, belts) = (vec![0; axes], vec![0; axes], machine.belts());
        Self { file, supply, belts, gone, first, rows: 0 }
    }

    /// Looks at the next row.
    ///
    /// # Errors
    /// The line is too slow, or `wish` wants a stop.
    fn see(&mut self, row: &Row, wish: &mut dyn FnMut() -> Wish) -> Result<(), Failure> {
        for (number, (gone, &segment)) in (0..).zip(self.gone.iter_mut().zip(&row.segments)) {
            *gone += travel(&segment, segment.ticks.into());
            let sent = self.supply.add(&Command::Segment { axis: number, segment });
            sent.map_err(|error| starved(self.file, error))?;
        }
        let (gone, belts) = (&self.gone, self.belts);
        for (axis, way) in self.first.iter_mut().enumerate().filter(|(_, way)| **way == 0) {
            // The way of the axis' letter: on crossed belts half the sum of both motors, or half
            // their difference.
            let gone = match belts {
                Some([x, y]) if axis == x => (gone[x] + gone[y]) / 2,
                Some([x, y]) if axis == y => (gone[x] - gone[y]) / 2,
                _ => gone[axis],
            };
            if gone.abs() >= HALF_STEP {
                *way = gone.signum() as i8;
            }
        }
        self.rows += 1;
        if self.rows.is_multiple_of(ROWS_OF_A_LOOK) && wish() == Wish::Stop {
            return Err(Failure::Run(STOPPED.to_owned()));
        }
        Ok(())
    }

    /// The direction of the first motion of each axis.
    ///
    /// # Errors
    /// The line is too slow.
    fn finish(self) -> Result<Vec<i8>, Failure> {
        self.supply.finish().map_err(|error| starved(self.file, error))?;
        Ok(self.first)
    }
}

fn starved(file: &ProgramFile, error: Starved) -> Failure {
    let Starved { axis, at_ms, late_us, bottleneck } = error;
    let name = file.path().display();
    Failure::input(format!(
        "{name}: {bottleneck} too slow for this program: axis {axis} would run dry {at_ms} ms after \
         the start, its next segment {late_us} us late; give the machine file {}",
        bottleneck.remedy()
    ))
}

/// Rows, wherever they come from.
type Way<'a> = Stretches<Box<dyn Iterator<Item = Row> + 'a>>;

/// The way of a program, which is planned in a thread of its own.
fn way<'a>(file: &ProgramFile, kept: &'a Kept) -> Result<Way<'a>, Failure> {
    // Signals hold the program. What stops it ends the reading of these rows.
    let rows = RowsAhead::until(Rows::new(file)?, || false);
    let rows: Box<dyn Iterator<Item = Row> + 'a> = Box::new(kept.until_an_error(rows));
    let hold = Hold::new(file.machine()).map_err(|error| Failure::input(error.to_string()))?;
    let machine = file.machine();
    let start = file.start_steps();
    let pace = Pace::new(machine, &start).map_err(|error| Failure::input(error.to_string()))?;
    let stretches = Stretches::new(rows, &start, hold, pace, machine.queue);
    let stretches = stretches.with_outputs(file.row_outputs());
    Ok(stretches.for_holds(machine.cuts, machine.timebase.tick_ns()))
}

/// The stretches of a program.
struct ProgramStretches<'a> {
    /// The program as it began.
    first: &'a ProgramFile,
    /// Where it began, steps from machine zero.
    start_steps: Vec<i64>,
    /// The program with what was changed where it has waited.
    now: RefCell<ProgramFile>,
    kept: &'a Kept,
    stretches: RefCell<Way<'a>>,
    /// The work offsets behind the program.
    offsets: RefCell<Offsets>,
    /// Whether they are kept.
    keeps: bool,
    /// Number of places of the program at which it has waited, that of now included.
    passed: Cell<u64>,
}

impl Itinerary for ProgramStretches<'_> {
    fn begin(&self) -> Option<Vec<Wait>> {
        self.stretches.borrow_mut().begin()
    }

    fn waits(&self, at: Wait) -> Result<Option<Stop>, Failure> {
        if let Wait::SyncPoint(_) = at {
            self.passed.set(self.passed.get() + 1);
        }
        if let Wait::Hold(_) = at {
            return Ok(None);
        }
        Ok(Some(carrystep_program::stop_at(&self.now.borrow(), self.passed.get())?))
    }

    fn offsets(&self, _: &Status) -> Option<Offsets> {
        Some(self.offsets.borrow().clone())
    }

    fn keeps(&self) -> bool {
        self.keeps
    }

    fn program(&self) -> Option<&ProgramFile> {
        Some(self.first)
    }

    fn settling(&self, ticks: u32) -> Vec<Vec<Segment>> {
        self.stretches.borrow().settling(ticks)
    }

    fn resume(
        &self,
        at: Point,
        offsets: Option<Offsets>,
        found: Found,
        wish: &mut dyn FnMut() -> Wish,
    ) -> Result<Rest, Failure> {
        let change = Resumed { number: self.passed.get(), at, offsets, found };
        let file = self.now.borrow().resumed(change);
        let mut look = RowsLook::new(&file);
        let survey = Survey::new(&file, |row| look.see(row, &mut *wish))?;
        look.finish()?;
        reading::refuse_missing(&file, &survey)?;
        let stretches = way(&file, self.kept)?;
        *self.stretches.borrow_mut() = stretches;
        *self.offsets.borrow_mut() = survey.offsets.clone();
        let seconds = survey.ticks as f64 * file.machine().timebase.tick_seconds();
        self.now.replace(file);
        Ok(Rest { steps: survey.axes.iter().map(AxisSurvey::steps).collect(), seconds })
    }

    fn source(&self) -> Box<dyn SegmentSource + '_> {
        Box::new(&self.stretches)
    }

    fn hold(&self, queues: Option<Queues>) -> Option<u32> {
        let mut stretches = self.stretches.borrow_mut();
        match queues {
            Some(queues) => stretches.hold_in(queues),
            None => {
                stretches.hold();
                None
            }
        }
    }

    fn is_held(&self) -> bool {
        self.stretches.borrow().is_held()
    }

    fn overrides(&self) -> OverrideSetting {
        self.stretches.borrow().overrides()
    }

    fn set_overrides(&self, overrides: OverrideSetting, queues: Option<Queues>) -> Option<u32> {
        let mut stretches = self.stretches.borrow_mut();
        match queues {
            Some(queues) => stretches.set_overrides_in(overrides, queues),
            None => {
                stretches.set_overrides(overrides);
                None
            }
        }
    }

    fn rate(&self) -> f64 {
        self.stretches.borrow().rate()
    }

    fn gone(&self) -> Option<f64> {
        let tick = self.first.machine().timebase.tick_seconds();
        Some(self.stretches.borrow().gone() * tick)
    }

    fn added(&self) -> f64 {
        self.stretches.borrow().added() * self.first.machine().timebase.tick_seconds()
    }

    fn block(&self, moved: &[i32]) -> Option<BlockAt> {
        let positions = self.start_steps.iter().zip(moved);
        let positions: Vec<i64> =
            positions.map(|(&start, &moved)| start.saturating_add(moved.into())).collect();
        self.stretches.borrow().block_at(&positions)
    }

    fn end(&self) {
        let machine = self.first.machine();
        let duty = (machine.outputs.pwm_divider != 0).then_some(0);
        let off = OutputChange { mask: machine.outputs.exist, levels: 0, duty };
        let ticks = (LAST_ROW / machine.timebase.tick_seconds()).ceil() as u32;
        self.stretches.borrow_mut().end_with(off, ticks.max(1));
    }

    fn whole(&self) -> Result<(), Failure> {
        self.kept.error()?;
        Ok(self.first.same()?)
    }
}

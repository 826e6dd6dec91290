//! A G-code program as a board is driven through it.

use super::itinerary::{Itinerary, Plan};
use super::outcome::ProgramDriven;
use super::place::Place;
use super::shared::Shared;
use crate::failure::Failure;
use crate::interrupt;
use crate::pass::{Kept, RowsAhead};
use crate::program;
use carrystep_core::OutputChange;
use carrystep_files::Axis;
use carrystep_job::Hold;
use carrystep_link::supply::{Starved, Supply};
use carrystep_link::{Command, SegmentSource, Wish};
use carrystep_plan::exact::travel;
use carrystep_program::{AxisSurvey, Offsets, ProgramFile, Row, Rows, Survey, Switch, SwitchCount};
use carrystep_report::Detail;
use carrystep_runner::{Horizon, Stretches, Wait};
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
        let axes = machine.axes.len();
        let name = file.path().display();
        let starved = |Starved { axis, at_ms, late_us, baud }: Starved| {
            Failure::input(format!(
                "{name}: {baud} baud are too slow for this program: axis {axis} would run dry \
                 {at_ms} ms after the start, its next segment {late_us} us late; give [machine.link] a higher baud rate"
            ))
        };
        let mut supply =
            Supply::new(axes as u8, machine.timebase.tick_ns(), machine.queue, machine.baud);
        let (mut gone, mut first, mut rows) = (vec![0_i128; axes], vec![0; axes], 0_u64);
        let planned = program::survey(file, Detail::Figures, |row| {
            let motors = gone.iter_mut().zip(&mut first).zip(&row.segments);
            for (number, ((gone, way), &segment)) in (0..).zip(motors) {
                *gone += travel(&segment, segment.ticks.into());
                if *way == 0 && gone.abs() >= HALF_STEP {
                    *way = gone.signum() as i8;
                }
                supply.add(&Command::Segment { axis: number, segment }).map_err(starved)?;
            }
            rows += 1;
            if rows.is_multiple_of(ROWS_OF_A_LOOK) && wish() == Wish::Stop {
                return Err(Failure::Run(STOPPED.to_owned()));
            }
            Ok(())
        });
        // A signal ends the planning, too.
        let stopped = || Failure::Run(STOPPED.to_owned());
        let (survey, _) =
            planned.map_err(|error| if interrupt::is_asked() { stopped() } else { error })?;
        supply.finish().map_err(starved)?;
        let switches = &survey.counts.switches;
        let blind = switches.iter().find(|one| matches!(one.switch, Switch::Probe | Switch::Input));
        if let Some(SwitchCount { switch, line, .. }) = blind {
            return Err(Failure::input(format!(
                "{name}: line {line}: `run` cannot do this yet: {switch} ({})",
                switch.instead()
            )));
        }
        let named = |(axis, soft): (&Axis, &bool)| soft.then(|| axis.name.clone());
        let soft_limits = machine.axes.iter().zip(&place.soft).filter_map(named).collect();
        let horizon = Horizon::of_queue(machine.queue as u64);
        let seconds = survey.ticks as f64 * machine.timebase.tick_seconds();
        Ok(Self { file, survey, seconds, first, horizon, soft_limits, keeps })
    }

    /// What the program switches and the machine does not, each with its first line.
    pub fn unswitched(&self) -> impl Iterator<Item = String> + '_ {
        let waits = |one: &&SwitchCount| !matches!(one.switch, Switch::Pause | Switch::ToolChange);
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
        let (file, kept) = (self.file, Kept::default());
        let machine = file.machine();
        // Signals hold the program. What stops it ends the reading of these rows.
        let rows = RowsAhead::until(Rows::new(file)?, || false);
        let rows = kept.until_an_error(rows);
        let hold = Hold::new(machine).map_err(|error| Failure::input(error.to_string()))?;
        let stretches = RefCell::new(Stretches::new(rows, &file.start_steps(), hold));
        let offsets = self.keeps.then(|| self.survey.offsets.clone());
        let passed = Cell::new(0);
        drive(&ProgramStretches { file, kept: &kept, stretches, offsets, passed })
    }
}

/// The stretches of a program.
struct ProgramStretches<'a, I: Iterator<Item = Row>> {
    file: &'a ProgramFile,
    kept: &'a Kept,
    stretches: RefCell<Stretches<I>>,
    /// The work offsets behind the program, if they are kept.
    offsets: Option<Offsets>,
    /// Number of places of the program at which it has waited, that of now included.
    passed: Cell<u64>,
}

impl<I: Iterator<Item = Row>> Itinerary for ProgramStretches<'_, I> {
    fn begin(&self) -> Option<Vec<Wait>> {
        self.stretches.borrow_mut().begin()
    }

    fn waits(&self, at: Wait) -> Result<Option<Offsets>, Failure> {
        if let Wait::SyncPoint(_) = at {
            self.passed.set(self.passed.get() + 1);
        }
        if self.offsets.is_none() {
            return Ok(None);
        }
        Ok(Some(carrystep_program::offsets_at(self.file, self.passed.get())?))
    }

    fn offsets(&self) -> Option<Offsets> {
        self.offsets.clone()
    }

    fn source(&self) -> Box<dyn SegmentSource + '_> {
        Box::new(Shared(&self.stretches))
    }

    fn hold(&self) -> bool {
        self.stretches.borrow_mut().hold()
    }

    fn end(&self) {
        let machine = self.file.machine();
        let duty = (machine.outputs.pwm_divider != 0).then_some(0);
        let off = OutputChange { mask: machine.outputs.exist, levels: 0, duty };
        let ticks = (LAST_ROW / machine.timebase.tick_seconds()).ceil() as u32;
        self.stretches.borrow_mut().end_with(off, ticks.max(1));
    }

    fn whole(&self) -> Result<(), Failure> {
        self.kept.error()?;
        Ok(self.file.same()?)
    }
}

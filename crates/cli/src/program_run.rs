//! Runs a planned program at one level: it opens the outputs, runs the gateware, rebuilds the tool
//! from the pulses, and collects the results.

use crate::arguments::Core;
use crate::document::Named;
use crate::failure::Failure;
use crate::gateware::{self, CorePlan};
use crate::interrupt;
use crate::one_pass::OnePass;
use crate::pass::Kept;
use crate::program;
use crate::program_table::ProgramFigures;
use crate::progress::RunProgress;
use crate::recorded;
use crate::wanted::Wanted;
use carrystep_check::{
    DueChange, OutputCheck, OutputPins, OutputReport, OwnCapture, PathAxis, PathChecker,
    PathReport, PathSetup, PinSink, PinsVcd, PwmReport, PwmSink, PwmTiming, Tee, csv_writer,
    sink_beside,
};
use carrystep_core::Timebase;
use carrystep_profile::{Leg, Timeline};
use carrystep_program::{AxisSurvey, Legs, Marks, ProgramFile, Survey};
use carrystep_report::Detail;
use carrystep_simulators::engine::run::EngineJob;
use carrystep_simulators::{Job, Level};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// The result of a run; `--json` prints it as it is.
#[derive(Debug, JsonSchema, Serialize)]
pub struct ProgramResult {
    /// True if everything below holds.
    pub passed: bool,
    /// The gateware.
    pub core: &'static str,
    /// Where it ran.
    pub level: &'static str,
    /// Clock cycles simulated.
    pub clocks: u64,
    /// Seconds that the simulation took, planning and sinks included.
    pub run_s: f64,
    /// The faults that the gateware latched; "none" if there are none.
    pub faults: String,
    /// Position registers at the end, steps from the start.
    pub positions: Vec<i32>,
    /// The plan.
    pub plan: ProgramFigures,
    /// The pulses against the program.
    pub check: PathReport,
    /// The output pins against the plan, if the machine has outputs and the core is the engine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outputs: Option<OutputReport>,
    /// The pin of the PWM against the plan, if the machine has one and the core is the engine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pwm: Option<PwmReport>,
    /// The files that were written.
    pub files: Vec<PathBuf>,
}

impl ProgramResult {
    /// Returns the failure if anything does not hold; the report has been printed already.
    pub fn verdict(&self) -> Result<(), Failure> {
        if self.passed { Ok(()) } else { Err(Failure::Check) }
    }
}

impl fmt::Display for ProgramResult {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.plan, self.check)?;
        self.outputs.iter().try_for_each(|outputs| write!(f, "{outputs}"))?;
        self.pwm.iter().try_for_each(|pwm| write!(f, "{pwm}"))?;
        for file in &self.files {
            writeln!(f, "wrote {}", file.display())?;
        }
        let Self { core, level, clocks, faults, .. } = self;
        writeln!(f, "{core}, {level}: {clocks} clocks, faults: {faults}")?;
        f.write_str(if self.passed { "ALL HOLDS\n" } else { "FAILED\n" })
    }
}

/// Plans a program, runs it on a core at a level, checks every pulse and writes what is wanted.
///
/// At the fast level the program is planned once, while it is run. The other levels need its length
/// before they begin, and are so slow that the time for another plan does not matter.
pub fn run(
    file: &ProgramFile,
    detail: Detail,
    (core, level): (Core, Level),
    wanted: &Wanted,
) -> Result<ProgramResult, Failure> {
    let machine = file.machine();
    let title = file.path().display().to_string();
    let too_many = |error: carrystep_files::TooManyAxes| Failure::input(error.to_string());
    let build = machine.build().map_err(too_many)?;
    let engine = match core {
        Core::Engine => Some(gateware::engine(machine, &title)?),
        Core::Parallel if machine.outputs.is_any() => {
            let message = "the parallel core has no outputs; leave out --core parallel, or \
                           [machine.outputs]";
            return Err(Failure::input(message.to_owned()));
        }
        Core::Parallel => None,
    };
    carrystep_simulators::available(level)?;
    let mut known = None;
    if level != Level::Fast {
        let (survey, _) = program::survey(file, Detail::Figures, |_| Ok(()))?;
        crate::job::fits_into_a_capture(survey.ticks, &build.timebase)?;
        known = Some(survey);
    }
    let kept = Kept::default();
    let segments = known.as_ref().map_or(0, |survey| survey.rows * survey.axes.len() as u64);
    let program = OnePass::new(file, detail, segments, &kept)?;
    program.begin()?;
    let mut files = wanted.begin()?;
    // Set when an output fails, so that the run ends early.
    let deaf = AtomicBool::new(false);
    let halt = &[interrupt::watch(), &deaf];
    let timebase = build.timebase;
    let total = known.as_ref().map(|survey| survey.ticks * u64::from(timebase.clocks_per_tick()));
    let progress = RunProgress::new(level, total);
    let how_far = Some(progress.how_far());
    let axes = machine.axes.len();
    let ticks = known.as_ref().map_or(0, |survey| survey.ticks);
    let more_clocks = known.is_none().then(|| program.clocks());
    let on = |program| match &engine {
        None => {
            let job = Job::new(&build, program, ticks);
            CorePlan::Parallel(Job { axes, more_clocks, halt, how_far, ..job })
        }
        Some(engine) => {
            let job = EngineJob::new(engine, program, ticks);
            CorePlan::Engine(EngineJob { more_clocks, halt, how_far, ..job })
        }
    };
    let looked_at = program.looked_at();
    let load = on(&looked_at).origin();
    kept.error()?;
    let load = load?;
    let origin_ps = timebase.clock_to_ps(load + timebase.latency_clocks());

    let pins = engine.as_ref().map_or_else(OutputPins::default, gateware::output_pins);
    let exist = pins.outputs;
    let mut checker =
        PathChecker::new(setup(file, origin_ps), Box::new(kept.until_an_error(Legs::new(file)?)));
    if exist != 0 {
        checker = checker.with_outputs(Box::new(kept.until_an_error(Marks::new(file)?)), exist);
    }
    let names = || machine.axes.iter().map(|axis| axis.name.as_str());
    let own = OwnCapture { origin_ps: origin_ps.cast_signed(), timebase, is_part: false };
    let vcd = files.vcd.as_mut().map(|out| PinsVcd::new(out, own, names(), pins)).transpose()?;
    let mut writers: Vec<Box<dyn PinSink + '_>> = Vec::new();
    writers.extend(vcd.map(|vcd| Box::new(vcd) as Box<dyn PinSink>));
    // A job has no profile, so that the column of errors is empty.
    let none = || Timeline::new(timebase.tick_seconds(), Vec::<Leg>::new());
    let csv = files.csv.as_mut();
    writers.extend(csv.map(|out| {
        let axes = names().map(|name| (name, none()));
        csv_writer(out, &timebase, build.phase, origin_ps.cast_signed(), axes)
    }));

    let mut outputs = (exist != 0).then(|| {
        let from = &program;
        let since = move |due: DueChange| DueChange { ps: due.ps.saturating_add(origin_ps), ..due };
        OutputCheck::new(move || from.next_due().map(since))
    });

    let mut pwm = pins.pwm.then(|| {
        let (from, divider) = (&program, machine.outputs.pwm_divider);
        let since = move |(ps, duty): (u64, u16)| (ps.saturating_add(origin_ps), duty);
        PwmSink::new(PwmTiming { timebase, divider }, move || from.next_duty().map(since))
    });

    let started = Instant::now();
    // The checker follows the path in a thread of its own.
    let (outcome, mut checker) = sink_beside(checker, |checker| -> Result<_, Failure> {
        let mut tee = Tee::new();
        tee.add(checker);
        outputs.iter_mut().for_each(|outputs| tee.add(outputs));
        pwm.iter_mut().for_each(|pwm| tee.add(pwm));
        writers.iter_mut().for_each(|writer| tee.add(&mut **writer));
        on(&program).run_into(level, timebase, axes, &mut tee, (progress.how_far(), &deaf))
    })?;
    // An error of reading explains whatever the run reports.
    kept.error()?;
    file.same()?;
    let outcome = outcome?;
    let run_s = started.elapsed().as_secs_f64();
    drop(progress);
    drop(writers);

    let outputs = outputs.map(OutputCheck::finish);
    let pwm = pwm.and_then(PwmSink::finish);
    let (survey, recorded) = program.finish(file)?;
    interrupt::check()?;
    checker.ends(length_ps(&survey, &timebase), survey.axes.iter().map(AxisSurvey::steps));
    let check = checker.finish();
    let plan = ProgramFigures::new(file, &survey, &recorded.time_use);
    let positions: Vec<i32> = outcome.positions.into_iter().take(axes).collect();
    let landed =
        positions.iter().zip(&survey.axes).all(|(&found, axis)| i64::from(found) == axis.steps());
    let done = ProgramResult {
        passed: check.passed
            && outputs.as_ref().is_none_or(|outputs| outputs.passed)
            && pwm.as_ref().is_none_or(|pwm| pwm.passed)
            && plan.landed()
            && outcome.fault.is_none()
            && landed,
        core: core.name(),
        level: level.name(),
        clocks: outcome.clocks,
        run_s,
        faults: outcome.fault.unwrap_or_else(|| "none".into()),
        positions,
        plan,
        check,
        outputs,
        pwm,
        files: files.paths(),
    };
    if let Some(out) = &mut files.report {
        let source = recorded::source(file, survey.one_file, &recorded.time_use)?;
        recorded::write(out, &title, &Named::new(&done), &recorded, &source)?;
    }
    files.keep()?;
    Ok(done)
}

/// What the checker compares the pulses with, but for the end of the job.
pub fn setup(file: &ProgramFile, origin_ps: u64) -> PathSetup<'_> {
    let letters = file.letters();
    let of_axes = letters.of_axes().iter().zip(letters.moves());
    let axes = file.machine().axes.iter().zip(of_axes).zip(file.start_steps());
    let axes = axes.map(|((axis, (&letter, &moves)), start_steps)| PathAxis {
        name: &axis.name,
        letter,
        moves,
        start_steps,
        steps: 0,
        pins_ns: axis.pins_ns,
    });
    let (axes, start) = (axes.collect(), file.settings().start);
    PathSetup { axes, start, origin_ps, total_ps: u64::MAX, slack_ps: 0 }
}

/// The length of a job, ps.
pub fn length_ps(survey: &Survey, timebase: &Timebase) -> u64 {
    let ticks = u128::from(survey.ticks) * u128::from(timebase.tick_ns()) * 1000;
    u64::try_from(ticks).unwrap_or(u64::MAX)
}

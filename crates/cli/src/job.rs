//! Runs the moves of one file at one level: it opens the outputs, runs the gateware, checks every
//! pulse and collects the results.

use crate::arguments::Core;
use crate::document::Named;
use crate::failure::Failure;
use crate::gateware::{self, CorePlan};
use crate::interrupt;
use crate::pass::PlanCommands;
use crate::progress::{PlanProgress, RunProgress};
use crate::recorded::{self, MoveRecorder, Recorded};
use crate::table::{self, LimitsJson};
use crate::wanted::Wanted;
use carrystep_check::{
    AxisSetup, AxisWaves, CheckReport, ErrorCounter, ErrorCounts, Origin, PinSink, Plot, PlotAxis,
    PlotSetup, Setup, Tee, Waves, check_beside, csv_writer, fst_writer, save_file, vcd_writer,
};
use carrystep_core::{Segment, Timebase};
use carrystep_files::MoveSource;
use carrystep_plan::{Pass, PlannedMove, Survey};
use carrystep_profile::{Course, Reader, Timeline};
use carrystep_report::{Detail, TimeUse};
use carrystep_simulators::engine::run::EngineJob;
use carrystep_simulators::{Job, Level};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// The longest run in seconds, because captures count ps in 64 bits.
const LONGEST_S: u64 = 4_000_000;

/// The result of a run; `--json` prints it as it is.
#[derive(Debug, JsonSchema, Serialize)]
pub struct RunResult {
    /// True if everything below holds.
    pub passed: bool,
    /// The gateware.
    pub core: &'static str,
    /// Where it ran.
    pub level: &'static str,
    /// Clock cycles simulated.
    pub clocks: u64,
    /// Seconds that the simulation took, sinks included.
    pub run_s: f64,
    /// The faults that the gateware latched; "none" if there are none.
    pub faults: String,
    /// Position registers at the end, steps.
    pub positions: Vec<i32>,
    /// Speeds and accelerations of the plan against the machine's limits.
    pub limits: LimitsJson,
    /// Where the time goes.
    pub time_use: TimeUse,
    /// Pulses of each axis by their error; only with `--report`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_counts: Option<Vec<ErrorCounts>>,
    /// The pulses against the profile.
    pub check: CheckReport,
    /// The files that were written.
    pub files: Vec<PathBuf>,
}

impl RunResult {
    /// Returns the failure if anything does not hold; the report has been printed already.
    pub fn verdict(&self) -> Result<(), Failure> {
        if self.passed { Ok(()) } else { Err(Failure::Check) }
    }
}

impl fmt::Display for RunResult {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}\n{}", self.limits, self.check)?;
        for file in &self.files {
            writeln!(f, "wrote {}", file.display())?;
        }
        writeln!(
            f,
            "{}, {}: {} clocks, faults: {}",
            self.core, self.level, self.clocks, self.faults
        )?;
        f.write_str(if self.passed { "ALL HOLDS\n" } else { "FAILED\n" })
    }
}

/// Opens a move file. `fit_ns` (ns) overrides the fit tolerance of all its moves.
pub fn load(path: &Path, fit_ns: Option<u64>) -> Result<MoveSource, Failure> {
    Ok(MoveSource::open(path)?.with_fit(fit_ns))
}

/// Plans all moves, so that a move that cannot be made is refused before anything happens. `watch`
/// sees each of them.
pub fn survey(
    source: MoveSource,
    mut watch: impl FnMut(&PlannedMove) -> Result<(), Failure>,
) -> Result<Survey, Failure> {
    let mut progress = PlanProgress::of("moves");
    Survey::new(source, |planned| {
        progress.one();
        watch(planned)?;
        interrupt::check()
    })
}

/// The same, and what the moves do with their time.
pub fn recorded(
    source: MoveSource,
    detail: Detail,
    mut watch: impl FnMut(&PlannedMove) -> Result<(), Failure>,
) -> Result<(Survey, Recorded), Failure> {
    let mut recorder = MoveRecorder::new(&source.machine, detail);
    let survey = survey(source, |planned| {
        recorder.add(planned);
        watch(planned)
    })?;
    Ok((survey, recorder.finish()))
}

/// The setup of the checker for a capture of this plan.
pub fn check_setup<'a>(
    survey: &'a Survey,
    timelines: &[Timeline],
    courses: Option<Reader<Course>>,
    origin: Origin,
) -> Setup<'a> {
    let axes = survey.machine().axes.iter().zip(&survey.totals().axes).zip(timelines);
    let axes = axes.map(|((axis, totals), timeline)| AxisSetup {
        name: &axis.name,
        unit: Some(&axis.unit),
        timeline: timeline.clone(),
        travel: totals.travel.clone(),
        pins_ns: axis.pins_ns,
    });
    Setup {
        timebase: survey.build().timebase,
        phase: survey.build().phase,
        axes: axes.collect(),
        courses,
        origin,
        slack_ps: 0,
    }
}

/// Refuses a plan that is longer than a capture can be.
pub fn fits_a_capture(survey: &Survey) -> Result<(), Failure> {
    fits_into_a_capture(survey.totals().ticks, &survey.build().timebase)
}

/// Refuses so many ticks if a capture cannot be as long.
pub fn fits_into_a_capture(ticks: u64, timebase: &Timebase) -> Result<(), Failure> {
    let ns = u128::from(ticks) * u128::from(timebase.tick_ns());
    if ns <= u128::from(LONGEST_S) * 1_000_000_000 {
        return Ok(());
    }
    let seconds = ns / 1_000_000_000;
    Err(Failure::input(format!(
        "the moves take {seconds} s: a capture holds at most {LONGEST_S} s; split the file"
    )))
}

/// Runs a plan on a core at a level, checks every pulse and writes what is wanted.
pub fn run(
    (survey, recorded): (&Survey, &Recorded),
    core: Core,
    level: Level,
    wanted: &Wanted,
) -> Result<RunResult, Failure> {
    let (machine, build, totals) = (survey.machine(), survey.build(), survey.totals());
    let title = survey.source().path.display().to_string();
    let engine = match core {
        Core::Engine => Some(gateware::engine(machine, &title)?),
        Core::Parallel => None,
    };
    carrystep_simulators::available(level)?;
    fits_a_capture(survey)?;
    let mut files = wanted.begin()?;
    let program = PlanCommands::new(survey);
    // Set when an output fails, so that the run ends early.
    let deaf = AtomicBool::new(false);
    let halt = &[interrupt::watch(), &deaf];
    let (timebase, phase) = (build.timebase, build.phase);
    let total = totals.ticks * u64::from(timebase.clocks_per_tick());
    let progress = RunProgress::new(level, Some(total));
    let how_far = Some(progress.how_far());
    let on = match &engine {
        None => CorePlan::Parallel(Job {
            axes: machine.axes.len(),
            halt,
            how_far,
            ..Job::new(build, &program, totals.ticks)
        }),
        Some(engine) => CorePlan::Engine(EngineJob {
            halt,
            how_far,
            ..EngineJob::new(engine, &program, totals.ticks)
        }),
    };
    let load = on.origin()?;
    let origin_ps = timebase.clock_to_ps(load + timebase.latency_clocks()).cast_signed();
    let total_s = totals.ticks as f64 * timebase.tick_seconds();
    let view = wanted.part.view(machine, origin_ps, total_s)?;

    // Each of those who follow the plan has a place of its own in this pass. Nothing else keeps a
    // place, so that the moves behind the last of them are freed.
    let Pass { moves, timelines, courses } = survey.begin();
    let setup = check_setup(survey, &timelines, courses, Origin::Known { ps: origin_ps });
    let names: Vec<&str> = machine.axes.iter().map(|axis| axis.name.as_str()).collect();
    let named = || names.iter().copied().zip(timelines.iter().cloned());
    let segments = |axis: usize| {
        let of_move = move |planned: Arc<PlannedMove>| {
            planned.axis_segments(axis).collect::<Vec<(u64, Segment)>>()
        };
        Box::new(moves.clone().flat_map(of_move))
    };
    let waves = || Waves {
        timebase,
        phase,
        origin_ps,
        total_ticks: totals.ticks,
        axes: named()
            .enumerate()
            .map(|(axis, (name, timeline))| AxisWaves { name, timeline, segments: segments(axis) })
            .collect(),
        view: view.clone(),
    };
    let mut writers: Vec<Box<dyn PinSink + '_>> = Vec::new();
    writers.extend(files.vcd.as_mut().map(|out| vcd_writer(out, waves())));
    writers.extend(files.fst.as_mut().map(|out| fst_writer(out, waves())));
    let csv = files.csv.as_mut();
    writers.extend(csv.map(|out| csv_writer(out, &timebase, phase, origin_ps, named())));
    let mut plot = wanted.plot.as_ref().map(|_| {
        let axes = named().map(|(name, timeline)| PlotAxis { name, timeline }).collect();
        let total_ticks = totals.ticks;
        Plot::new(PlotSetup { title: &title, timebase, phase, origin_ps, total_ticks, axes })
    });
    let mut errors =
        wanted.report.as_ref().map(|_| ErrorCounter::new(&timebase, phase, origin_ps, named()));
    program.share(moves);
    drop(timelines);

    let started = Instant::now();
    let (outcome, check) = check_beside(setup, |checker| -> Result<_, Failure> {
        let mut tee = Tee::new();
        tee.add(checker);
        writers.iter_mut().for_each(|writer| tee.add(&mut **writer));
        if let Some(sink) = plot.as_mut() {
            tee.add(sink);
        }
        if let Some(sink) = errors.as_mut() {
            tee.add(sink);
        }
        on.run_into(level, timebase, machine.axes.len(), &mut tee, (progress.how_far(), &deaf))
    });
    survey.whole()?;
    let outcome = outcome?;
    let run_s = started.elapsed().as_secs_f64();
    drop(progress);
    drop(writers);

    if let (Some(out), Some(vcd)) = (&mut files.save, &wanted.vcd) {
        let shown = names.iter().enumerate().filter(|(axis, _)| view.shows(*axis));
        let names: Vec<&str> = shown.map(|(_, name)| *name).collect();
        let length_ps = view.length_ps(timebase.clock_to_ps(outcome.clocks));
        out.text(&save_file(&seen_from(out.path(), vcd), &names, length_ps)?)?;
    }
    if let (Some(out), Some(plot)) = (&mut files.plot, plot) {
        out.text(&plot.svg(&check)?)?;
    }

    let limits = table::limits(machine, totals);
    let positions: Vec<i32> = outcome.positions.into_iter().take(machine.axes.len()).collect();
    let landed = positions
        .iter()
        .zip(&check.axes)
        .all(|(&found, axis)| i64::from(found) == axis.position_expected);
    let done = RunResult {
        passed: check.passed() && limits.landed() && outcome.fault.is_none() && landed,
        core: core.name(),
        level: level.name(),
        clocks: outcome.clocks,
        run_s,
        faults: outcome.fault.unwrap_or_else(|| "none".into()),
        positions,
        limits,
        time_use: recorded.time_use.clone(),
        error_counts: errors.map(ErrorCounter::finish),
        check,
        files: files.paths(),
    };
    if let Some(out) = &mut files.report {
        recorded::write(out, &title, &Named::new(&done), recorded, &[])?;
    }
    files.keep()?;
    Ok(done)
}

/// The path of the waveform as GTKWave must find it from the folder of the save file.
fn seen_from(save: &Path, vcd: &Path) -> String {
    let beside = save.parent() == vcd.parent();
    let absolute = std::path::absolute(vcd).unwrap_or_else(|_| vcd.to_owned());
    let name = vcd.file_name().filter(|_| beside).map_or(absolute, PathBuf::from);
    name.display().to_string()
}

//! Runs one planned move file at one level: it opens the outputs, runs the gateware, checks every
//! pulse and collects the results.

use crate::arguments::Core;
use crate::failure::Failure;
use crate::gateware::{self, CorePlan};
use crate::interrupt;
use crate::progress::RunProgress;
use crate::table::{self, LimitsJson};
use crate::wanted::Wanted;
use carrystep_check::{
    AxisSetup, AxisWaves, CheckReport, Origin, PinSink, Plot, PlotAxis, PlotSetup, Setup, Tee,
    Waves, check_beside, csv_writer, fst_writer, save_file, vcd_writer,
};
use carrystep_files::MoveFile;
use carrystep_plan::Plan;
use carrystep_profile::Timeline;
use carrystep_simulators::engine::run::EngineJob;
use carrystep_simulators::pins::PinFeed;
use carrystep_simulators::{Job, Level, LevelError};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
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

/// Reads a move file. `fit_ns` (ns) overrides the fit tolerance of all its moves.
pub fn load(path: &Path, fit_ns: Option<u64>) -> Result<MoveFile, Failure> {
    let mut file = MoveFile::load(path)?;
    if let Some(fit_ns) = fit_ns {
        file.moves.iter_mut().for_each(|moved| moved.fit_ns = fit_ns);
    }
    Ok(file)
}

/// The setup of the checker for a capture of this plan.
pub fn check_setup<'a>(
    file: &'a MoveFile,
    plan: &Plan,
    timelines: &'a [Timeline],
    origin: Origin,
) -> Setup<'a> {
    let axis = |(i, (axis, timeline)): (usize, (&'a carrystep_files::Axis, &'a Timeline))| {
        let steps = plan.moves.iter().map(|m| m.axes[i].steps);
        AxisSetup {
            name: &axis.name,
            unit: Some(&axis.unit),
            timeline,
            pins_ns: axis.pins_ns,
            expected_pulses: steps.clone().map(i64::unsigned_abs).sum(),
            expected_position: steps.sum(),
        }
    };
    Setup {
        timebase: plan.build.timebase,
        phase: plan.build.phase,
        axes: file.machine.axes.iter().zip(timelines).enumerate().map(axis).collect(),
        lines: plan.lines(),
        origin,
        slack_ps: 0,
    }
}

/// Refuses a plan that is longer than a capture can be.
pub fn fits_a_capture(plan: &Plan) -> Result<(), Failure> {
    let ns = u128::from(plan.total_ticks()) * u128::from(plan.build.timebase.tick_ns());
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
    file: &MoveFile,
    plan: &Plan,
    core: Core,
    level: Level,
    wanted: &Wanted,
) -> Result<RunResult, Failure> {
    let engine = match core {
        Core::Engine => {
            Some(gateware::engine(&file.machine, &file.source.path.display().to_string())?)
        }
        Core::Parallel => None,
    };
    carrystep_simulators::available(level)?;
    fits_a_capture(plan)?;
    let mut files = wanted.begin()?;
    let program = plan.program();
    // Set when an output fails, so that the run ends early.
    let deaf = AtomicBool::new(false);
    let halt = &[interrupt::watch(), &deaf];
    let timebase = plan.build.timebase;
    let progress =
        RunProgress::new(level, plan.total_ticks() * u64::from(timebase.clocks_per_tick()));
    let how_far = Some(progress.how_far());
    let on = match &engine {
        None => CorePlan::Parallel(Job {
            axes: file.machine.axes.len(),
            halt,
            how_far,
            ..Job::new(&plan.build, &program, plan.total_ticks())
        }),
        Some(engine) => CorePlan::Engine(EngineJob {
            halt,
            how_far,
            ..EngineJob::new(engine, &program, plan.total_ticks())
        }),
    };
    let load = on.origin()?;
    let origin_ps = timebase.clock_to_ps(load + timebase.latency_clocks()).cast_signed();
    let timelines = plan.timelines();

    let setup = check_setup(file, plan, &timelines, Origin::Known { ps: origin_ps });
    let named = || file.machine.axes.iter().map(|axis| axis.name.as_str()).zip(&timelines);
    let total_s = plan.total_ticks() as f64 * timebase.tick_seconds();
    let view = wanted.part.view(&file.machine, origin_ps, total_s)?;
    let waves = || Waves {
        timebase,
        phase: plan.build.phase,
        origin_ps,
        total_ticks: plan.total_ticks(),
        axes: named()
            .enumerate()
            .map(|(i, (name, timeline))| AxisWaves {
                name,
                timeline,
                segments: Box::new(plan.axis_segments(i)),
            })
            .collect(),
        view: view.clone(),
    };
    let phase = plan.build.phase;
    let mut writers: Vec<Box<dyn PinSink + '_>> = Vec::new();
    writers.extend(files.vcd.as_mut().map(|out| vcd_writer(out, waves())));
    writers.extend(files.fst.as_mut().map(|out| fst_writer(out, waves())));
    let csv = files.csv.as_mut();
    writers.extend(csv.map(|out| csv_writer(out, &timebase, phase, origin_ps, named())));
    let title = file.source.path.display().to_string();
    let mut plot = wanted.plot.as_ref().map(|_| {
        let axes = named().map(|(name, timeline)| PlotAxis { name, timeline }).collect();
        let total_ticks = plan.total_ticks();
        Plot::new(PlotSetup { title: &title, timebase, phase, origin_ps, total_ticks, axes })
    });

    let started = Instant::now();
    let (outcome, check) = check_beside(setup, |checker| -> Result<_, Failure> {
        let mut tee = Tee::new();
        tee.add(checker);
        writers.iter_mut().for_each(|writer| tee.add(&mut **writer));
        if let Some(sink) = plot.as_mut() {
            tee.add(sink);
        }
        let mut feed = PinFeed::new(timebase, file.machine.axes.len(), &mut tee);
        let outcome = on.run(level, &mut |cycle, step, dir| {
            progress.how_far().at(cycle);
            feed.pins(cycle, step, dir);
            if feed.has_failed() {
                deaf.store(true, Ordering::Relaxed);
            }
        });
        interrupt::check()?;
        if let Err(LevelError::Halted) = outcome {
            // The feed holds the cause.
            return Err(feed.end(0).err().map_or(LevelError::Halted.into(), Failure::from));
        }
        let outcome = outcome?;
        feed.end(outcome.clocks)?;
        Ok(outcome)
    });
    let outcome = outcome?;
    let run_s = started.elapsed().as_secs_f64();
    drop(progress);
    drop(writers);

    if let (Some(out), Some(vcd)) = (&mut files.save, &wanted.vcd) {
        let shown = named().enumerate().filter(|(axis, _)| view.shows(*axis));
        let names: Vec<&str> = shown.map(|(_, (name, _))| name).collect();
        let length_ps = view.length_ps(timebase.clock_to_ps(outcome.clocks));
        out.text(&save_file(&seen_from(out.path(), vcd), &names, length_ps)?)?;
    }
    if let (Some(out), Some(plot)) = (&mut files.plot, plot) {
        out.text(&plot.svg(&check)?)?;
    }

    let limits = table::limits(file, plan);
    let positions: Vec<i32> = outcome.positions.into_iter().take(file.machine.axes.len()).collect();
    let landed = positions
        .iter()
        .zip(&check.axes)
        .all(|(&found, axis)| i64::from(found) == axis.position_expected);
    Ok(RunResult {
        passed: check.passed() && limits.landed() && outcome.fault.is_none() && landed,
        core: core.name(),
        level: level.name(),
        clocks: outcome.clocks,
        run_s,
        faults: outcome.fault.unwrap_or_else(|| "none".into()),
        positions,
        limits,
        check,
        files: files.keep()?,
    })
}

/// The path of the waveform as GTKWave must find it from the folder of the save file.
fn seen_from(save: &Path, vcd: &Path) -> String {
    let beside = save.parent() == vcd.parent();
    let absolute = std::path::absolute(vcd).unwrap_or_else(|_| vcd.to_owned());
    let name = vcd.file_name().filter(|_| beside).map_or(absolute, PathBuf::from);
    name.display().to_string()
}

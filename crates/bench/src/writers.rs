//! Bytes a second of a waveform: ours, and Verilator's own trace.

use crate::moves::Moves;
use crate::stopwatch;
use crate::verilator::Verilated;
use carrystep_levels::pins::PinFeed;
use carrystep_levels::{Level, run};
use carrystep_trace::{AxisWaves, PinSink, VcdWriter, Waves};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// What writing took beyond simulating.
pub struct Written {
    pub bytes: u64,
    pub seconds: f64,
}

impl Written {
    /// Millions of bytes a second.
    pub fn megabytes_per_second(&self) -> f64 {
        self.bytes as f64 / self.seconds.max(1e-9) / 1e6
    }
}

/// STEP, DIR, position and V of each axis beside the float profile, as `carrystep simulate --vcd` writes it.
pub fn ours(moves: &Moves, folder: &Path) -> Result<Written, String> {
    let path = folder.join("ours.vcd");
    let simulate = |sink: &mut dyn PinSink| {
        let mut feed = PinFeed::new(moves.plan.build.timebase, 6, sink);
        let outcome = run(Level::Fast, &moves.job(), &mut |cycle, outputs| feed.observe(cycle, outputs));
        let outcome = outcome.map_err(|error| error.to_string())?;
        feed.end(outcome.clocks).map_err(|error| error.to_string())
    };
    let (without, result) = stopwatch::least(0.2, || simulate(&mut Nothing));
    result?;
    let timelines = moves.plan.timelines();
    let (with, result) = stopwatch::least(1.0, || {
        let file = File::create(&path).map_err(|error| error.to_string())?;
        let axes = timelines.iter().zip(["x", "y", "z", "a", "b", "c"]).enumerate();
        let waves = Waves {
            timebase: moves.plan.build.timebase,
            phase: moves.plan.build.phase,
            origin_ps: 0,
            total_ticks: moves.plan.total_ticks(),
            axes: axes
                .map(|(i, (timeline, name))| AxisWaves {
                    name,
                    timeline,
                    segments: Box::new(moves.plan.axis_segments(i)),
                })
                .collect(),
        };
        simulate(&mut VcdWriter::new(BufWriter::with_capacity(1 << 18, file), waves))
    });
    result?;
    Ok(Written { bytes: length(&path)?, seconds: with - without })
}

/// All ports of the core, dumped once a clock.
pub fn verilators(
    tracing: &Verilated,
    feed: &str,
    clocks: u64,
    untraced: f64,
    folder: &Path,
) -> Result<Written, String> {
    let path = folder.join("verilator.vcd");
    let run = tracing.run(feed, clocks, Some(&path))?;
    Ok(Written { bytes: length(&path)?, seconds: run.seconds - untraced })
}

fn length(path: &Path) -> Result<u64, String> {
    std::fs::metadata(path).map(|file| file.len()).map_err(|error| error.to_string())
}

/// Hears everything, writes nothing.
struct Nothing;

impl PinSink for Nothing {
    fn change(&mut self, _: carrystep_trace::PinChange) -> Result<(), carrystep_trace::TraceError> {
        Ok(())
    }
}

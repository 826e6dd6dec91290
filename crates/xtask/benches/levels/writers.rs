//! Measures how many bytes per second the writers of waveforms produce: those of carrystep, and
//! Verilator's own trace.

use crate::moves::Moves;
use crate::stopwatch;
use crate::verilator::Verilated;
use carrystep_check::{AxisWaves, PinSink, View, Waves, fst_writer, vcd_writer};
use carrystep_core::AXES;
use carrystep_core::ports::Outputs;
use carrystep_simulators::pins::PinFeed;
use carrystep_simulators::{Level, run};
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;

/// Time for which each writer is measured, seconds.
const BUDGET: f64 = 0.3;

/// The bytes that were written, and the time of writing without that of the simulation.
pub struct Written {
    pub bytes: u64,
    pub seconds: f64,
}

impl Written {
    /// Writing speed, millions of bytes per second.
    pub fn megabytes_per_second(&self) -> f64 {
        self.bytes as f64 / self.seconds.max(1e-9) / 1e6
    }
}

/// Writes the output ports of the core, which are the signals of Verilator's trace.
pub fn ports(moves: &Moves, folder: &Path) -> Result<Written, String> {
    let path = folder.join("ports.vcd");
    let simulate = |observer: &mut dyn FnMut(u64, &Outputs)| {
        run(Level::Fast, &moves.job(), observer).map(|_| ()).map_err(|error| error.to_string())
    };
    let mut changes = 0_u64;
    let (without, result) = stopwatch::least(BUDGET, || simulate(&mut |cycle, _| changes ^= cycle));
    result?;
    let (with, result) = stopwatch::least(BUDGET, || {
        let mut dump = PortDump::create(&path).map_err(|error| error.to_string())?;
        let mut failed = Ok(());
        simulate(&mut |cycle, outputs| {
            if failed.is_ok() {
                failed = dump.change(cycle, outputs);
            }
        })?;
        failed.and_then(|()| dump.out.flush()).map_err(|error| error.to_string())
    });
    result?;
    Ok(Written { bytes: length(&path)?, seconds: with - without })
}

/// Begins a waveform of one format in a file.
type Format = for<'a> fn(File, Waves<'a>) -> Box<dyn PinSink + 'a>;

/// Writes STEP, DIR, position and V of each axis beside the float profile, like `carrystep simulate`
/// with `--vcd` and with `--fst`. Returns what was written in each of the two formats.
pub fn waveforms(moves: &Moves, folder: &Path) -> Result<[Written; 2], String> {
    let vcd: Format = |file, waves| vcd_writer(file, waves);
    let fst: Format = |file, waves| fst_writer(file, waves);
    Ok([waveform(moves, folder, vcd)?, waveform(moves, folder, fst)?])
}

fn waveform(moves: &Moves, folder: &Path, format: Format) -> Result<Written, String> {
    let path = folder.join("waveform");
    let simulate = |sink: &mut dyn PinSink| {
        let mut feed = PinFeed::new(moves.plan.build.timebase, AXES, sink);
        let outcome =
            run(Level::Fast, &moves.job(), &mut |cycle, outputs| feed.observe(cycle, outputs));
        let outcome = outcome.map_err(|error| error.to_string())?;
        feed.end(outcome.clocks).map_err(|error| error.to_string())
    };
    let (without, result) = stopwatch::least(BUDGET, || simulate(&mut Nothing));
    result?;
    let timelines = moves.plan.timelines();
    let (with, result) = stopwatch::least(BUDGET, || {
        let file = File::create(&path).map_err(|error| error.to_string())?;
        let axes = timelines.iter().zip(["x", "y", "z", "a", "b", "c"]).enumerate();
        let axes = axes.map(|(axis, (timeline, name))| {
            let segments = Box::new(moves.plan.axis_segments(axis));
            AxisWaves { name, timeline: timeline.clone(), segments }
        });
        let waves = Waves {
            timebase: moves.plan.build.timebase,
            phase: moves.plan.build.phase,
            origin_ps: 0,
            total_ticks: moves.plan.total_ticks(),
            axes: axes.collect(),
            view: View::default(),
        };
        simulate(&mut *format(file, waves))
    });
    result?;
    Ok(Written { bytes: length(&path)?, seconds: with - without })
}

/// Lets Verilator write its trace of the ports, with one dump per clock.
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

/// A sink that accepts all changes and writes nothing.
struct Nothing;

impl PinSink for Nothing {
    fn change(&mut self, _: carrystep_check::PinChange) -> Result<(), carrystep_check::TraceError> {
        Ok(())
    }
}

/// Writes the output ports whenever one of them changes.
struct PortDump {
    out: vcd::Writer<BufWriter<File>>,
    ids: [vcd::IdCode; 5],
    before: Option<[Vec<u32>; 5]>,
}

/// Name and width of each port.
const PORTS: [(&str, u32); 5] =
    [("step", 6), ("dir", 6), ("idle", 1), ("position", 192), ("discarded", 192)];

impl PortDump {
    fn create(path: &Path) -> std::io::Result<Self> {
        let mut out = vcd::Writer::new(BufWriter::with_capacity(1 << 18, File::create(path)?));
        let mut ids = [vcd::IdCode::FIRST; 5];
        out.add_module("carrystep_parallel_6")?;
        for (id, (name, bits)) in ids.iter_mut().zip(PORTS) {
            *id = out.add_wire(bits, name)?;
        }
        out.upscope()?;
        out.enddefinitions()?;
        Ok(Self { out, ids, before: None })
    }

    fn change(&mut self, cycle: u64, outputs: &Outputs) -> std::io::Result<()> {
        let words = |axes: [u32; AXES]| axes.into_iter().rev().collect();
        let now = [
            vec![outputs.step.into()],
            vec![outputs.dir.into()],
            vec![outputs.idle.into()],
            words(outputs.position.map(i32::cast_unsigned)),
            words(outputs.discarded),
        ];
        self.out.timestamp(cycle)?;
        for (i, (_, bits)) in PORTS.into_iter().enumerate() {
            if self.before.as_ref().is_none_or(|before| before[i] != now[i]) {
                vector(&mut self.out, self.ids[i], &now[i], bits)?;
            }
        }
        self.before = Some(now);
        Ok(())
    }
}

/// Writes a vector of words, the highest word first, in one piece, because the library formats each
/// bit by itself.
fn vector(
    out: &mut vcd::Writer<BufWriter<File>>,
    id: vcd::IdCode,
    words: &[u32],
    bits: u32,
) -> std::io::Result<()> {
    let mut text = vec![b'b'];
    for word in words {
        text.extend((0..bits.min(32)).rev().map(|bit| b'0' + (word >> bit & 1) as u8));
    }
    out.writer().write_all(&text)?;
    writeln!(out.writer(), " {id}")
}

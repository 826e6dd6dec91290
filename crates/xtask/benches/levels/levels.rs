//! Measures every level on the same move, in clock cycles per second.

use crate::moves::Moves;
use crate::stopwatch;
use carrystep_model::fast::{Change, Edge, Edges};
use carrystep_simulators::engine::run::EngineJob;
use carrystep_simulators::{Job, Level, LevelError, fast};
use std::time::Instant;

/// Time for which a level of this process is measured, seconds.
const BUDGET: f64 = 0.3;

/// Counts all edges, and hashes the clock, axis, kind and direction of each.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub struct Consumer {
    pub pulses: u64,
    pub dir_changes: u64,
    pub hash: u64,
}

impl Edges for Consumer {
    #[inline]
    fn edge(&mut self, Edge { clock, axis, change, backward }: Edge) {
        let dir_change = change == Change::DirChange;
        self.pulses += u64::from(!dir_change);
        self.dir_changes += u64::from(dir_change);
        let word =
            clock << 5 | u64::from(axis) << 2 | u64::from(dir_change) << 1 | u64::from(backward);
        self.hash = (self.hash ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    }
}

/// Returns the seconds that the fast model needs for the whole move, and the edges that its
/// consumer counted.
pub fn fast(moves: &Moves) -> Result<(f64, Consumer), String> {
    let (seconds, result) = stopwatch::least(BUDGET, || {
        let mut listener = fast::EdgesOnly(Consumer::default());
        fast::run(&moves.job(), &mut listener).map(|_| listener.0)
    });
    result.map(|consumer| (seconds, consumer)).map_err(|error| error.to_string())
}

/// Returns how many times faster than real time the fast model runs an engine of 80 MHz. It is an
/// error if the engine has a fault, or counts other pulses or reversals than the core (`heard`).
pub fn engine(moves: &Moves, heard: &Consumer) -> Result<f64, String> {
    let job = EngineJob::new(&moves.engine, &moves.program, moves.plan.total_ticks());
    let (seconds, result) = stopwatch::least(BUDGET, || {
        let mut listener = fast::EdgesOnly(Consumer::default());
        job.run_fast(&mut listener).map(|outcome| (outcome, listener.0))
    });
    let (outcome, consumer) = result.map_err(|error| error.to_string())?;
    if outcome.fault.is_some()
        || (consumer.pulses, consumer.dir_changes) != (heard.pulses, heard.dir_changes)
    {
        return Err(format!(
            "the engine makes other pulses: {consumer:?}, fault {:?}",
            outcome.fault
        ));
    }
    Ok(outcome.clocks as f64 / moves.engine.timebase.clock_hz() as f64 / seconds)
}

/// Returns the clock cycles per second of a slower level over the first `clocks` clocks of a move.
/// The time is processor time, or elapsed time if the level runs in a process of its own.
pub fn clocks_per_second(level: Level, moves: &Moves, clocks: u64) -> Result<f64, String> {
    let run = |clocks: u64| {
        let (begin, wall) = (stopwatch::now(), Instant::now());
        let job = Job { max_clocks: clocks, ..moves.job() };
        match carrystep_simulators::run(level, &job, &mut |_, _| {}) {
            Ok(_) | Err(LevelError::Endless(_)) => match level {
                Level::Fast | Level::Model | Level::RustHdl => Ok(stopwatch::now() - begin),
                Level::Icarus | Level::Verilator => Ok(wall.elapsed().as_secs_f64()),
            },
            Err(error) => Err(error.to_string()),
        }
    };
    // The time to start is contained in both runs and cancels in their difference.
    let few = run(clocks / 10)?;
    Ok((clocks - clocks / 10) as f64 / (run(clocks)? - few).max(1e-9))
}

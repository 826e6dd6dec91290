//! Runs the fast model under the host, which can wait for many cycles at once.

use crate::host::Host;
pub use crate::listener::{EdgesOnly, Listener};
use crate::replay::Replay;
use crate::{Job, LevelError, Observer, Outcome, halted, how_far};
use carrystep_core::build::check_parallel_axes;
use carrystep_core::ports::Outputs;
use carrystep_model::Fast;

/// Runs a job on the fast model, and reports every cycle in which any output changed, as the other
/// levels do.
pub(crate) fn replay(job: &Job<'_>, observer: &mut Observer<'_>) -> Result<Outcome, LevelError> {
    let mut replay = Replay::new(&job.build.pins, observer);
    let end = run(job, &mut replay);
    replay.reach(end.as_ref().map_or(job.limit(), |outcome| outcome.clocks));
    end
}

/// Runs a job on the fast model; `listener` receives the edges as they occur.
///
/// # Errors
/// [`LevelError::Endless`] if the run does not end; [`LevelError::Halted`] if it was halted;
/// [`LevelError::Axes`] if no core has the number of axes of the job.
pub fn run(job: &Job<'_>, listener: &mut impl Listener<Outputs>) -> Result<Outcome, LevelError> {
    check_parallel_axes(job.axes)?;
    let mut core = Fast::new(job.build, job.axes);
    let mut host = Host::new(job.program);
    let mut quiet = 0;
    let mut origin = None;
    while core.cycle() < job.limit() {
        if halted(job.halt) {
            return Err(LevelError::Halted);
        }
        let cycle = core.cycle();
        how_far::tell(job.how_far, cycle);
        let fault = core.core().faults().any();
        let inputs = host.inputs(fault);
        let outputs = core.outputs(&inputs);
        listener.outputs(cycle, &outputs);
        if outputs.started && origin.is_none() {
            origin = Some(cycle + 1);
        }
        quiet = if host.is_done() && (outputs.idle || fault) { quiet + 1 } else { 0 };
        if quiet == job.tail {
            return Ok(Outcome { clocks: cycle + 1, origin, last: outputs });
        }
        let to_the_end = if quiet > 0 { job.tail - quiet } else { u64::MAX };
        let most = host.patience(&outputs).min(to_the_end).min(job.limit() - cycle);
        match if most > 0 { core.leap(&inputs, most, listener) } else { 0 } {
            0 => {
                host.advance(&outputs);
                core.clock(&inputs, listener);
            }
            cycles => {
                host.wait(cycles);
                // The first of these cycles was counted above.
                quiet += if quiet > 0 { cycles - 1 } else { 0 };
            }
        }
    }
    Err(LevelError::Endless(job.limit()))
}

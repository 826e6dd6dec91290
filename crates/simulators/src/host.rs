//! The host that feeds a core clock by clock, as defined in docs/clock-by-clock.md, "host".

use crate::{Commands, Job, LevelError, Observer, Outcome, halted, how_far};
use carrystep_core::Command;
use carrystep_core::ports::{Inputs, Outputs};

/// A parallel core that is simulated in Rust, clock by clock.
pub trait SimulatedCore {
    /// The outputs of this cycle for these inputs.
    fn outputs(&mut self, inputs: &Inputs) -> Outputs;
    /// Advances to the next cycle.
    fn clock(&mut self, inputs: &Inputs);
}

impl SimulatedCore for carrystep_model::ParallelCore {
    fn outputs(&mut self, inputs: &Inputs) -> Outputs {
        Self::outputs(self, inputs)
    }
    fn clock(&mut self, inputs: &Inputs) {
        Self::clock(self, inputs);
    }
}

impl SimulatedCore for carrystep_hdl::ParallelSim {
    fn outputs(&mut self, inputs: &Inputs) -> Outputs {
        self.settle(inputs)
    }
    fn clock(&mut self, _: &Inputs) {
        Self::clock(self);
    }
}

/// The host, with the commands that are left.
pub(crate) struct Host<'a> {
    commands: Box<dyn Iterator<Item = Command> + 'a>,
    current: Option<Command>,
}

impl<'a> Host<'a> {
    pub(crate) fn new(program: &'a dyn Commands) -> Self {
        // The parallel core has no outputs.
        let commands = program.commands();
        let mut commands = commands.filter(|command| !matches!(command, Command::Outputs(_)));
        let current = commands.next();
        Self { commands: Box::new(commands), current }
    }

    /// The inputs of this cycle. While the core is frozen, the host only clears and waits.
    pub(crate) fn inputs(&self, fault: bool) -> Inputs {
        match self.current {
            Some(Command::Segment { axis, segment }) if !fault => {
                Inputs { segment: Some((axis, segment)), ..Inputs::default() }
            }
            Some(Command::Start { mask }) if !fault => {
                Inputs { start: Some(mask), ..Inputs::default() }
            }
            Some(Command::Clear) => Inputs { clear: true, ..Inputs::default() },
            _ => Inputs::default(),
        }
    }

    /// Continues with the next command if the current one was accepted in this cycle.
    pub(crate) fn advance(&mut self, outputs: &Outputs) {
        let fault = outputs.faults.any();
        let done = match &mut self.current {
            None | Some(Command::Outputs(_)) => false,
            Some(Command::Segment { .. }) => fault || outputs.seg_ready,
            Some(Command::Start { .. }) => fault || outputs.start_ready,
            Some(Command::Wait { clocks }) => {
                *clocks = clocks.saturating_sub(1);
                *clocks == 0
            }
            Some(Command::Clear) => !fault,
        };
        if done {
            self.current = self.commands.next();
        }
    }

    /// Whether no command is left.
    pub(crate) fn is_done(&self) -> bool {
        self.current.is_none()
    }

    /// Number of cycles in which the host's inputs stay the same, as long as the outputs make it
    /// wait.
    pub(crate) fn patience(&self, outputs: &Outputs) -> u64 {
        let blocked = match self.current {
            Some(Command::Wait { clocks }) => return u64::from(clocks.saturating_sub(1)),
            Some(Command::Segment { .. }) => !outputs.faults.any() && !outputs.seg_ready,
            Some(Command::Start { .. }) => !outputs.faults.any() && !outputs.start_ready,
            Some(Command::Clear) => outputs.faults.any(),
            None | Some(Command::Outputs(_)) => true,
        };
        if blocked { u64::MAX } else { 0 }
    }

    /// Skips this number of cycles, at most [`Host::patience`].
    pub(crate) fn wait(&mut self, cycles: u64) {
        if let Some(Command::Wait { clocks }) = &mut self.current {
            // The number is at most the patience, which fits.
            *clocks = clocks.saturating_sub(u32::try_from(cycles).unwrap_or(u32::MAX));
        }
    }
}

/// The first cycle after a start; `None` if no start is executed.
pub(crate) fn first_start(core: &mut impl SimulatedCore, job: &Job<'_>) -> Option<u64> {
    let mut host = Host::new(job.program);
    let mut cycle = 0;
    while cycle < job.limit() {
        let inputs = host.inputs(false);
        let outputs = core.outputs(&inputs);
        if outputs.started {
            return Some(cycle + 1);
        }
        host.advance(&outputs);
        core.clock(&inputs);
        cycle += 1;
    }
    None
}

/// Feeds a core until the program is over and the outputs no longer change.
pub(crate) fn run(
    core: &mut impl SimulatedCore,
    job: &Job<'_>,
    observer: &mut Observer<'_>,
) -> Result<Outcome, LevelError> {
    let mut host = Host::new(job.program);
    let mut before = None;
    let mut fault = false;
    let mut quiet = 0;
    let mut origin = None;
    for cycle in 0..job.max_clocks {
        if halted(job.halt) {
            return Err(LevelError::Halted);
        }
        how_far::tell(job.how_far, cycle);
        // The host's inputs depend on the fault of the same cycle: evaluate again if the fault has
        // just changed.
        let mut inputs = host.inputs(fault);
        let mut outputs = core.outputs(&inputs);
        if outputs.faults.any() != fault {
            fault = outputs.faults.any();
            inputs = host.inputs(fault);
            outputs = core.outputs(&inputs);
        }
        if before != Some(outputs) {
            observer(cycle, &outputs);
            before = Some(outputs);
        }
        if outputs.started && origin.is_none() {
            origin = Some(cycle + 1);
        }
        quiet = if host.is_done() && (outputs.idle || fault) { quiet + 1 } else { 0 };
        if quiet == job.tail {
            return Ok(Outcome { clocks: cycle + 1, origin, last: outputs });
        }
        host.advance(&outputs);
        core.clock(&inputs);
    }
    Err(LevelError::Endless(job.max_clocks))
}

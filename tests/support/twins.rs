//! Runs the fast model and the clock-by-clock model of the parallel core side by side with the same
//! inputs in every clock. The registers must be equal wherever the fast model stops.

use carrystep_core::ports::Inputs;
use carrystep_core::{AXES, Build, Command};
use carrystep_model::fast::{Change, Edge};
use carrystep_model::{Fast, ParallelCore};

/// Both models, and their edges since the last comparison.
pub struct Twins {
    fast: Fast,
    slow: ParallelCore,
    fast_edges: Vec<Edge>,
    slow_edges: Vec<Edge>,
    /// The greatest lengths of the leaps, used in turn, so that a leap can end in any clock.
    leaps: Vec<u64>,
    turn: usize,
    /// Number of edges so far.
    pub edges: u64,
    /// Number of clocks that the fast model skipped.
    pub leapt: u64,
}

impl Twins {
    /// Both models at configuration.
    pub fn new(build: &Build, leaps: Vec<u64>) -> Self {
        Self {
            fast: Fast::new(build, AXES),
            slow: ParallelCore::new(build, AXES),
            fast_edges: Vec::new(),
            slow_edges: Vec::new(),
            leaps,
            turn: 0,
            edges: 0,
            leapt: 0,
        }
    }

    /// Executes the host's commands in order; the run ends `tail` clocks after the last one.
    pub fn feed(&mut self, program: &[Command], tail: u64) -> Result<(), String> {
        for command in program {
            match *command {
                Command::Segment { axis, segment } => {
                    let inputs = Inputs { segment: Some((axis, segment)), ..Inputs::default() };
                    self.offer(&inputs, |slow| slow.outputs(&inputs).seg_ready)?;
                }
                Command::Start { mask } => {
                    let inputs = Inputs { start: Some(mask), ..Inputs::default() };
                    self.offer(&inputs, |slow| slow.outputs(&inputs).start_ready)?;
                }
                // The parallel core has no outputs.
                Command::Outputs(_) => {}
                Command::Wait { clocks } => self.pass(&Inputs::default(), clocks.into())?,
                Command::Clear => {
                    let inputs = Inputs { clear: true, ..Inputs::default() };
                    self.until(&inputs, |slow| !slow.faults().any())?;
                }
            }
        }
        self.until(&Inputs::default(), |slow| {
            slow.faults().any() || slow.outputs(&Inputs::default()).idle
        })?;
        self.pass(&Inputs::default(), tail)
    }

    /// Holds inputs until they are accepted. It returns without waiting if the core is frozen,
    /// because a frozen core accepts nothing.
    fn offer(
        &mut self,
        inputs: &Inputs,
        taken: impl Fn(&ParallelCore) -> bool,
    ) -> Result<(), String> {
        self.until(inputs, |slow| slow.faults().any() || taken(slow))?;
        if self.slow.faults().any() { Ok(()) } else { self.clock(inputs) }
    }

    fn until(
        &mut self,
        inputs: &Inputs,
        done: impl Fn(&ParallelCore) -> bool,
    ) -> Result<(), String> {
        while !done(&self.slow) {
            self.advance(inputs, u64::MAX)?;
        }
        Ok(())
    }

    fn pass(&mut self, inputs: &Inputs, clocks: u64) -> Result<(), String> {
        let end = self.fast.cycle() + clocks;
        while self.fast.cycle() < end {
            self.advance(inputs, end - self.fast.cycle())?;
        }
        Ok(())
    }

    /// Executes a leap, or one clock if no leap is possible.
    fn advance(&mut self, inputs: &Inputs, most: u64) -> Result<(), String> {
        let longest = self.leaps[self.turn % self.leaps.len()];
        self.turn += 1;
        let clocks = self.fast.leap(inputs, most.min(longest), &mut self.fast_edges);
        if clocks == 0 {
            return self.clock(inputs);
        }
        let first = self.fast.cycle() - clocks;
        for cycle in first..self.fast.cycle() {
            self.slow_clock(inputs, cycle);
        }
        self.leapt += clocks;
        self.compare()
    }

    fn clock(&mut self, inputs: &Inputs) -> Result<(), String> {
        let cycle = self.fast.cycle();
        self.fast.clock(inputs, &mut self.fast_edges);
        self.slow_clock(inputs, cycle);
        self.compare()
    }

    /// Executes one clock of the slow model and derives its edges from its pins alone.
    fn slow_clock(&mut self, inputs: &Inputs, cycle: u64) {
        let pins = |slow: &ParallelCore| {
            std::array::from_fn::<_, AXES, _>(|axis| {
                (slow.shaper(axis).step, slow.shaper(axis).dir)
            })
        };
        let before = pins(&self.slow);
        self.slow.clock(inputs);
        let edge = |axis, change, backward| Edge { clock: cycle + 1, axis, change, backward };
        for (axis, ((step_before, dir_before), (step, dir))) in
            (0..).zip(before.into_iter().zip(pins(&self.slow)))
        {
            if step && !step_before {
                self.slow_edges.push(edge(axis, Change::Rise, dir));
            }
            if dir != dir_before {
                self.slow_edges.push(edge(axis, Change::DirChange, dir));
            }
        }
    }

    fn compare(&mut self) -> Result<(), String> {
        let cycle = self.fast.cycle();
        if self.fast_edges != self.slow_edges {
            let pair =
                self.fast_edges.iter().zip(&self.slow_edges).find(|(fast, slow)| fast != slow);
            let counts = (self.fast_edges.len(), self.slow_edges.len());
            return Err(format!(
                "up to cycle {cycle}: edges {counts:?} (fast, slow), first difference {pair:?}"
            ));
        }
        if *self.fast.core() != self.slow {
            return Err(format!(
                "cycle {cycle}: registers\n fast {:?}\n slow {:?}",
                self.fast.core(),
                self.slow
            ));
        }
        self.edges += self.fast_edges.len() as u64;
        self.fast_edges.clear();
        self.slow_edges.clear();
        Ok(())
    }
}

//! From edges back to the outputs of every cycle in which any of them changed.

use crate::Observer;
use crate::fast::Listener;
use carrystep_model::fast::{Change, Edge, Edges};
use carrystep_spec::ports::Outputs;
use carrystep_spec::{AXES, Build};

/// No fall is due.
const NEVER: u64 = u64::MAX;

/// Tells an observer what it would hear from the clock-by-clock model.
pub(crate) struct Replay<'a> {
    observer: &'a mut Observer<'a>,
    width: [u64; AXES],
    /// When STEP falls.
    falls: [u64; AXES],
    first_fall: u64,
    /// The outputs in cycle `at`, as far as they are known.
    at: u64,
    now: Outputs,
    /// What was told last.
    told: Option<Outputs>,
}

impl<'a> Replay<'a> {
    pub(crate) fn new(build: &Build, observer: &'a mut Observer<'_>) -> Self {
        let width = build.pins.map(|pins| pins.width.into());
        Self { observer, width, falls: [NEVER; AXES], first_fall: NEVER, at: 0, now: Outputs::default(), told: None }
    }

    /// All that happens before this cycle is known: tell it.
    pub(crate) fn reach(&mut self, cycle: u64) {
        while self.first_fall <= cycle {
            self.settle(self.first_fall);
            for (axis, fall) in self.falls.iter_mut().enumerate().filter(|(_, fall)| **fall == self.at) {
                self.now.step &= !(1 << axis);
                *fall = NEVER;
            }
            self.first_fall = self.falls.into_iter().min().unwrap_or(NEVER);
        }
        self.settle(cycle);
    }

    fn settle(&mut self, cycle: u64) {
        if cycle > self.at {
            if self.told != Some(self.now) {
                (self.observer)(self.at, &self.now);
                self.told = Some(self.now);
            }
            self.at = cycle;
        }
    }
}

impl Edges for Replay<'_> {
    fn edge(&mut self, edge: Edge) {
        self.reach(edge.clock);
        let axis = usize::from(edge.axis);
        match edge.change {
            Change::Turn => self.now.dir ^= 1 << axis,
            Change::Rise => {
                self.now.step |= 1 << axis;
                let position = &mut self.now.position[axis];
                *position = position.wrapping_add(if edge.backward { -1 } else { 1 });
                self.falls[axis] = edge.clock + self.width[axis];
                self.first_fall = self.first_fall.min(self.falls[axis]);
            }
        }
    }
}

impl Listener for Replay<'_> {
    fn outputs(&mut self, cycle: u64, outputs: &Outputs) {
        self.reach(cycle);
        self.now = *outputs;
    }
}

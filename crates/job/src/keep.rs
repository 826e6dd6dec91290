//! The check of rows that were re-timed: exactly, against each limit of each motor.

use crate::error::JobError;
use crate::row::Row;
use crate::turn::{Pair, quiet};
use crate::weave::obeys;
use carrystep_core::Segment;
use carrystep_files::Machine;
use carrystep_plan::exact::{ExactLimits, travel};

/// A tick at rest.
pub(crate) const REST: Segment = Segment { ticks: 1, v: 0, a: 0, j: 0, last: false };

/// What the motors of a machine may do.
#[derive(Debug, Clone)]
pub(crate) struct Keep {
    pub limits: Vec<ExactLimits>,
    /// For each motor, the ticks around a reversal that have to be free of edges.
    quiet: Vec<u32>,
}

impl Keep {
    /// # Errors
    /// [`JobError::Axes`].
    pub fn new(machine: &Machine) -> Result<Self, JobError> {
        let limits = crate::limits::exact(machine);
        let quiet = machine.axes.iter().map(|axis| quiet(&axis.pins, &machine.timebase)).collect();
        Ok(Self { limits, quiet })
    }

    /// The number of the first row that breaks a limit, from the segments before the rows to those
    /// behind them. P of each motor is `at` where they begin. `None` if all rows keep all limits.
    pub fn broken(
        &self,
        at: &[i128],
        before: &[Segment],
        rows: &[Row],
        after: &[Segment],
    ) -> Option<usize> {
        let motors = self.limits.iter().zip(&self.quiet).zip(at).enumerate();
        let first = |(axis, ((limits, &quiet), &at)): (usize, ((&ExactLimits, &u32), &i128))| {
            let first = before[axis];
            let mut held =
                i128::from(first.a) + (i128::from(first.ticks) - 1) * i128::from(first.j);
            let (mut at, mut earlier) = (at - travel(&first, first.ticks.into()), first);
            let mut segments = rows.iter().map(|row| row.segments[axis]).chain([after[axis]]);
            segments.position(|segment| {
                let end = obeys(&segment, limits, held);
                let is_quiet = Pair { at, before: &earlier, now: &segment }.is_quiet(quiet);
                held = end.unwrap_or(held);
                at += travel(&earlier, earlier.ticks.into());
                earlier = segment;
                end.is_err() || !is_quiet
            })
        };
        motors.filter_map(first).min()
    }
}

//! Lines that would move an axis toward a limit switch that is closed already.
//!
//! Before a batch is planned, the switches are read. If one is closed, the batch ends before the
//! first line that moves an axis toward it, and the batch of that line is an alarm. Once an axis has
//! moved away, the board itself stops it when its switch closes again.

use super::server::Server;
use crate::failure::Failure;
use crate::limits::{Blocked, ClosedLimits, ways};
use carrystep_core::engine::LimitWiring;
use carrystep_runner::MotionGuard;

impl Server<'_> {
    /// Reads the limit switches if a batch is to be planned. What is closed guards its lines.
    pub fn reads_limits(&mut self) -> Result<(), Failure> {
        let wiring = self.machine.guard.limits;
        if wiring == LimitWiring::None || !self.requests.may_plan() {
            return Ok(());
        }
        let read = ClosedLimits::read(self.board);
        let closed = read.map_err(|error| self.lost(&error))?;
        let mut met = self.memory.limits();
        for (axis, met) in met.iter_mut().enumerate() {
            if met.is_some() && !closed.any(axis) {
                self.memory.set_limit(axis, None);
                *met = None;
            }
        }
        self.requests.guard = (closed.low | closed.high != 0).then(|| {
            let (axes, letters) = (self.axes.to_vec(), self.machine.letter_numbers());
            let guard: MotionGuard = Box::new(move |directions| {
                // Each motor of a letter moves as the letter does.
                let motors: Vec<i8> = letters.iter().map(|&letter| directions[letter]).collect();
                let blocked = closed.blocked(wiring, &motors, &met);
                blocked.map_or(Ok(()), |blocked| Err(why(blocked, &axes)))
            });
            guard
        });
        Ok(())
    }
}

fn why(Blocked { axis, direction, is_known }: Blocked, axes: &[String]) -> String {
    let (axis, [further, away]) = (&axes[axis], ways(direction));
    if is_known {
        format!(
            "the limit switch of axis {axis} is closed, and the line would move it further {further}: \
             unlock, and move it {away}"
        )
    } else {
        format!(
            "the limit switch of axis {axis} is closed, and it is not known at which end: home it, or \
             move it away with carrystep jog --into-limit"
        )
    }
}

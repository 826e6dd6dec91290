//! The direction in which each axis moves, which says at which end a limit was met.

use crate::belt_ways::BeltWays;
use carrystep_files::Machine;
use carrystep_link::Status;

/// The direction in which each motor was last seen moving.
pub(super) struct Ways {
    /// Of crossed belts, also those of x and y.
    pub belts: BeltWays,
    positions: Option<[i32; 8]>,
    /// 1, -1, or 0 if the axis has not moved.
    pub last: [i8; 8],
}

impl Ways {
    pub fn new(machine: &Machine) -> Self {
        Self { belts: BeltWays::new(machine), positions: None, last: [0; 8] }
    }

    pub fn see(&mut self, status: &Status) {
        self.belts.see(&status.positions);
        let before = self.positions.replace(status.positions).unwrap_or(status.positions);
        for (last, (before, now)) in self.last.iter_mut().zip(before.iter().zip(status.positions)) {
            match now.wrapping_sub(*before).signum() {
                0 => {}
                way => *last = way as i8,
            }
        }
    }
}

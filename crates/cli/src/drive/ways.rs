//! The direction in which each axis moves, which says at which end a limit was met.

use carrystep_link::Status;

/// The direction in which each axis was last seen moving.
#[derive(Default)]
pub(super) struct Ways {
    positions: Option<[i32; 8]>,
    /// 1, -1, or 0 if the axis has not moved.
    pub last: [i8; 8],
}

impl Ways {
    pub fn see(&mut self, status: &Status) {
        let before = self.positions.replace(status.positions).unwrap_or(status.positions);
        for (last, (before, now)) in self.last.iter_mut().zip(before.iter().zip(status.positions)) {
            match now.wrapping_sub(*before).signum() {
                0 => {}
                way => *last = way as i8,
            }
        }
    }
}

//! What the writes that are not acknowledged will do: segments by axis, and whether there is a START,
//! a SNAPSHOT or a CUT among them. A session never has two of these three.

use crate::frame::Body;
use crate::registers::{MOST_AXES, SNAPSHOT, START};

#[derive(Debug, Clone, Default)]
pub(super) struct UnderWay {
    /// Number of segments of each axis.
    segments: [u8; MOST_AXES as usize],
    pub starting: bool,
    pub capturing: bool,
    pub cutting: bool,
}

impl UnderWay {
    /// A write was queued.
    pub fn add(&mut self, body: &Body) {
        for (_, count) in of_mask(body.axes(), self.segments.iter_mut()) {
            *count += 1;
        }
        self.mark(body, true);
    }

    /// A write was acknowledged or withdrawn.
    pub fn settle(&mut self, body: &Body) {
        for (_, count) in of_mask(body.axes(), self.segments.iter_mut()) {
            *count = count.saturating_sub(1);
        }
        self.mark(body, false);
    }

    fn mark(&mut self, body: &Body, is_under_way: bool) {
        match *body {
            Body::Write { address: START, .. } => self.starting = is_under_way,
            Body::Write { address: SNAPSHOT, .. } => self.capturing = is_under_way,
            Body::Cut(_) => self.cutting = is_under_way,
            _ => {}
        }
    }

    /// Number of segments of an axis; 0 for an axis that no build has.
    pub fn segments(&self, axis: u8) -> u8 {
        self.segments.get(usize::from(axis)).copied().unwrap_or_default()
    }
}

/// The items of the axes of a mask.
pub(super) fn of_mask<T>(
    mask: u8,
    items: impl Iterator<Item = T>,
) -> impl Iterator<Item = (u8, T)> {
    (0..MOST_AXES).zip(items).filter(move |(axis, _)| mask >> axis & 1 == 1)
}

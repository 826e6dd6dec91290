//! The origin of a capture: the time from which all times are counted.

use crate::edge::{Pin, PinChange};
use crate::ideal::Due;
use crate::report::OriginKind;

/// The time of a capture from which all times are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// The origin of a capture by carrystep: the load of the first move plus the latency L.
    Known {
        /// Time of the origin, ps of the capture.
        ps: i64,
    },
    /// The origin of a foreign capture: one offset for all axes, chosen as the midpoint of the
    /// least and the greatest error of all axes together. An offset for each axis would hide an
    /// axis that is late.
    Midpoint,
    /// An origin that the user gives.
    Fixed {
        /// Time of the origin, ps of the capture.
        ps: i64,
    },
}

/// The origin of a capture while it is read.
#[derive(Debug)]
pub(crate) struct RunningOrigin {
    origin: Origin,
    /// The origin from which errors are counted, ps. For a foreign capture it is estimated from the
    /// first pulse, and corrected at the end.
    base_ps: Option<i64>,
}

/// The origin from which errors are counted while a capture is read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Base {
    /// Time of the origin, ps of the capture; the same for all axes.
    pub(crate) ps: i64,
    /// Whether it is the origin, and not only an estimate.
    pub(crate) is_sure: bool,
}

impl RunningOrigin {
    pub(crate) fn new(origin: Origin) -> Self {
        let base_ps = match origin {
            Origin::Known { ps } | Origin::Fixed { ps } => Some(ps),
            Origin::Midpoint => None,
        };
        Self { origin, base_ps }
    }

    /// Estimates the origin of a foreign capture from its first pulse. `first` tells when the first
    /// pulse of an axis is due.
    pub(crate) fn estimate(&mut self, change: PinChange, first: impl FnOnce(usize) -> Option<Due>) {
        if self.base_ps.is_none() && change.pin == Pin::Step && change.level {
            let due = first(usize::from(change.axis));
            self.base_ps = due.and_then(|due| due.origin_for(change.ps));
        }
    }

    /// The origin from which errors are counted, ps; `None` if it is not estimated yet.
    pub(crate) fn base_ps(&self) -> Option<i64> {
        self.base_ps
    }

    /// Sets the origin, where the beginning of the capture was read before.
    pub(crate) fn set_base_ps(&mut self, base_ps: Option<i64>) {
        self.base_ps = base_ps;
    }

    pub(crate) fn base(&self) -> Base {
        Base { ps: self.base_ps.unwrap_or(0), is_sure: self.origin != Origin::Midpoint }
    }

    pub(crate) fn kind(&self) -> OriginKind {
        match self.origin {
            Origin::Known { .. } => OriginKind::Known,
            Origin::Midpoint => OriginKind::Midpoint,
            Origin::Fixed { .. } => OriginKind::Fixed,
        }
    }
}

//! The check of a part of a capture, from any time on.
//!
//! The parts of a capture can be checked at the same time, because each begins with an assumption:
//! that the next crossing is the one that would be next if all pulses were in time. A checker that
//! has seen all that was before a part appends the part if this is right, with the same result as
//! if it had seen the part's edges itself.

use super::Checker;
use crate::axis_check::AxisPart;
use crate::line_check::LinesPart;
use serde::{Deserialize, Serialize};

/// What a part of a capture shows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// The origin from which errors are counted, ps; `None` if the capture has no pulse.
    origin_ps: Option<i64>,
    axes: Vec<AxisPart>,
    lines: Option<LinesPart>,
}

impl Checker<'_> {
    /// Begins at a time of the capture, before any edge. `origin_ps` is the origin, or its
    /// estimate; `levels` are those of STEP and DIR of each axis, that of DIR if it is known.
    pub fn begin_at(&mut self, ps: u64, origin_ps: Option<i64>, levels: &[(bool, Option<bool>)]) {
        self.set_origin_ps(origin_ps);
        let base = self.origin.base();
        for (axis, &levels) in self.axes.iter_mut().zip(levels) {
            axis.begin_at(ps, levels, base);
        }
        if let Some(lines) = &mut self.lines {
            let pulses = self.axes.iter().map(|axis| axis.number() - 1).collect();
            lines.begin_at(pulses, levels.iter().map(|&(step, _)| step).collect());
        }
    }

    /// Whether a crossing of any axis is so near to a time of the capture that its pulse may come
    /// before or after it. The times must rise from call to call, and the checker may not check
    /// anything.
    pub fn is_near(&mut self, ps: u64) -> bool {
        let base = self.origin.base();
        // Every axis goes on to this time.
        self.axes.iter_mut().fold(false, |near, axis| axis.is_near(ps, base) | near)
    }

    /// Sets the origin from which errors are counted, ps, if the beginning of the capture was read
    /// before.
    pub fn set_origin_ps(&mut self, origin_ps: Option<i64>) {
        self.origin.set_base_ps(origin_ps);
    }

    /// The origin from which errors are counted, ps; `None` if it is not known yet.
    pub fn origin_ps(&self) -> Option<i64> {
        self.origin.base_ps()
    }

    /// The levels of STEP and DIR of each axis.
    pub fn levels(&self) -> Vec<(bool, Option<bool>)> {
        self.axes.iter().map(|axis| (axis.step(), Some(axis.backward()))).collect()
    }

    /// Ends the check of a part.
    pub fn into_part(self) -> Part {
        Part {
            origin_ps: self.origin.base_ps(),
            axes: self.axes.into_iter().map(super::AxisCheck::into_part).collect(),
            lines: self.lines.map(super::LinesCheck::into_part),
        }
    }

    /// Appends a part that begins where this checker is. Returns false, and appends nothing, if the
    /// part has begun with a wrong assumption: its edges have to be checked by this checker.
    pub fn append(&mut self, part: &Part) -> bool {
        let origin_ps = self.origin.base_ps().or(part.origin_ps);
        if origin_ps != part.origin_ps || self.axes.len() != part.axes.len() {
            return false;
        }
        let before = self.origin.base_ps();
        self.origin.set_base_ps(origin_ps);
        let base = self.origin.base();
        let mut axes = self.axes.iter_mut().zip(&part.axes);
        let axes = axes.all(|(axis, part)| axis.leads_to(part, base));
        let lines = match (&self.lines, &part.lines) {
            (Some(lines), Some(part)) => lines.leads_to(part),
            (None, None) => true,
            _ => false,
        };
        if !axes || !lines {
            self.origin.set_base_ps(before);
            return false;
        }
        for (axis, part) in self.axes.iter_mut().zip(&part.axes) {
            axis.append(part);
        }
        let high = self.axes.iter().map(super::AxisCheck::step).collect();
        if let (Some(lines), Some(part)) = (&mut self.lines, &part.lines) {
            lines.append(part, high);
        }
        true
    }
}

//! What a part of a capture shows of one axis, and how the parts are appended to each other.
//!
//! A part does not know what was before it. It begins with the crossing that comes next if all
//! pulses were in time, and pairs its first pulse with that. The check of what was before decides
//! whether this is right.

use super::{AxisCheck, Found, Paired, greater};
use crate::origin::Base;
use crate::pins::PinWatch;
use serde::{Deserialize, Serialize};

/// What a part of a capture shows of one axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct AxisPart {
    /// Number of the next crossing, counted from 1, with which the part has begun; `None` if it has
    /// begun at the start of the capture, and assumes nothing.
    number: Option<u64>,
    /// Number of the next crossing at its end.
    end: u64,
    /// The first pulse, if there is one and it was paired.
    first: Option<Paired>,
    found: Found,
    failures: Vec<String>,
}

impl AxisCheck<'_> {
    /// Begins at a time of the capture, with the levels of STEP and DIR, as far as they are known.
    pub(crate) fn begin_at(&mut self, ps: u64, (step, dir): (bool, Option<bool>), base: Base) {
        self.ahead.go_to(ps, base.ps, 0.0);
        self.begun_at = Some(self.ahead.number());
        self.found.watch = PinWatch::from_levels(step, dir);
    }

    /// Whether a crossing is nearer to a time of the capture than the tolerance. The times must
    /// rise from call to call.
    pub(crate) fn is_near(&mut self, ps: u64, base: Base) -> bool {
        self.ahead.go_to(ps, base.ps, self.tolerance_ps)
    }

    /// The level of STEP.
    pub(crate) fn step(&self) -> bool {
        self.found.watch.step()
    }

    /// The level of DIR; true is backward.
    pub(crate) fn backward(&self) -> bool {
        self.found.watch.backward()
    }

    /// Number of the next crossing, counted from 1.
    pub(crate) fn number(&self) -> u64 {
        self.ahead.number()
    }

    /// Ends the check of a part.
    pub(crate) fn into_part(self) -> AxisPart {
        let Self { begun_at: number, first_paired: first, found, failures, ahead, .. } = self;
        AxisPart { number, end: ahead.number(), first, found, failures }
    }

    /// Whether nothing was found yet.
    fn is_fresh(&self) -> bool {
        self.begun_at.is_none() && self.found == Found::new(PinWatch::default())
    }

    /// Whether this check would have found in the part what the part has found.
    pub(crate) fn leads_to(&mut self, part: &AxisPart, base: Base) -> bool {
        let Some(number) = part.number else { return self.is_fresh() };
        if !self.found.watch.leads_to(&part.found.watch) {
            return false;
        }
        if part.found.watch.pulses() == 0 {
            return true;
        }
        let Some(first) = part.first.filter(|_| number == self.number()) else { return false };
        self.look_ahead(first.ps, base);
        let compared = self.compare(first.ps, base);
        compared.lateness_ps == Some(first.lateness_ps)
            && !self.is_extra(&compared)
            && !self.is_missing(&compared, first.ps, base)
    }

    /// Appends a part to which this check leads.
    pub(crate) fn append(&mut self, part: &AxisPart) {
        if part.number.is_none() {
            self.found.watch = part.found.watch.at_its_beginning();
        }
        self.failures.extend_from_slice(&part.failures);
        self.found.append(part.first, &part.found);
        if part.found.watch.pulses() > 0 {
            self.ahead.skip_to(part.end);
        }
    }
}

impl Found {
    /// Appends what was found later. `first` is the first pulse of that.
    fn append(&mut self, first: Option<Paired>, later: &Self) {
        self.watch.append(&later.watch);
        self.position += later.position;
        self.wrong_direction += later.wrong_direction;
        if let Some(first) = first {
            self.follow(first);
        }
        self.last = later.last.or(self.last);
        self.errors.append(&later.errors);
        self.curvature_ps = self.curvature_ps.max(later.curvature_ps);
        for (own, later) in
            [(&mut self.jitter_ps, later.jitter_ps), (&mut self.ripple, later.ripple)]
        {
            if let Some(later) = later {
                *own = greater(*own, later);
            }
        }
        self.shortest_ideal_ps = self.shortest_ideal_ps.min(later.shortest_ideal_ps);
        for message in &later.pulse_failures {
            self.fail_pulse(message.clone());
        }
        self.omitted += later.omitted;
    }
}

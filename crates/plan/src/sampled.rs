//! Where a stretch of a fit is sampled: at each of its edges, or at places that stand for many.
//!
//! A ramp that is fitted for others of many sizes does not know where their edges are. Each then
//! has a least and a greatest place, and is sampled between the two.

use crate::corridor::{Corridor, SAMPLES, Stretch, spread};
use crate::cubic::{steps, wide};
use carrystep_core::fixed::ONE_STEP;
use carrystep_profile::Real;

/// The samples of a stretch, without their rows.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sampled {
    /// Samples that stand for many edges: their times from the start of the piece, ticks.
    Standing([f64; SAMPLES as usize + 1]),
    /// The first and the last pulse that may be due in the stretch; each is a sample.
    Edges(u64, u64),
}

impl<F: Real> Corridor<'_, F> {
    /// The ticks of a stretch between which samples stand for its edges: from the first to the last
    /// edge if they are far apart. `None` if the stretch has so few that each is a sample.
    pub fn span(&self, stretch: Stretch, before: u64, until: u64) -> Option<[f64; 2]> {
        let (begin, n) = (stretch.first as f64, stretch.ticks as f64);
        if until.saturating_sub(before) <= u64::from(SAMPLES) {
            return None;
        }
        // Where edges are far apart, there are none before the first and after the last one.
        let sparse = |t: f64| self.speed(begin + t) * n < 64.0;
        let low = if sparse(0.0) { self.earlier(stretch, before + 1).0.max(0.0) } else { 0.0 };
        let high = if sparse(n) && self.longer <= 1.0 { self.edge(stretch, until).0 } else { n };
        Some([low, high])
    }

    /// What [`Self::rows`] takes as samples.
    pub fn sampled(&self, stretch: Stretch) -> Sampled {
        let begin = stretch.first as f64;
        let here = |t: f64| steps(stretch.done) + self.ahead(stretch.done, begin + t);
        let [before, until] = [0.0, stretch.ticks as f64].map(|t| self.pulses_until(here(t)));
        match self.span(stretch, before, until) {
            Some([low, high]) => {
                Sampled::Standing(std::array::from_fn(|k| begin + low + (high - low) * spread(k)))
            }
            None => Sampled::Edges(before + 1, (until + 1).min(self.pulses)),
        }
    }

    /// The edges of a stretch with few of them, as [`Self::edge`] gives them. Where the ramp may be
    /// longer, an edge is three of the places that it may have, as far as they are in the stretch.
    pub fn edges(
        &self,
        stretch: Stretch,
        before: u64,
        until: u64,
    ) -> impl Iterator<Item = (f64, f64)> + use<'_, F> {
        let n = stretch.ticks as f64;
        let one = self.longer <= 1.0;
        let last = if one { until } else { (until + 1).min(self.pulses) };
        let parts = if one { &[1.0][..] } else { &[0.0, 0.5, 1.0] };
        (before + 1..=last).flat_map(move |pulse| {
            let places = parts.iter().map(move |&part| self.placed(stretch, pulse, part));
            places.filter(move |&(t, _)| one || (0.0..=n).contains(&t))
        })
    }

    /// [`Self::edge`] at the least place that the pulse may have.
    pub fn earlier(&self, stretch: Stretch, pulse: u64) -> (f64, f64) {
        self.placed(stretch, pulse, 0.0)
    }

    /// [`Self::edge`] at a `part` of the way from the least place of the pulse to the greatest.
    fn placed(&self, stretch: Stretch, pulse: u64, part: f64) -> (f64, f64) {
        if self.longer <= 1.0 || part >= 1.0 {
            return self.edge(stretch, pulse);
        }
        let half_steps = self.phase.pulse_half_steps(pulse, self.backward) as f64;
        let place = half_steps / 2.0 * (part + (1.0 - part) / self.longer);
        let due = self.profile.crossing(F::from(place).unwrap_or_else(F::nan));
        let t = wide((due - self.clock.at(self.piece.first + stretch.first)) / self.clock.tick);
        (t, place - steps(stretch.done))
    }

    /// Number of pulses that are due up to a position.
    pub fn pulses_until(&self, position: f64) -> u64 {
        let offset = self.phase.pulse_half_steps(1, self.backward) as f64 / 2.0;
        ((position - offset + 1.0).floor().max(0.0) as u64).min(self.pulses)
    }

    /// The time at which a pulse is due, in ticks of the stretch, and its distance from `done` in
    /// steps.
    pub fn edge(&self, Stretch { first, done, .. }: Stretch, pulse: u64) -> (f64, f64) {
        let half_steps = self.phase.pulse_half_steps(pulse, self.backward);
        let due = self.profile.crossing(F::from(half_steps as f64 / 2.0).unwrap_or_else(F::nan));
        let t = wide((due - self.clock.at(self.piece.first + first)) / self.clock.tick);
        (t, steps(i128::from(half_steps) * (ONE_STEP / 2) - done))
    }
}

//! A profile of one kind, ready to be listed and drawn.

use crate::reference::error::ReferenceError;
use crate::reference::row::{Listing, MOST_ROWS, Row};
use crate::{Curve, CurveFigures};
use carrystep_core::ProfileKind;
use std::sync::Arc;

/// A float profile together with its kind.
#[derive(Debug, Clone)]
pub struct Reference {
    kind: ProfileKind,
    ramp: bool,
    curve: Arc<dyn Curve<f64>>,
    figures: CurveFigures<f64>,
}

impl Reference {
    pub(crate) fn new(kind: ProfileKind, curve: Arc<dyn Curve<f64>>, ramp: bool) -> Self {
        let figures = curve.figures();
        Self { kind, ramp, curve, figures }
    }

    /// The kind of the profile.
    pub fn kind(&self) -> ProfileKind {
        self.kind
    }

    /// Whether the profile is a ramp that ends at its top speed, and not a move that ends at rest.
    pub fn is_ramp(&self) -> bool {
        self.ramp
    }

    /// The curve of the profile.
    pub fn curve(&self) -> &dyn Curve<f64> {
        &*self.curve
    }

    /// The figures that a user needs to judge the profile.
    pub fn figures(&self) -> &CurveFigures<f64> {
        &self.figures
    }

    /// Number of whole steps in the list. A ramp that ends inside a step is listed to the end of
    /// that step.
    pub fn whole_steps(&self) -> f64 {
        let steps = self.figures.steps;
        let nearest = steps.round();
        if (steps - nearest).abs() <= 1e-9 * nearest { nearest } else { steps.ceil() }
    }

    /// The time t_n at which step `n` is reached, seconds. Beyond the end of a ramp the end speed
    /// continues, as in the cruise that follows.
    pub fn crossing(&self, n: f64) -> f64 {
        let beyond = n - self.figures.steps;
        if beyond <= 0.0 {
            self.curve.crossing(n)
        } else {
            self.figures.seconds + beyond / self.figures.end_speed
        }
    }

    /// The delay c_n = t_(n+1) - t_n, seconds, computed without taking the difference.
    pub fn delay(&self, n: f64) -> f64 {
        let left = self.figures.steps - n;
        if left >= 1.0 {
            return self.curve.delay(n);
        }
        let last = self.curve.mean_speed(self.curve.crossing(n), self.figures.seconds);
        let inside = if left > 0.0 { left / last } else { 0.0 };
        inside + (1.0 - left.max(0.0)) / self.figures.end_speed
    }

    /// The rows of all steps.
    ///
    /// # Errors
    /// [`ReferenceError::TooLong`] for more than [`MOST_ROWS`] steps;
    /// [`ReferenceError::OutOfRange`] for a clock that is not over 0 and at most 10^12 Hz.
    pub fn rows(
        &self,
        listing: &Listing,
    ) -> Result<impl Iterator<Item = Row> + '_, ReferenceError> {
        let steps = self.whole_steps();
        if steps > f64::from(MOST_ROWS) {
            return Err(ReferenceError::TooLong { kind: self.kind, steps });
        }
        let clock_hz = listing.clock_hz;
        if let Some(value) = clock_hz.filter(|clock| !(*clock > 0.0 && *clock <= 1e12)) {
            return Err(ReferenceError::OutOfRange {
                what: "the timer's clock",
                value,
                must: "over 0 and at most 1e12 Hz",
            });
        }
        let last = steps as u32;
        let (first, early) = listing.first();
        Ok((first..=last).map(move |step| {
            let n = f64::from(step) - early;
            let time_s = self.crossing(n);
            let delay_s = (step < last).then(|| self.delay(n));
            Row {
                step,
                time_s,
                speed_steps_per_s: self.curve.speed(time_s),
                delay_s,
                delay_counts: delay_s
                    .zip(clock_hz)
                    .map(|(delay, clock)| (delay * clock).round() as u64),
            }
        }))
    }
}

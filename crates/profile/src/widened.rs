//! The view in f64 of a profile of each float type.

use crate::profile::{Profile, Real, SharedProfile, real};
use std::sync::Arc;

/// A profile that was computed in `F`, for readers that need f64.
#[derive(Debug, Clone)]
struct Widened<F: Real> {
    inner: SharedProfile<F>,
    breakpoints: Vec<f64>,
}

impl<F: Real> Widened<F> {
    /// Creates the f64 view of a profile.
    fn new(inner: SharedProfile<F>) -> Self {
        let breakpoints = inner.breakpoints().iter().map(|&b| wide(b)).collect();
        Self { inner, breakpoints }
    }
}

impl Real for f64 {
    fn widened(profile: SharedProfile) -> SharedProfile {
        profile
    }
}

impl Real for f32 {
    fn widened(profile: SharedProfile<Self>) -> SharedProfile {
        Arc::new(Widened::new(profile))
    }
}

fn wide<F: Real>(value: F) -> f64 {
    value.to_f64().unwrap_or(f64::NAN)
}

impl<F: Real> Profile<f64> for Widened<F> {
    fn shape(&self) -> &'static str {
        self.inner.shape()
    }

    fn duration(&self) -> f64 {
        wide(self.inner.duration())
    }

    fn distance(&self) -> f64 {
        wide(self.inner.distance())
    }

    fn position(&self, t: f64) -> f64 {
        wide(self.inner.position(real(t)))
    }

    fn speed(&self, t: f64) -> f64 {
        wide(self.inner.speed(real(t)))
    }

    fn acceleration(&self, t: f64) -> f64 {
        wide(self.inner.acceleration(real(t)))
    }

    fn jerk(&self, t: f64) -> f64 {
        wide(self.inner.jerk(real(t)))
    }

    fn crossing(&self, x: f64) -> f64 {
        wide(self.inner.crossing(real(x)))
    }

    fn breakpoints(&self) -> &[f64] {
        &self.breakpoints
    }
}

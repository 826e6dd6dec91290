//! The inverse of the sine curve as a small table, for ramps that are computed on the controller.
//!
//! The source tabulates u against s at even distances and interpolates. Near rest u grows with the
//! fourth root of s, so that 256 entries are 17 ms wrong in a ramp of 0.2 s. Against s^(1/4) the
//! curve is nearly straight, and the same 256 entries are 2.3 us wrong.

use crate::sine::Sine;

/// The table of u = t / T against the fourth root of s, the fraction of the ramp's distance, in
/// equal intervals.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseTable {
    knots: Vec<f64>,
}

impl InverseTable {
    /// A table of `intervals` (at least 1) equal intervals.
    pub fn new(intervals: u32) -> Self {
        let curve = Sine { start: 0.0, top: 2.0, steps: 1.0 };
        let intervals = intervals.max(1);
        let knots =
            (0..=intervals).map(|k| curve.crossing((f64::from(k) / f64::from(intervals)).powi(4)));
        Self { knots: knots.collect() }
    }

    /// The values of u at the knots, 0 to 1.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The interpolated u at the fraction `s` (0 to 1) of the ramp's distance.
    pub fn u(&self, s: f64) -> f64 {
        let place = s.clamp(0.0, 1.0).powf(0.25) * (self.knots.len() - 1) as f64;
        let left = place as usize;
        match self.knots.get(left..left + 2) {
            Some(&[a, b]) => a + (b - a) * (place - left as f64),
            _ => 1.0,
        }
    }

    /// The knots as 16-bit words, u x 65535 rounded, in the form that `carrystep_sine.c` reads.
    pub fn words(&self) -> Vec<u16> {
        self.knots.iter().map(|u| (u * f64::from(u16::MAX)).round() as u16).collect()
    }
}

//! The inverse of the sine curve as a small table, for ramps that are made on the controller.
//!
//! The source tabulates u against s, at even distances, and interpolates: near rest u goes like the fourth
//! root of s, and 256 entries are 17 ms wrong in a ramp of 0.2 s. Against s^(1/4) the curve is nearly
//! straight: the same 256 entries are 2.3 us wrong.

use crate::sine::Sine;

/// u = t / T against the fourth root of the share s of the ramp's distance, in equal intervals.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseTable {
    knots: Vec<f64>,
}

impl InverseTable {
    /// A table of `intervals` (at least 1) equal intervals.
    pub fn new(intervals: u32) -> Self {
        let curve = Sine { start: 0.0, top: 2.0, steps: 1.0 };
        let intervals = intervals.max(1);
        let knots = (0..=intervals).map(|k| curve.crossing((f64::from(k) / f64::from(intervals)).powi(4)));
        Self { knots: knots.collect() }
    }

    /// u at the knots, 0 to 1.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// u where the share `s` (0 to 1) of the ramp is done, interpolated.
    pub fn u(&self, s: f64) -> f64 {
        let place = s.clamp(0.0, 1.0).powf(0.25) * (self.knots.len() - 1) as f64;
        let left = place as usize;
        match self.knots.get(left..left + 2) {
            Some(&[a, b]) => a + (b - a) * (place - left as f64),
            _ => 1.0,
        }
    }

    /// The knots in 16 bits, u 65535 rounded, as `sine.c` reads them.
    pub fn words(&self) -> Vec<u16> {
        self.knots.iter().map(|u| (u * f64::from(u16::MAX)).round() as u16).collect()
    }
}

//! The look-up method: the frequency is a logistic function of the entry index.
//!
//! f_i = f0 + (f1 - f0) / (1 + e^(-Fle (i - m) / m)), with i from 0. The formula of the source is
//! missing from its text; this is the form that its references use. It is logistic over the index
//! and not over time, and therefore a different curve from that of M. Sorn (2019).
//!
//! The golden numbers in `tests/golden/` fix the formulas; only their numerical form may change.

/// The curve of one ramp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Logistic {
    /// f0, the limit of the frequency for small indices, steps/s.
    pub start: f64,
    /// f1, the limit of the frequency for large indices, steps/s.
    pub top: f64,
    /// The steepness Fle, over 0.
    pub steepness: f64,
    /// The index m of the middle, over 0.
    pub centre: f64,
}

impl Logistic {
    /// The frequency f_i, steps/s. It lies strictly between f0 and f1, except for rounding. The
    /// first entry is not f0: with Fle = 6 it is higher by 0.25 % of f1 - f0.
    pub fn frequency(&self, i: f64) -> f64 {
        self.start + (self.top - self.start) * self.share(i)
    }

    /// The acceleration f df/di with one pulse per entry, steps/s^2.
    pub fn acceleration(&self, i: f64) -> f64 {
        let share = self.share(i);
        self.frequency(i) * (self.top - self.start) * self.steepness / self.centre
            * share
            * (1.0 - share)
    }

    fn share(&self, i: f64) -> f64 {
        1.0 / (1.0 + (-self.steepness * (i - self.centre) / self.centre).exp())
    }
}

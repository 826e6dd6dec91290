//! Frequency logistic in the entry index: the look-up method.
//!
//! f_i = f0 + (f1 - f0) / (1 + e^(-Fle (i - m) / m)), i from 0. The source's own formula is lost from its
//! text; this is the form of the family that it cites. It is logistic over the index, not over time: another
//! curve than that of Sorn (2019).

/// The curve of one ramp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Logistic {
    /// f0, the limit for small indices, steps/s.
    pub start: f64,
    /// f1, the limit for large indices, steps/s.
    pub top: f64,
    /// Fle, over 0.
    pub steepness: f64,
    /// m, the index of the middle, over 0.
    pub centre: f64,
}

impl Logistic {
    /// f_i, steps/s; strictly between f0 and f1, up to rounding. The first entry is not f0: at Fle = 6 it is
    /// 0.25 % of the rise above.
    pub fn frequency(&self, i: f64) -> f64 {
        self.start + (self.top - self.start) * self.share(i)
    }

    /// f df/di, the acceleration where each entry lasts one pulse, steps/s^2.
    pub fn acceleration(&self, i: f64) -> f64 {
        let share = self.share(i);
        self.frequency(i) * (self.top - self.start) * self.steepness / self.centre * share * (1.0 - share)
    }

    fn share(&self, i: f64) -> f64 {
        1.0 / (1.0 + (-self.steepness * (i - self.centre) / self.centre).exp())
    }
}

//! Constant acceleration with one division per step: D. Austin (2005), "Generate stepper-motor
//! speed profiles in real time", and Atmel's application note AVR446.
//!
//! The recurrence is c_n = c_(n-1) - 2 c_(n-1) / (4 n + 1), in timer counts. Started from the true
//! first delay it ends 48 % too slow; the first delay that fits it is 0.676 of the true one,
//! exactly 2 Gamma(3/4) / Gamma(1/4). Its solution c_n = F / sqrt(2 a) Gamma(n + 3/4) / Gamma(n +
//! 5/4) holds for any n, so that a ramp may also begin at a speed. A deceleration uses the same
//! values in reverse: c_(m-1) = c_m (4 m + 1) / (4 m - 1).
//!
//! The golden numbers in `tests/golden/` fix the formulas; only their numerical form may change.

/// The factor 2 Gamma(3/4) / Gamma(1/4), which AVR446 prints as 0.676.
pub const FIRST_DELAY: f64 = 0.675_978_240_067_284_7;

/// A ramp of constant acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstantAcceleration {
    /// Timer counts per second, F.
    pub timer: f64,
    /// The acceleration a, steps/s^2, over 0.
    pub acceleration: f64,
}

impl ConstantAcceleration {
    /// The ramp from `start` to `top` steps/s in `steps` steps: a = (v1^2 - v0^2) / 2 N.
    pub fn between(timer: f64, start: f64, top: f64, steps: f64) -> Self {
        Self { timer, acceleration: (top - start) * (top + start) / (2.0 * steps) }
    }

    /// The number of steps in which a ramp from rest reaches `speed` steps/s: v^2 / 2a.
    pub fn steps_at(&self, speed: f64) -> f64 {
        speed * speed / (2.0 * self.acceleration)
    }

    /// The true delay between steps n and n + 1, counts: F sqrt(2/a) (sqrt(n + 1) - sqrt(n)),
    /// computed without cancellation.
    pub fn exact_delay(&self, n: f64) -> f64 {
        self.timer * (2.0 / self.acceleration).sqrt() / ((n + 1.0).sqrt() + n.sqrt())
    }

    /// The delay c_n of the recurrence, counts, for any n from 0. It is shorter than the true delay
    /// by less than 3 / 64 n^2 of it.
    pub fn delay(&self, n: f64) -> f64 {
        self.timer / (2.0 * self.acceleration).sqrt() * gamma_quotient(n)
    }
}

/// Gamma(n + 3/4) / Gamma(n + 5/4), for n from 0.
///
/// From n = 32 on, the asymptotic series is used, whose next term is below 10^-17. Below that,
/// Gamma(x + 1) = x Gamma(x) is used, which is the recurrence itself.
fn gamma_quotient(n: f64) -> f64 {
    let mut n = n;
    let mut product = 1.0;
    while n < 32.0 {
        n += 1.0;
        product *= (4.0 * n + 1.0) / (4.0 * n - 1.0);
    }
    let z = n + 0.5;
    let w = 1.0 / (z * z);
    product * (1.0 - w * (1.0 / 64.0 - w * (21.0 / 8192.0 - w * (671.0 / 524_288.0)))) / z.sqrt()
}

/// The delays c_n in floats: an endless iterator that yields `first` and then the recurrence.
#[derive(Debug, Clone)]
pub struct FloatRecurrence {
    delay: f64,
    index: f64,
}

impl FloatRecurrence {
    /// Starts the recurrence. `first` is the delay between steps n and n + 1, counts.
    pub fn new(first: f64, n: f64) -> Self {
        Self { delay: first, index: n }
    }
}

impl Iterator for FloatRecurrence {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        let delay = self.delay;
        self.index += 1.0;
        self.delay -= 2.0 * delay / (4.0 * self.index + 1.0);
        Some(delay)
    }
}

/// The delays c_n in integers: an endless iterator that carries the remainder of each division into
/// the next one. Without the remainder, c_1000 of the golden ramp is 57 % too long.
///
/// The values stay within -1 and +2.5 counts of the float recurrence (`tests/properties.rs`).
#[derive(Debug, Clone)]
pub struct IntegerRecurrence {
    delay: u64,
    remainder: u64,
    quarters: u64,
}

impl IntegerRecurrence {
    /// Starts the recurrence. `first` is the delay between steps n and n + 1, counts; `quarters` is
    /// 4 n.
    pub fn new(first: u32, quarters: u64) -> Self {
        // From 4 n = 2^60 on every quotient is 0, so that a greater value changes nothing.
        Self { delay: u64::from(first), remainder: 0, quarters: quarters.min(1 << 60) }
    }
}

impl Iterator for IntegerRecurrence {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        let delay = u32::try_from(self.delay).ok()?;
        self.quarters += 4;
        let divisor = self.quarters + 1;
        let dividend = 2 * self.delay + self.remainder;
        self.delay -= dividend / divisor;
        self.remainder = dividend % divisor;
        Some(delay)
    }
}

//! The S-curve whose acceleration is 1 - cos: the speed is v0 + (v1 - v0) (u - sin(2 pi u) / 2 pi),
//! with u = t / T.
//!
//! The distance is T (v0 u + (v1 - v0) S(u)), with S(u) = u^2/2 + (cos(2 pi u) - 1) / 4 pi^2 and
//! S(1) = 1/2. Near rest S grows with u^4: the first step takes as long as the next dozen steps,
//! and the printed form of S loses all digits to cancellation. A series is used there.
//!
//! The golden numbers in `tests/golden/` fix the formulas; only their numerical form may change.

use std::f64::consts::PI;

/// A ramp of `steps` steps from `start` to `top` steps/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sine {
    /// v0, steps/s, 0 or more.
    pub start: f64,
    /// v1, steps/s, above v0.
    pub top: f64,
    /// N, the number of steps, over 0.
    pub steps: f64,
}

impl Sine {
    /// Duration T = 2 N / (v0 + v1), seconds.
    pub fn time(&self) -> f64 {
        2.0 * self.steps / (self.start + self.top)
    }

    /// Time at which step `n` (0 to N) is reached, seconds.
    pub fn crossing(&self, n: f64) -> f64 {
        self.time() * self.inverse(n)
    }

    /// Greatest acceleration, at half time: 2 (v1 - v0) / T, steps/s^2.
    pub fn peak_acceleration(&self) -> f64 {
        2.0 * (self.top - self.start) / self.time()
    }

    /// The value of u at step n, by Newton's method inside a bracket. The start value assumes that
    /// the distance grows with u^4 alone.
    fn inverse(&self, n: f64) -> f64 {
        if n <= 0.0 {
            return 0.0;
        }
        if n >= self.steps {
            return 1.0;
        }
        let (t, rise) = (self.time(), self.top - self.start);
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        let mut u = (6.0 * n / (PI * PI * rise * t)).powf(0.25).min(1.0);
        for _ in 0..100 {
            let excess = t * (self.start * u + rise * distance(u)) - n;
            if excess > 0.0 {
                high = u;
            } else {
                low = u;
            }
            let newton = u - excess / (t * (self.start + rise * speed(u)));
            let next =
                if newton > low && newton < high { newton } else { f64::midpoint(low, high) };
            let moved = (next - u).abs();
            u = next;
            if moved <= f64::EPSILON * u {
                break;
            }
        }
        u
    }
}

/// S(u), 0 to 1/2 for u from 0 to 1. With x = pi u it is (x^2 - sin^2 x) / 2 pi^2.
pub fn distance(u: f64) -> f64 {
    let x = PI * u;
    let difference = if x < 1.0 {
        alternating(x.powi(4) / 3.0, 4, 4.0 * x * x)
    } else {
        (x - x.sin()) * (x + x.sin())
    };
    difference / (2.0 * PI * PI)
}

/// dS/du = u - sin(2 pi u) / 2 pi, 0 to 1 for u from 0 to 1.
pub fn speed(u: f64) -> f64 {
    let x = 2.0 * PI * u;
    let difference = if x < 1.0 { alternating(x.powi(3) / 6.0, 3, x * x) } else { x - x.sin() };
    difference / (2.0 * PI)
}

/// The series of a sine or cosine from the term of `degree` on, where the closed form would cancel.
/// Each term is the previous one times -y / ((degree + 1) (degree + 2)).
fn alternating(first: f64, degree: u32, y: f64) -> f64 {
    let (mut sum, mut term, mut degree) = (first, first, f64::from(degree));
    while term.abs() > sum.abs() * f64::EPSILON / 4.0 {
        term *= -y / ((degree + 1.0) * (degree + 2.0));
        degree += 2.0;
        sum += term;
    }
    sum
}

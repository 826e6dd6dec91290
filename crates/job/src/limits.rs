//! The limits of the motors as floats, for the stages that plan. The exact check has its own.

use crate::vector::Point;

/// What one motor may do, in its unit and seconds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limit {
    pub speed: f64,
    pub acceleration: f64,
    pub jerk: f64,
}

/// The motors of a machine: their limits, and how they follow from the letters.
#[derive(Debug, Clone)]
pub(crate) struct Motors<const N: usize> {
    pub limits: [Limit; N],
    /// Motor i is at the sum over letters k of `matrix[i][k]` times the letter.
    pub matrix: [[f64; N]; N],
}

impl<const N: usize> Motors<N> {
    /// Places, speeds or accelerations of the motors for those of the letters.
    #[inline]
    pub fn of(&self, letters: &Point<N>) -> Point<N> {
        std::array::from_fn(|i| (0..N).map(|k| self.matrix[i][k] * letters[k]).sum())
    }

    /// The greatest factor by which a direction of letters can be multiplied within limits of the
    /// motors, for example their accelerations.
    pub fn greatest(&self, direction: &Point<N>, limit: impl Fn(&Limit) -> f64) -> f64 {
        let motors = self.of(direction);
        (0..N)
            .filter(|&i| motors[i] != 0.0)
            .map(|i| limit(&self.limits[i]) / motors[i].abs())
            .fold(f64::INFINITY, f64::min)
    }

    /// The greatest acceleration of one letter alone.
    pub fn letter_acceleration(&self, letter: usize) -> f64 {
        let direction = std::array::from_fn(|i| f64::from(u8::from(i == letter)));
        self.greatest(&direction, |limit| limit.acceleration)
    }
}

//! Exact targets: letters to whole steps of the motors, and back. A job has room for N letters; those
//! that its machine does not have stand still.

use crate::error::JobError;
use crate::vector::Point;
use bigdecimal::{BigDecimal, RoundingMode, ToPrimitive};
use carrystep_files::{Axis, Machine};

/// Most steps from machine zero: the position register has 32 bits.
const MOST_STEPS: i64 = (1 << 31) - 1;

/// How letters become steps.
#[derive(Debug)]
pub(crate) struct Targets<const N: usize> {
    /// Letters of the machine, at most N; the further ones stand still at 0.
    letters: usize,
    /// Steps per unit of each motor.
    pub steps_per_unit: [f64; N],
    coefficients: [[i32; N]; N],
    /// Letters for motors, in units.
    inverse: [[f64; N]; N],
    exact: Vec<BigDecimal>,
    /// The letter of each motor, and the travel of that letter in steps of the motor.
    names: Vec<String>,
    travel: Vec<Option<[i64; 2]>>,
}

impl<const N: usize> Targets<N> {
    /// The targets of a machine with N axes, of which the first ones are those of its letters.
    pub fn new(machine: &Machine, letters: usize) -> Result<Self, JobError> {
        let coefficients: [[i32; N]; N] =
            std::array::from_fn(|i| std::array::from_fn(|k| machine.coefficient(i, k).into()));
        let inverse = inverse(&coefficients.map(|row| row.map(f64::from)))
            .ok_or(JobError::Axes(machine.axes.len()))?;
        let mut steps_per_unit = [1.0; N];
        for (steps, axis) in steps_per_unit.iter_mut().zip(&machine.axes) {
            *steps = axis
                .steps_per_unit
                .to_f64()
                .filter(|x| x.is_finite() && *x > 0.0)
                .ok_or(JobError::Axes(machine.axes.len()))?;
        }
        Ok(Self {
            letters,
            steps_per_unit,
            coefficients,
            inverse,
            exact: machine.axes.iter().map(|axis| axis.steps_per_unit.clone()).collect(),
            names: machine.axes.iter().map(|axis| axis.letter.clone()).collect(),
            travel: machine.axes.iter().map(|axis| axis.travel).collect(),
        })
    }

    /// Coefficients of the motors, as floats.
    pub fn matrix(&self) -> [[f64; N]; N] {
        self.coefficients.map(|row| row.map(f64::from))
    }

    /// The point at these coordinates, one for each letter of the machine.
    ///
    /// # Errors
    /// [`JobError::Coordinates`] and [`JobError::Number`].
    pub fn coordinates(&self, values: &[f64], line: u64) -> Result<Point<N>, JobError> {
        if values.len() != self.letters {
            return Err(JobError::Coordinates { line, found: values.len(), axes: self.letters });
        }
        if let Some(&value) = values.iter().find(|x| !x.is_finite()) {
            return Err(not_finite(value, line));
        }
        let mut point = [0.0; N];
        point[..values.len()].copy_from_slice(values);
        Ok(point)
    }

    /// The steps of each motor at these letters, rounded half away from zero.
    pub fn steps(&self, letters: &Point<N>, line: u64) -> Result<[i64; N], JobError> {
        let mut steps = [0; N];
        for (motor, steps) in steps.iter_mut().enumerate() {
            let mut sum = BigDecimal::from(0);
            for (&coefficient, &letter) in self.coefficients[motor].iter().zip(letters) {
                if coefficient != 0 {
                    let value =
                        BigDecimal::try_from(letter).map_err(|_| not_finite(letter, line))?;
                    sum += value * BigDecimal::from(coefficient);
                }
            }
            let rounded = (sum * &self.exact[motor]).with_scale_round(0, RoundingMode::HalfUp);
            *steps = rounded
                .to_i64()
                .filter(|steps| steps.abs() <= MOST_STEPS)
                .ok_or_else(|| JobError::Far { line, axis: self.names[motor].clone() })?;
        }
        Ok(steps)
    }

    /// The letters at whole steps.
    pub fn letters(&self, steps: &[i64; N]) -> Point<N> {
        let motors: Point<N> = std::array::from_fn(|i| steps[i] as f64 / self.steps_per_unit[i]);
        std::array::from_fn(|k| (0..N).map(|i| self.inverse[k][i] * motors[i]).sum())
    }

    /// Refuses a place beyond the register of a motor or beyond the travel of a letter.
    pub fn check(&self, letters: &Point<N>, line: u64) -> Result<(), JobError> {
        for (motor, coefficients) in self.coefficients.iter().enumerate() {
            let units: f64 = coefficients.iter().zip(letters).map(|(&c, x)| f64::from(c) * x).sum();
            let steps = units * self.steps_per_unit[motor];
            let axis = || self.names[motor].clone();
            if steps.is_nan() || steps.abs() > MOST_STEPS as f64 {
                return Err(JobError::Far { line, axis: axis() });
            }
            // Half a step is rounding.
            let steps = (letters[motor] * self.steps_per_unit[motor]).round() as i64;
            if let Some([low, high]) = self.travel[motor]
                && !(low..=high).contains(&steps)
            {
                return Err(JobError::Travel { line, axis: axis(), steps, low, high });
            }
        }
        Ok(())
    }
}

/// The machine with letters added that nothing names and nothing moves, up to so many.
pub(crate) fn with_still_letters(machine: &Machine, count: usize) -> Machine {
    let mut machine = machine.clone();
    for number in machine.axes.len()..count {
        let Some(first) = machine.axes.first().cloned() else { break };
        machine.axes.push(Axis { letter: number.to_string(), travel: None, ..first });
    }
    machine
}

fn not_finite(value: f64, line: u64) -> JobError {
    JobError::Number { line, what: "a coordinate", value, help: "it must be finite" }
}

/// The inverse of a matrix by elimination with pivots; `None` if it is singular.
fn inverse<const N: usize>(matrix: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let mut left = *matrix;
    let mut right: [[f64; N]; N] =
        std::array::from_fn(|i| std::array::from_fn(|k| f64::from(u8::from(i == k))));
    for column in 0..N {
        let pivot =
            (column..N).max_by(|&a, &b| left[a][column].abs().total_cmp(&left[b][column].abs()))?;
        if left[pivot][column] == 0.0 {
            return None;
        }
        left.swap(column, pivot);
        right.swap(column, pivot);
        let scale = left[column][column];
        for k in 0..N {
            left[column][k] /= scale;
            right[column][k] /= scale;
        }
        for row in (0..N).filter(|&row| row != column) {
            let factor = left[row][column];
            for k in 0..N {
                left[row][k] -= factor * left[column][k];
                right[row][k] -= factor * right[column][k];
            }
        }
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_of_crossed_belts_gives_the_letters_back() {
        let found = inverse(&[[1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 0.0, 1.0]]).unwrap();
        assert_eq!(found, [[0.5, 0.5, 0.0], [0.5, -0.5, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!(inverse(&[[1.0, 2.0], [2.0, 4.0]]), None);
    }
}

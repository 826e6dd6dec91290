//! The limits of the motors: as floats for the stages that plan, and exact for the check.

use crate::error::JobError;
use crate::vector::Point;
use carrystep_files::Machine;
use carrystep_plan::exact::ExactLimits;

/// Shortest time between knots, seconds.
pub(crate) const SHORTEST: f64 = 0.004;

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

/// The limits of a machine's motors in steps and seconds, and in exact integers. Without
/// `jerk_limit`, J is A / 4 ms.
///
/// # Errors
/// [`JobError::Axes`].
pub(crate) fn of_machine<const N: usize>(
    machine: &Machine,
) -> Result<([Limit; N], [ExactLimits; N]), JobError> {
    let mut limits = [Limit { speed: 0.0, acceleration: 0.0, jerk: 0.0 }; N];
    for (limit, axis) in limits.iter_mut().zip(&machine.axes) {
        let [speed, acceleration] = [&axis.speed_limit, &axis.accel_limit].map(|limit| limit.float);
        let jerk = axis.jerk_limit.as_ref().map_or(acceleration / SHORTEST, |limit| limit.float);
        *limit = Limit { speed, acceleration, jerk };
    }
    let exact = exact(machine).try_into().map_err(|_| JobError::Axes(machine.axes.len()))?;
    Ok((limits, exact))
}

/// The limits of a machine's motors in exact integers. Without `jerk_limit`, J is A / 4 ms.
pub(crate) fn exact(machine: &Machine) -> Vec<ExactLimits> {
    let tick_seconds = machine.timebase.tick_seconds();
    let of = |axis| {
        let limits = ExactLimits::new::<f64>(axis);
        let jerk = limits.jerk.unwrap_or_else(|| default_jerk(&limits, tick_seconds));
        ExactLimits { jerk: Some(jerk), ..limits }
    };
    machine.axes.iter().map(of).collect()
}

/// J = A / 4 ms in 2^-64 step per tick^3, rounded down; the ticks of 4 ms are rounded up.
fn default_jerk(limits: &ExactLimits, tick_seconds: f64) -> i128 {
    let ticks = (SHORTEST / tick_seconds * (1.0 - 1e-12)).ceil();
    limits.acceleration / i128::from(ticks as u64).max(1)
}

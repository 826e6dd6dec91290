//! Distances, speeds, accelerations and jerks in the unit in which the user gave them.
//!
//! Everything that the profiles compute is in steps and seconds; this file holds the conversions.

use crate::reference::drive::Drive;
use crate::reference::error::ReferenceError;
use crate::reference::length::Length;

/// A value in its own unit: a length over a power of seconds, or over one minute. The power
/// depends on the use and is 0 to 3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    value: f64,
    length: Length,
    per_minute: bool,
}

impl Quantity {
    /// A distance, or a speed, acceleration or jerk over seconds.
    pub const fn new(value: f64, length: Length) -> Self {
        Self { value, length, per_minute: false }
    }

    /// The same number as a speed per minute: mm/min, or turns per minute (rpm).
    #[must_use]
    pub const fn per_minute(self) -> Self {
        Self { per_minute: true, ..self }
    }

    /// The number in its own unit.
    pub const fn value(&self) -> f64 {
        self.value
    }

    /// The unit of length.
    pub const fn length(&self) -> Length {
        self.length
    }

    /// The name of the unit for a distance (`power` 0), a speed (1), an acceleration (2) or a jerk
    /// (3).
    pub fn unit(&self, power: u32) -> String {
        match (power, self.per_minute, self.length) {
            (_, true, Length::Turn) => "rpm".to_owned(),
            (_, true, length) => format!("{length}/min"),
            (0, false, length) => length.to_string(),
            (1, false, length) => format!("{length}/s"),
            (power, false, length) => format!("{length}/s^{power}"),
        }
    }

    /// Converts a number of steps (per power of seconds) to this unit.
    ///
    /// # Errors
    /// [`ReferenceError::NoTravel`] if the unit is in millimetres and the drive has no travel per
    /// turn.
    pub fn back(&self, steps: f64, drive: &Drive) -> Result<f64, ReferenceError> {
        Ok(steps / Self { value: 1.0, ..*self }.in_steps(drive)?)
    }

    /// The value in steps and seconds.
    ///
    /// # Errors
    /// [`ReferenceError::NoTravel`] if the unit is in millimetres and the drive has no travel per
    /// turn.
    pub fn in_steps(&self, drive: &Drive) -> Result<f64, ReferenceError> {
        let steps = self.value * drive.steps_in(self.length)?;
        Ok(if self.per_minute { steps / 60.0 } else { steps })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SORN: Drive = Drive { step_angle_deg: 1.8, microsteps: 2, travel_per_rev_mm: Some(5.0) };

    /// 1000 mm/min is 16.7 mm/s, 200 rpm or 1200 degrees/s; each is 1333.3 steps/s.
    #[test]
    fn one_speed_in_five_units_has_one_value_in_steps() {
        let speeds = [
            Quantity::new(1000.0, Length::Millimetre).per_minute(),
            Quantity::new(1000.0 / 60.0, Length::Millimetre),
            Quantity::new(200.0, Length::Turn).per_minute(),
            Quantity::new(1200.0, Length::Degree),
            Quantity::new(4000.0 / 3.0, Length::Step),
        ];
        for speed in speeds {
            let steps = speed.in_steps(&SORN).expect("a speed");
            let back = speed.back(steps, &SORN).expect("the same speed");
            assert!((back / speed.value() - 1.0).abs() < 1e-15, "{speed:?}: {back}");
            assert!((steps / (4000.0 / 3.0) - 1.0).abs() < 1e-15, "{speed:?}: {steps}");
        }
        let units = speeds.map(|speed| speed.unit(1));
        assert_eq!(units, ["mm/min", "mm/s", "rpm", "degrees/s", "steps/s"]);
        assert_eq!(Quantity::new(80.0, Length::Millimetre).unit(2), "mm/s^2");
        assert_eq!(Quantity::new(80.0, Length::Millimetre).in_steps(&SORN), Ok(6400.0));
    }

    #[test]
    fn millimetres_without_a_travel_are_refused() {
        let motor = Drive { travel_per_rev_mm: None, ..SORN };
        assert_eq!(
            Quantity::new(1.0, Length::Millimetre).in_steps(&motor),
            Err(ReferenceError::NoTravel)
        );
        assert_eq!(Quantity::new(1.0, Length::Turn).in_steps(&motor), Ok(400.0));
    }
}

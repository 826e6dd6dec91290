//! Converts steps of a motor to degrees, turns and millimetres.
//!
//! The names of the fields are part of `--json` and may not change.

use crate::reference::error::ReferenceError;
use crate::reference::length::Length;
use schemars::JsonSchema;
use serde::Serialize;

/// A motor with its driver and the part that it moves. A step is always one microstep.
#[derive(Debug, Clone, Copy, PartialEq, JsonSchema, Serialize)]
pub struct Drive {
    /// Angle of a full step, degrees; over 0, at most 180.
    pub step_angle_deg: f64,
    /// Microsteps in a full step; 1 to 65 536.
    pub microsteps: u32,
    /// Travel in one turn of the motor with all gears, millimetres; over 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub travel_per_rev_mm: Option<f64>,
}

impl Drive {
    /// Steps in one degree: microsteps / step angle.
    pub fn steps_per_degree(&self) -> f64 {
        f64::from(self.microsteps) / self.step_angle_deg
    }

    /// Steps in one turn.
    pub fn steps_per_rev(&self) -> f64 {
        360.0 * f64::from(self.microsteps) / self.step_angle_deg
    }

    /// Steps in one unit of length.
    ///
    /// # Errors
    /// [`ReferenceError::NoTravel`] for millimetres if the drive has no travel per turn.
    pub fn steps_in(&self, length: Length) -> Result<f64, ReferenceError> {
        Ok(match length {
            Length::Step => 1.0,
            Length::Degree => self.steps_per_degree(),
            Length::Turn => self.steps_per_rev(),
            Length::Millimetre => {
                self.steps_per_rev() / self.travel_per_rev_mm.ok_or(ReferenceError::NoTravel)?
            }
        })
    }

    pub(crate) fn check(&self) -> Result<(), ReferenceError> {
        let range = |what, value, must, holds: bool| {
            if holds { Ok(()) } else { Err(ReferenceError::OutOfRange { what, value, must }) }
        };
        let (angle, travel) = (self.step_angle_deg, self.travel_per_rev_mm.unwrap_or(1.0));
        let microsteps = self.microsteps;
        range(
            "the step angle",
            angle,
            "over 0 and at most 180 degrees",
            angle > 0.0 && angle <= 180.0,
        )?;
        range(
            "the microsteps",
            f64::from(microsteps),
            "1 to 65536",
            (1..=65_536).contains(&microsteps),
        )?;
        range(
            "the travel per turn",
            travel,
            "finite and over 0 mm",
            travel > 0.0 && travel.is_finite(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples of three sources: 400 steps for a turn of 5 mm, 5/9 of a step for a degree, and
    /// 1600 steps for a turn.
    #[test]
    fn drives_of_the_sources_have_their_steps_per_unit() {
        let sorn = Drive { step_angle_deg: 1.8, microsteps: 2, travel_per_rev_mm: Some(5.0) };
        let steps = [Length::Step, Length::Degree, Length::Turn, Length::Millimetre]
            .map(|unit| sorn.steps_in(unit));
        assert_eq!(steps, [Ok(1.0), Ok(2.0 / 1.8), Ok(400.0), Ok(80.0)]);
        let trapezoid = Drive { microsteps: 1, travel_per_rev_mm: None, ..sorn };
        assert_eq!(trapezoid.steps_per_degree(), 5.0 / 9.0);
        assert_eq!(trapezoid.steps_in(Length::Millimetre), Err(ReferenceError::NoTravel));
        assert_eq!(Drive { microsteps: 8, ..sorn }.steps_per_rev(), 1600.0);
    }

    #[test]
    fn drive_out_of_range_is_refused() {
        let good = Drive { step_angle_deg: 1.8, microsteps: 1, travel_per_rev_mm: None };
        assert_eq!(good.check(), Ok(()));
        for step_angle_deg in [0.0, -1.8, 180.1, f64::NAN, f64::INFINITY] {
            assert!(Drive { step_angle_deg, ..good }.check().is_err(), "{step_angle_deg}");
        }
        for travel in [0.0, -5.0, f64::NAN, f64::INFINITY] {
            assert!(Drive { travel_per_rev_mm: Some(travel), ..good }.check().is_err(), "{travel}");
        }
        for microsteps in [0, 65_537] {
            assert!(Drive { microsteps, ..good }.check().is_err(), "{microsteps}");
        }
    }
}

//! The request for a table, and the check of its values.
//!
//! The structs here are part of `--json`; their names may not change.

use crate::error::{TableError, positive};
use crate::timer::Timer;
use schemars::JsonSchema;
use serde::Serialize;
use strum::IntoStaticStr;

/// The greatest number of steps in a ramp. A table with one pulse per entry is also limited to 65
/// 535 entries.
pub(crate) const MAX_RAMP: u32 = 1_000_000;

/// The greatest number of entries in a table: the player counts them in 16 bits.
pub(crate) const MAX_ENTRIES: u32 = u16::MAX as u32;

/// The permitted range of speeds, steps/s.
const SPEEDS: std::ops::RangeInclusive<f64> = 1e-3..=1e9;

/// Everything that determines a table.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct TableRequest {
    /// The timer that plays the table.
    pub timer: Timer,
    /// The motor, for speeds in rpm.
    pub motor: Motor,
    /// Speed at the start of the ramp, steps/s; 0 or more.
    pub start_frequency: f64,
    /// Speed of the cruise; above the start frequency.
    pub top_speed: Speed,
    /// The curve between the two speeds.
    #[serde(flatten)]
    pub kind: Kind,
    /// The number of pulses that each entry lasts.
    pub pulses: Pulses,
}

/// Step angle and microsteps of a motor.
#[derive(Debug, Clone, Copy, PartialEq, JsonSchema, Serialize)]
pub struct Motor {
    /// Angle of a full step, degrees; over 0, at most 180.
    pub step_angle_deg: f64,
    /// Microsteps in a full step; 1 to 65 536. A step of the table is one microstep.
    pub microsteps: u32,
}

/// A speed, in the unit in which the user gives it.
#[derive(Debug, Clone, Copy, PartialEq, JsonSchema, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Speed {
    /// Revolutions of the motor shaft per minute.
    Rpm(f64),
    /// Steps (microsteps) per second.
    StepsPerSecond(f64),
}

/// The curve of a ramp, over the index of its entries or steps.
#[derive(Debug, Clone, PartialEq, IntoStaticStr, JsonSchema, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Kind {
    /// [`crate::logistic`]: the frequency is a logistic function of the entry index.
    Logistic {
        /// Number of entries, 1 to 65 535; with one pulse per entry also the steps of the ramp.
        entries: u32,
        /// The steepness Fle, which the source calls "curve"; over 0, at most 1000. With 6, the
        /// ends are 0.25 % of the speed change away from the limits.
        steepness: f64,
        /// The entry at which half the speed change is reached, over 0 and at most `entries`;
        /// absent: `entries / 2`.
        centre: Option<f64>,
    },
    /// [`crate::austin`]: constant acceleration by the recurrence of Austin and AVR446.
    Avr446 {
        /// Steps of the ramp, 1 to 1 000 000; together with the speeds they determine the
        /// acceleration.
        ramp_steps: u32,
        /// Float, or integer with the remainder carried over.
        arithmetic: Arithmetic,
    },
    /// [`crate::sine`]: the S-curve whose acceleration is 1 - cos.
    Sine {
        /// Steps of the ramp, 1 to 1 000 000; together with the speeds they determine its duration.
        ramp_steps: u32,
        /// Number of intervals of an inverse table in the header, 2 to 4096; only for ramps from
        /// rest.
        inverse: Option<u32>,
    },
}

/// How the recurrence is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Arithmetic {
    /// In f64, rounded to counts at the end.
    Float,
    /// In integers, as AVR446 does on the controller, with the remainder of each division carried
    /// over.
    Integer,
}

/// The number of pulses that an entry lasts.
///
/// Logistic entries are stretched: their number stays, and the ramp gets more pulses. For the other
/// kinds the number of steps of the ramp stays, and an entry has the mean delay of its steps.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Pulses {
    /// One pulse per entry.
    One,
    /// One group for each number, all with the same count of entries. The number is that of the
    /// pulses of each entry in the group, 1 to 65 535.
    ByGroup(Vec<u32>),
    /// As many pulses as an entry needs to last at least this time, seconds; over 0, at most 1000.
    ByTime(f64),
}

impl Motor {
    /// Steps/s at `rpm`: 6 rpm microsteps / angle, with the angle in degrees.
    pub fn steps_per_second(&self, rpm: f64) -> f64 {
        6.0 * rpm * f64::from(self.microsteps) / self.step_angle_deg
    }

    /// The speed in rpm, the inverse of [`Self::steps_per_second`].
    pub fn rpm(&self, steps_per_second: f64) -> f64 {
        steps_per_second * self.step_angle_deg / (6.0 * f64::from(self.microsteps))
    }
}

impl Kind {
    /// The name of the kind on the command line.
    pub fn name(&self) -> &'static str {
        self.into()
    }
}

impl TableRequest {
    /// The top speed, steps/s.
    pub fn top_frequency(&self) -> f64 {
        match self.top_speed {
            Speed::Rpm(rpm) => self.motor.steps_per_second(rpm),
            Speed::StepsPerSecond(steps) => steps,
        }
    }

    pub(crate) fn check(&self) -> Result<(), TableError> {
        self.timer.check()?;
        let Motor { step_angle_deg, microsteps } = self.motor;
        positive("step_angle_deg", step_angle_deg, 180.0)?;
        count("microsteps", microsteps, 1, 1 << 16)?;
        self.check_speeds()?;
        self.check_kind()?;
        match &self.pulses {
            Pulses::One => Ok(()),
            Pulses::ByTime(seconds) => positive("pulses by time", *seconds, 1e3),
            Pulses::ByGroup(pulses) => {
                count("groups", u32::try_from(pulses.len()).unwrap_or(u32::MAX), 1, MAX_ENTRIES)?;
                pulses
                    .iter()
                    .try_for_each(|&p| count("pulses per entry", p, 1, u32::from(u16::MAX)))
            }
        }
    }

    fn check_speeds(&self) -> Result<(), TableError> {
        let (start, top) = (self.start_frequency, self.top_frequency());
        if !SPEEDS.contains(&top) {
            return Err(TableError::Unusable {
                parameter: "top speed, steps/s,",
                value: top,
                needed: "0.001 to 1e9",
            });
        }
        if !(start >= 0.0 && start.is_finite()) {
            return Err(TableError::Unusable {
                parameter: "start_frequency",
                value: start,
                needed: "0 or more",
            });
        }
        if start >= top {
            return Err(TableError::TopUnderStart { start, top, start_rpm: self.motor.rpm(start) });
        }
        Ok(())
    }

    fn check_kind(&self) -> Result<(), TableError> {
        match self.kind {
            Kind::Logistic { entries, steepness, centre } => {
                count("entries", entries, 1, MAX_ENTRIES)?;
                positive("steepness", steepness, 1e3)?;
                centre.map_or(Ok(()), |m| positive("centre", m, f64::from(entries)))
            }
            Kind::Avr446 { ramp_steps, .. } => count("ramp_steps", ramp_steps, 1, MAX_RAMP),
            Kind::Sine { ramp_steps, inverse } => {
                count("ramp_steps", ramp_steps, 1, MAX_RAMP)?;
                let Some(intervals) = inverse else { return Ok(()) };
                count("intervals of the inverse table", intervals, 2, 4096)?;
                if self.start_frequency > 0.0 {
                    return Err(TableError::InverseFromRest { start: self.start_frequency });
                }
                Ok(())
            }
        }
    }
}

fn count(parameter: &'static str, value: u32, least: u32, most: u32) -> Result<(), TableError> {
    if (least..=most).contains(&value) {
        Ok(())
    } else {
        Err(TableError::Count { parameter, value, least, most })
    }
}

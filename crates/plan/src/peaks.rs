//! The greatest values that a plan reaches, exactly, in the gateware's units.
//!
//! `check.rs` computes the values; this file only converts their units.

use carrystep_core::Timebase;

/// The greatest magnitudes over a move, computed from the integers of its segments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Peaks {
    /// Speed V, 2^-64 step per tick.
    pub speed: u64,
    /// Acceleration A, 2^-64 step per tick^2.
    pub acceleration: u64,
    /// Jerk J, 2^-64 step per tick^3.
    pub jerk: u64,
    /// Speed at the start of the first tick, V - A/2 + J/3 rounded up, 2^-64 step per tick. If the
    /// first segment is one tick long: the least start speed from which the acceleration limit
    /// reaches its V.
    pub start_speed: u64,
}

impl Peaks {
    /// The greater value of each pair.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            speed: self.speed.max(other.speed),
            acceleration: self.acceleration.max(other.acceleration),
            jerk: self.jerk.max(other.jerk),
            start_speed: self.start_speed.max(other.start_speed),
        }
    }

    /// Greatest speed, steps/s.
    pub fn steps_per_s(&self, timebase: &Timebase) -> f64 {
        per_tick(self.speed, timebase, 1)
    }

    /// Greatest acceleration, steps/s^2.
    pub fn steps_per_s2(&self, timebase: &Timebase) -> f64 {
        per_tick(self.acceleration, timebase, 2)
    }

    /// Greatest jerk, steps/s^3.
    pub fn steps_per_s3(&self, timebase: &Timebase) -> f64 {
        per_tick(self.jerk, timebase, 3)
    }

    /// Start speed, steps/s.
    pub fn start_steps_per_s(&self, timebase: &Timebase) -> f64 {
        per_tick(self.start_speed, timebase, 1)
    }
}

fn per_tick(units: u64, timebase: &Timebase, power: i32) -> f64 {
    units as f64 * 2_f64.powi(-64) / timebase.tick_seconds().powi(power)
}

//! The exact check of a plan. Every plan has to pass it before the planner returns it.
//!
//! All computations here are in integers and independent of how the segments were found. The rules
//! may change only together with [`Broken`].

use crate::edges::{product, speed, travel};
use crate::error::Broken;
use crate::limits::ExactLimits;
use crate::peaks::Peaks;
use carrystep_core::Segment;

/// What the segments of one axis have to do in one move, without the rest before it.
pub(crate) struct Duty {
    pub backward: bool,
    /// Signed distance, 2^-64 step.
    pub distance: i128,
    pub ticks: u64,
}

/// Checks every segment at its ends and extrema, in integers, and returns the greatest values.
///
/// # Errors
/// The first rule that is broken.
pub(crate) fn check(
    segments: &[Segment],
    duty: &Duty,
    limits: &ExactLimits,
) -> Result<Peaks, Broken> {
    let mut found = Found { backward: duty.backward, ..Found::default() };
    let (mut ticks, mut distance) = (0_u64, 0_i128);
    for segment in segments {
        ticks += u64::from(segment.ticks);
        distance += found.add(segment)?;
    }
    let Found { speed: fastest, jerk, .. } = found;
    let acceleration = found.end_acceleration.max(found.acceleration.into());
    if ticks != duty.ticks || distance != duty.distance {
        return Err(Broken::Landing);
    }
    if i128::from(fastest) > limits.speed + limits.tolerance {
        return Err(Broken::Speed);
    }
    if acceleration > limits.acceleration + 1 {
        return Err(Broken::Acceleration);
    }
    if limits.jerk.is_some_and(|most| i128::from(jerk) > most + 1) {
        return Err(Broken::Jerk);
    }
    let start = segments.first().map_or(0, |first| start_speed(first, duty.backward, limits));
    if start > limits.start_speed + limits.tolerance {
        return Err(Broken::StartSpeed);
    }
    let register = |value: i128| u64::try_from(value).map_err(|_| Broken::Range);
    Ok(Peaks {
        speed: fastest,
        acceleration: register(acceleration)?,
        jerk,
        start_speed: register(start)?,
    })
}

/// The greatest values of the segments so far.
#[derive(Default)]
struct Found {
    backward: bool,
    speed: u64,
    /// The greatest A at the beginning of a segment.
    acceleration: u64,
    /// The greatest A at the end of a segment with J.
    end_acceleration: i128,
    jerk: u64,
}

impl Found {
    /// Takes in the values of a segment, and returns the units that it travels.
    fn add(&mut self, segment: &Segment) -> Result<i128, Broken> {
        self.pass_register(segment.v)?;
        self.acceleration = self.acceleration.max(segment.a.unsigned_abs());
        if segment.j != 0 {
            return self.add_bent(segment);
        }
        self.pass(speed(segment, u64::from(segment.ticks) - 1))?;
        Ok(travel(segment, segment.ticks.into()))
    }

    /// The rest of [`Self::add`] for a segment with J. It is apart because the values of a straight
    /// one then stay in the registers of the processor.
    #[inline(never)]
    fn add_bent(&mut self, segment: &Segment) -> Result<i128, Broken> {
        let last = u64::from(segment.ticks) - 1;
        self.pass(speed(segment, last))?;
        if let Some(inner) = turning_speeds(segment) {
            inner.into_iter().try_for_each(|v| self.pass(v))?;
        }
        let end = i128::from(segment.a) + product(last.cast_signed(), segment.j);
        self.end_acceleration = self.end_acceleration.max(end.abs());
        self.jerk = self.jerk.max(segment.j.unsigned_abs());
        Ok(travel(segment, segment.ticks.into()))
    }

    /// Takes in a V, which may not fit into its register.
    #[inline]
    fn pass(&mut self, v: i128) -> Result<(), Broken> {
        match i64::try_from(v) {
            Ok(v) => self.pass_register(v),
            Err(_) if (v < 0) != self.backward => Err(Broken::Sign),
            Err(_) => Err(Broken::Overspeed),
        }
    }

    /// Takes in a V.
    #[inline]
    fn pass_register(&mut self, v: i64) -> Result<(), Broken> {
        let onward = if self.backward { v.checked_neg().ok_or(Broken::Overspeed)? } else { v };
        let onward = u64::try_from(onward).map_err(|_| Broken::Sign)?;
        self.speed = self.speed.max(onward);
        Ok(())
    }
}

/// The speed at the start of the first tick, V - A/2 + J/3 in the direction of travel, rounded up,
/// at least 0, in 2^-64 step per tick.
pub(crate) fn start_speed(first: &Segment, backward: bool, limits: &ExactLimits) -> i128 {
    let sixfold = 6 * i128::from(first.v) - 3 * i128::from(first.a) + 2 * i128::from(first.j);
    let sixfold = if backward { -sixfold } else { sixfold };
    // A segment of one tick gives its distance but not the speed at its start. It may have
    // accelerated within the tick by as much as the acceleration limit allows.
    let explained = if first.ticks == 1 { 3 * limits.acceleration } else { 0 };
    let sixfold = (sixfold - explained).max(0);
    (sixfold + 5) / 6
}

/// V in the first and last tick, and on both sides of the zero of A if that lies between them. The
/// extremes of V are among these values.
pub fn speeds(segment: &Segment) -> impl Iterator<Item = i128> {
    end_speeds(segment).into_iter().chain(turning_speeds(segment).into_iter().flatten())
}

/// V in the first and in the last tick.
fn end_speeds(segment: &Segment) -> [i128; 2] {
    [segment.v.into(), speed(segment, u64::from(segment.ticks) - 1)]
}

/// V on both sides of the zero of A, if that lies inside the segment.
#[inline]
fn turning_speeds(segment: &Segment) -> Option<[i128; 2]> {
    if segment.j == 0 {
        return None;
    }
    let last = u64::from(segment.ticks) - 1;
    let (a, j) = (i128::from(segment.a), segment.j);
    let turns = (a < 0) != (a + product(last.cast_signed(), j) < 0);
    turns.then(|| {
        let vertex = u64::try_from((-a).div_euclid(j.into())).unwrap_or(0);
        [vertex, vertex + 1].map(|k| speed(segment, k.min(last)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: ExactLimits = ExactLimits {
        start_speed: 1000,
        speed: 1_000_000,
        acceleration: 100,
        jerk: Some(7),
        tolerance: 1,
    };

    fn segment(ticks: u32, v: i64, a: i64, j: i64) -> Segment {
        Segment { ticks, v, a, j, last: false }
    }

    fn checked(segment: Segment, backward: bool) -> Result<Peaks, Broken> {
        let distance = travel(&segment, segment.ticks.into());
        check(&[segment], &Duty { backward, distance, ticks: segment.ticks.into() }, &LIMITS)
    }

    #[test]
    fn check_finds_speed_that_changes_sign_inside_a_segment() {
        // V = 3, 1, 0, 0, 1, 3 only touches zero. With V one less, it is negative in the middle
        // only.
        assert!(checked(segment(6, 3, -2, 1), false).is_ok());
        assert_eq!(checked(segment(6, 2, -2, 1), false), Err(Broken::Sign));
        assert_eq!(checked(segment(6, -2, 2, -1), true), Err(Broken::Sign));
    }

    #[test]
    fn check_accepts_each_limit_and_refuses_the_next_value() {
        assert!(checked(segment(10, 1050, 100, 0), false).is_ok());
        assert_eq!(checked(segment(10, 1052, 100, 0), false), Err(Broken::StartSpeed));
        assert_eq!(checked(segment(10, 1050, 102, 0), false), Err(Broken::Acceleration));
        assert_eq!(checked(segment(10_001, 1001, 100, 0), false), Err(Broken::Speed));
        assert!(checked(segment(9_991, 1001, 100, 0), false).is_ok());
        assert_eq!(checked(segment(5, 1000, 10, 9), false), Err(Broken::Jerk));
        assert!(checked(segment(5, 1000, 10, 8), false).is_ok());
        assert_eq!(checked(segment(10, 1050, 100, 0), false).map(|p| p.start_speed), Ok(1000));
        // From V = 0, the direction of the move decides the sign.
        let backward = checked(segment(10, 0, -100, 0), true);
        assert_eq!(backward.map(|p| p.start_speed), Ok(0));
        assert_eq!(checked(segment(1, 1051, 0, 0), false).map(|p| p.start_speed), Ok(1001));
    }

    #[test]
    fn check_refuses_a_distance_that_is_one_unit_off() {
        let duty = Duty { backward: false, distance: 5001, ticks: 10 };
        assert_eq!(check(&[segment(10, 500, 0, 0)], &duty, &LIMITS), Err(Broken::Landing));
        let duty = Duty { distance: 5000, ..duty };
        assert!(check(&[segment(10, 500, 0, 0)], &duty, &LIMITS).is_ok());
    }
}

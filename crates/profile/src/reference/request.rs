//! The request of a user, which is checked and converted to steps here.
//!
//! The rules of each kind are in `kinds.rs`.

use crate::reference::curve::Reference;
use crate::reference::drive::Drive;
use crate::reference::error::{ReferenceError, in_words, rounded, up};
use crate::reference::length::Length;
use crate::reference::quantity::Quantity;
use crate::{Curve, Limit, LimitRefusal, Limits, kinds, rule};
use carrystep_core::ProfileKind;
use std::f64::consts::PI;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// The greatest number of steps in a move: up to 2^53 a double represents every whole number.
const MOST_STEPS: f64 = 9_007_199_254_740_992.0;

/// The permitted range of speeds, accelerations, jerks and times, in steps and seconds. Within it
/// no formula overflows a double.
const VALUES: RangeInclusive<f64> = 1e-9..=1e15;

/// The request for a profile, without its kind.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceRequest {
    /// The motor.
    pub drive: Drive,
    /// Whether a ramp or a whole move is requested.
    pub travel: ReferenceDistance,
    /// Duration of the profile, seconds; `None`: as fast as the limits allow.
    pub time: Option<f64>,
    /// For a ramp the speed that it reaches, for a move the speed limit.
    pub speed: Option<Quantity>,
    /// The greatest speed to which the motor may jump from rest; `None`: 0.
    pub start_speed: Option<Quantity>,
    /// The acceleration limit.
    pub acceleration: Option<Quantity>,
    /// The jerk limit.
    pub jerk: Option<Quantity>,
    /// The centre T_i of a logistic ramp, seconds.
    pub centre: Option<f64>,
}

/// The distance of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReferenceDistance {
    /// A ramp, which ends at its top speed.
    Ramp,
    /// A move over this distance, which ends at rest.
    Move(Quantity),
}

/// The values of a request in steps and seconds.
#[derive(Debug, Clone, Copy)]
struct Steps {
    distance: Option<f64>,
    top: Option<f64>,
    limits: Limits<f64>,
}

impl ReferenceRequest {
    /// A request without any limits.
    pub const fn new(drive: Drive, travel: ReferenceDistance) -> Self {
        let (time, centre) = (None, None);
        Self {
            drive,
            travel,
            time,
            speed: None,
            start_speed: None,
            acceleration: None,
            jerk: None,
            centre,
        }
    }

    /// The profiles of several kinds.
    ///
    /// # Errors
    /// A [`ReferenceError`] names the kind, what is wrong, and a value that works.
    pub fn references(&self, kinds: &[ProfileKind]) -> Result<Vec<Reference>, ReferenceError> {
        if self.centre.is_some() && !kinds.contains(&ProfileKind::Logistic) {
            return Err(ReferenceError::CentreOf { what: "none is asked for" });
        }
        kinds.iter().map(|&kind| self.reference(kind)).collect()
    }

    /// The profile of one kind.
    ///
    /// # Errors
    /// A [`ReferenceError`] names what is wrong and a value that works.
    pub fn reference(&self, kind: ProfileKind) -> Result<Reference, ReferenceError> {
        let steps = self.in_steps()?;
        let curve = match steps.distance {
            Some(distance) => self.whole(kind, distance, &steps)?,
            None => self.ramp(kind, &steps)?,
        };
        Ok(Reference::new(kind, curve, self.travel == ReferenceDistance::Ramp))
    }

    fn in_steps(&self) -> Result<Steps, ReferenceError> {
        self.drive.check()?;
        let read = |what, quantity: Option<Quantity>, zero: bool| {
            let Some(quantity) = quantity else { return Ok(None) };
            let value = quantity.in_steps(&self.drive)?;
            if VALUES.contains(&value) || zero && value == 0.0 {
                return Ok(Some(value));
            }
            let must =
                if zero { "0, or 1e-9 to 1e15 in steps" } else { "over 0: 1e-9 to 1e15 in steps" };
            Err(ReferenceError::OutOfRange { what, value: quantity.value(), must })
        };
        let start_speed = read("the start speed", self.start_speed, true)?.unwrap_or(0.0);
        let top = read("the speed", self.speed, false)?;
        let acceleration =
            read("the acceleration", self.acceleration, false)?.unwrap_or(f64::INFINITY);
        let jerk = read("the jerk", self.jerk, false)?.unwrap_or(f64::INFINITY);
        if let Some(value) = self.time.filter(|time| !VALUES.contains(time)) {
            return Err(ReferenceError::OutOfRange {
                what: "the time",
                value,
                must: "over 0: 1e-9 to 1e15 s",
            });
        }
        if let Some(value) = self.centre.filter(|centre| !(-1e15..=1e15).contains(centre)) {
            return Err(ReferenceError::OutOfRange {
                what: "the centre T_i",
                value,
                must: "-1e15 to 1e15 s",
            });
        }
        let speed = top.unwrap_or(f64::INFINITY);
        if start_speed >= speed {
            return Err(ReferenceError::TopUnderStart { start: start_speed, top: speed });
        }
        let distance = match self.travel {
            ReferenceDistance::Ramp => None,
            ReferenceDistance::Move(distance) => Some(self.whole_steps(&distance)?),
        };
        Ok(Steps { distance, top, limits: Limits { start_speed, speed, acceleration, jerk } })
    }

    /// Converts a distance to whole steps. Only the rounding of its unit is removed.
    fn whole_steps(&self, distance: &Quantity) -> Result<f64, ReferenceError> {
        let steps = distance.in_steps(&self.drive)?;
        let nearest = steps.round();
        if !(1.0..=MOST_STEPS).contains(&nearest) {
            let (what, must) = ("the distance", "one step or more, and at most 2^53");
            return Err(ReferenceError::OutOfRange { what, value: distance.value(), must });
        }
        if (steps - nearest).abs() <= 1e-9 * nearest {
            return Ok(nearest);
        }
        let near = |steps: f64| Ok(rounded(distance.back(steps, &self.drive)?, 12, f64::round));
        Err(ReferenceError::NotWhole {
            distance: distance.value(),
            unit: distance.unit(0),
            below: near(steps.floor().max(1.0))?,
            above: near(steps.ceil())?,
        })
    }

    fn ramp(
        &self,
        kind: ProfileKind,
        steps: &Steps,
    ) -> Result<Arc<dyn Curve<f64>>, ReferenceError> {
        if kind == ProfileKind::Constant {
            return Err(ReferenceError::NoRamp);
        }
        let Steps { limits, .. } = steps;
        let missing = |what: &str| Err(ReferenceError::Missing { kind, what: what.to_owned() });
        let Some(top) = steps.top else { return missing("a speed to go to") };
        if kind == ProfileKind::Scurve && limits.jerk.is_infinite() {
            return missing(&self.jerk_advice(top, limits));
        }
        if self.time.is_none() && limits.acceleration.is_infinite() {
            return missing("an acceleration or a time");
        }
        let refused = |refusal| self.refused(kind, refusal);
        if let Some(centre) = self.centre.filter(|_| kind == ProfileKind::Logistic) {
            self.nothing_besides_the_centre()?;
            let ramp = rule::logistic_ramp_about(top, centre, limits);
            return Ok(Arc::new(ramp.map_err(|bad| ReferenceError::Bad { kind, bad })?));
        }
        kinds::ramp(kind, top, self.time, limits).ok_or(ReferenceError::NoRamp)?.map_err(refused)
    }

    fn whole(
        &self,
        kind: ProfileKind,
        distance: f64,
        steps: &Steps,
    ) -> Result<Arc<dyn Curve<f64>>, ReferenceError> {
        let Steps { limits, .. } = steps;
        if self.centre.is_some() && kind == ProfileKind::Logistic {
            return Err(ReferenceError::CentreOf {
                what: "a move has two, symmetric in themselves",
            });
        }
        let missing = |what: String| Err(ReferenceError::Missing { kind, what });
        if kind != ProfileKind::Constant && limits.acceleration.is_infinite() {
            return missing("an acceleration limit".to_owned());
        }
        if kind == ProfileKind::Scurve && limits.jerk.is_infinite() {
            let top = limits.speed.min((distance * limits.acceleration / 2.0).sqrt());
            return missing(self.jerk_advice(top, limits));
        }
        let refused = |refusal| self.refused(kind, refusal);
        let least = kinds::least_time(kind, distance, limits).map_err(refused)?;
        let time = self.time.unwrap_or(least);
        kinds::whole(kind, distance, time, limits).map_err(refused)
    }

    /// Converts a refusal to the unit in which the user gave the limit.
    fn refused(&self, kind: ProfileKind, refusal: LimitRefusal) -> ReferenceError {
        let LimitRefusal { limit, wanted, available, least_time } = refusal;
        let stated = match limit {
            Limit::StartSpeed => self.start_speed,
            Limit::Speed => self.speed,
            Limit::Acceleration => self.acceleration,
            Limit::Jerk => self.jerk,
        };
        let stated = stated.unwrap_or(Quantity::new(available, Length::Step));
        let (limit, power) = in_words(limit);
        let wanted = stated.back(wanted, &self.drive).map_or(wanted, up);
        let (available, unit) = (stated.value(), stated.unit(power));
        ReferenceError::Refused {
            kind,
            limit,
            available,
            wanted,
            unit,
            least_time: least_time.map(up),
        }
    }

    /// The advice to a user who gave no jerk limit: the jerk of the sine with the same speed and
    /// acceleration.
    fn jerk_advice(&self, top: f64, limits: &Limits<f64>) -> String {
        let acceleration =
            self.time.map_or(limits.acceleration, |time| limits.acceleration.min(2.0 * top / time));
        if acceleration.is_infinite() {
            return "a jerk limit".to_owned();
        }
        let jerk = PI * acceleration * acceleration / (2.0 * top);
        let stated = Quantity::new(jerk, self.acceleration.map_or(Length::Step, |a| a.length()));
        let (jerk, unit) = (stated.back(jerk, &self.drive).map_or(jerk, up), stated.unit(3));
        format!(
            "a jerk limit; the sine has one of {jerk} {unit} at the same speed and acceleration"
        )
    }

    fn nothing_besides_the_centre(&self) -> Result<(), ReferenceError> {
        if self.time.is_some() {
            return Err(ReferenceError::CentreAnd { what: "a time" });
        }
        if self.start_speed.is_some() {
            return Err(ReferenceError::CentreAnd { what: "a start speed" });
        }
        Ok(())
    }
}

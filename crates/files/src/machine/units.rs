//! `unit`, `lead`, `steps_per_rev`, `microsteps` and speeds per minute: the parameters of an axis
//! in terms of its mechanics.

use super::axis::RawAxis;
use crate::decimal;
use crate::error::{InputError, SourceText};
use crate::number::{not_negative, positive};
use crate::unit::Unit;
use bigdecimal::{BigDecimal, RoundingMode, Signed};
use std::ops::Range;
use toml::Spanned;

/// Number of decimals that are kept of a quotient.
const PLACES: i64 = 60;

/// Greatest number of characters in the name of a unit.
const LONGEST_NAME: usize = 12;

const MECHANICS: &str = "give steps_per_unit, or lead (units that one turn of the motor moves), steps_per_rev and microsteps";

/// A speed of the file, in steps/s, and its place.
pub(super) struct Speed {
    /// The speed in steps/s. A speed per minute that is not a finite decimal per second is cut off
    /// after 60 decimals.
    pub steps: BigDecimal,
    pub span: Range<usize>,
    /// The key that the file uses.
    pub key: &'static str,
}

impl RawAxis {
    /// Steps per unit, as given or computed as `steps_per_rev` x `microsteps` / `lead`.
    ///
    /// A quotient that is not a finite decimal is rounded up at its 60th decimal. A target of
    /// exactly half a step therefore stays at or above the half and rounds as the fraction would.
    pub(super) fn steps_per_unit(
        &self,
        source: &SourceText,
        table: Range<usize>,
    ) -> Result<BigDecimal, InputError> {
        let turns = [
            ("lead", self.lead.as_ref().map(Spanned::span)),
            ("steps_per_rev", self.steps_per_rev.as_ref().map(Spanned::span)),
            ("microsteps", self.microsteps.as_ref().map(Spanned::span)),
        ];
        let given = turns.iter().find_map(|(key, span)| span.clone().map(|span| (key, span)));
        match (&self.steps_per_unit, given) {
            (Some(value), None) => positive(source, value, "steps_per_unit"),
            (Some(_), Some((key, span))) => Err(InputError::at(
                source,
                span,
                format!("both steps_per_unit and {key} are given"),
            )
            .help(
                "steps_per_unit says it all: leave out lead, steps_per_rev and microsteps, or leave out steps_per_unit",
            )),
            (None, None) => Err(InputError::at(source, table, "missing field `steps_per_unit`").help(MECHANICS)),
            (None, Some((_, span))) => {
                let (Some(lead), Some(steps), Some(microsteps)) = (&self.lead, &self.steps_per_rev, &self.microsteps)
                else {
                    let absent = turns.iter().filter(|(_, span)| span.is_none()).map(|(key, _)| *key);
                    let absent = absent.collect::<Vec<_>>().join(" and ");
                    return Err(InputError::at(source, span, format!("missing field: {absent}")).help(MECHANICS));
                };
                let lead = positive(source, lead, "lead")?;
                let turn = whole(source, steps, "steps_per_rev")? * whole(source, microsteps, "microsteps")?;
                Ok((turn / lead).with_scale_round(PLACES, RoundingMode::Up).normalized())
            }
        }
    }

    /// The unit in which the axis is displayed.
    pub(super) fn unit(
        &self,
        source: &SourceText,
        steps_per_unit: &BigDecimal,
    ) -> Result<Unit, InputError> {
        let name = self.unit.as_ref().map(|name| name.as_ref().as_str());
        let fits = |c: char| c.is_alphanumeric() || "°'\"%_".contains(c);
        if let (Some(text), Some(span)) = (name, self.unit.as_ref().map(Spanned::span))
            && !(text.chars().all(fits) && (1..=LONGEST_NAME).contains(&text.chars().count()))
        {
            return Err(InputError::at(source, span, format!("{text:?} cannot name a unit")).help(format!(
                "1 to {LONGEST_NAME} letters, digits, ° or _, as in unit = \"mm\"; \"/s\" is added by itself"
            )));
        }
        Ok(Unit::new(name, decimal::to_f64(steps_per_unit)))
    }

    pub(super) fn speed_limit(
        &self,
        source: &SourceText,
        table: Range<usize>,
        scale: &BigDecimal,
    ) -> Result<Speed, InputError> {
        let keys = ("speed_limit", "speed_limit_per_min");
        let found =
            speed(source, keys, (&self.speed_limit, &self.speed_limit_per_min), positive, scale)?;
        found.ok_or_else(|| {
            InputError::at(source, table, "missing field `speed_limit`")
                .help("give speed_limit in units/s, or speed_limit_per_min in units/min")
        })
    }

    pub(super) fn start_speed(
        &self,
        source: &SourceText,
        scale: &BigDecimal,
    ) -> Result<Option<Speed>, InputError> {
        let keys = ("start_speed", "start_speed_per_min");
        speed(source, keys, (&self.start_speed, &self.start_speed_per_min), not_negative, scale)
    }
}

type Reader = fn(&SourceText, &Spanned<f64>, &str) -> Result<BigDecimal, InputError>;
type Number = Option<Spanned<f64>>;

/// A speed per second or per minute, converted to steps/s.
fn speed(
    source: &SourceText,
    keys: (&'static str, &'static str),
    (per_s, per_min): (&Number, &Number),
    read: Reader,
    steps_per_unit: &BigDecimal,
) -> Result<Option<Speed>, InputError> {
    match (per_s, per_min) {
        (None, None) => Ok(None),
        (Some(value), None) => {
            let steps = read(source, value, keys.0)? * steps_per_unit;
            Ok(Some(Speed { steps, span: value.span(), key: keys.0 }))
        }
        (None, Some(value)) => {
            let per_minute = read(source, value, keys.1)? * steps_per_unit;
            let steps = (per_minute / BigDecimal::from(60))
                .with_scale_round(PLACES, RoundingMode::Down)
                .normalized();
            Ok(Some(Speed { steps, span: value.span(), key: keys.1 }))
        }
        (Some(_), Some(value)) => {
            let message = format!("both {} and {} are given", keys.0, keys.1);
            Err(InputError::at(source, value.span(), message)
                .help("keep one of them: the first is per second, the other per minute"))
        }
    }
}

/// A whole number greater than zero.
fn whole(source: &SourceText, value: &Spanned<u32>, key: &str) -> Result<BigDecimal, InputError> {
    let exact = BigDecimal::from(*value.as_ref());
    if exact.is_positive() {
        return Ok(exact);
    }
    Err(InputError::at(source, value.span(), format!("{key} = 0: must be over zero")))
}

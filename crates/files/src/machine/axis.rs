//! `[[machine.axis]]`: units, limits and driver of an axis, each checked against the timebase.

use super::gantry::RawMotor;
use super::home::{RawHome, RawPlace};
use super::{Axis, AxisLimit, stop};
use crate::decimal;
use crate::did_you_mean;
use crate::driver::drivers;
use crate::error::{InputError, SourceText, quoted};
use crate::number::positive;
use crate::unit::Unit;
use bigdecimal::{BigDecimal, Zero};
use carrystep_core::build::{MAX_CLOCKS, PinTimes, PinTiming, Timebase};
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a [[machine.axis]] table")]
pub(super) struct RawAxis {
    pub(super) name: Spanned<String>,
    letter: Option<Spanned<String>>,
    pub(super) steps_per_unit: Option<Spanned<f64>>,
    pub(super) unit: Option<Spanned<String>>,
    pub(super) lead: Option<Spanned<f64>>,
    pub(super) steps_per_rev: Option<Spanned<u32>>,
    pub(super) microsteps: Option<Spanned<u32>>,
    pub(super) start_speed: Option<Spanned<f64>>,
    pub(super) start_speed_per_min: Option<Spanned<f64>>,
    pub(super) speed_limit: Option<Spanned<f64>>,
    pub(super) speed_limit_per_min: Option<Spanned<f64>>,
    accel_limit: Spanned<f64>,
    jerk_limit: Option<Spanned<f64>>,
    stop_accel: Option<Spanned<f64>>,
    driver: Option<Spanned<String>>,
    // The aliases are the names of the first edition, which files of users contain.
    #[serde(alias = "step_ns")]
    step_high_ns: Option<Spanned<u64>>,
    #[serde(alias = "gap_ns")]
    step_low_ns: Option<Spanned<u64>>,
    #[serde(alias = "setup_ns")]
    dir_setup_ns: Option<Spanned<u64>>,
    #[serde(alias = "hold_ns")]
    dir_hold_ns: Option<Spanned<u64>>,
    travel: Option<Spanned<Vec<Spanned<f64>>>>,
    home: Option<Spanned<RawHome>>,
}

impl RawAxis {
    /// Removes the entries that can only be checked when the guard is known.
    pub(super) fn place(&mut self) -> RawPlace {
        RawPlace { travel: self.travel.take(), home: self.home.take() }
    }

    /// Removes what says of which letter it is a motor. `table` is the place of its table in the file.
    pub(super) fn motor(&mut self, table: Range<usize>) -> RawMotor {
        RawMotor { letter: self.letter.take(), name: self.name.span(), table }
    }

    /// Checks the axis. `table` is the place of its table in the file.
    pub(super) fn check(
        self,
        source: &SourceText,
        table: Range<usize>,
        timebase: &Timebase,
    ) -> Result<Axis, InputError> {
        let name = self.name.as_ref().clone();
        let fit = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if !name.starts_with(|c: char| c.is_ascii_alphabetic())
            || !name.chars().all(fit)
            || name.len() > 32
        {
            return Err(InputError::at(source, self.name.span(), format!("{:?} cannot name an axis", quoted(&name))).help(
                "a name starts with a letter and has letters, digits and _ only, 32 at most: it becomes a signal name",
            ));
        }
        let steps_per_unit = self.steps_per_unit(source, table.clone())?;
        let unit = self.unit(source, &steps_per_unit)?;
        let limit = |steps, seconds| AxisLimit::new(steps, seconds, timebase);
        let in_steps = |value: BigDecimal, seconds| limit(value * &steps_per_unit, seconds);
        let start = self.start_speed(source, &steps_per_unit)?;
        let speed = self.speed_limit(source, table, &steps_per_unit)?;
        let accel_limit = in_steps(positive(source, &self.accel_limit, "accel_limit")?, 2);
        not_too_slow(source, speed.span.clone(), speed.key, &speed.steps, (&unit, 1))?;
        not_too_slow(
            source,
            self.accel_limit.span(),
            "accel_limit",
            &accel_limit.steps,
            (&unit, 2),
        )?;
        let jerk_limit = match &self.jerk_limit {
            None => None,
            Some(value) => Some(in_steps(positive(source, value, "jerk_limit")?, 3)),
        };
        if let Some(start) = start.as_ref().filter(|start| start.steps > speed.steps) {
            let message = format!("{} is over {}", start.key, speed.key);
            return Err(InputError::at(source, start.span.clone(), message)
                .help("the start speed is part of the speed range: at most speed_limit"));
        }
        let start_speed = start.map_or_else(BigDecimal::zero, |start| start.steps);
        let (pins_ns, pins) = self.pins(source, timebase)?;
        let stop = match &self.stop_accel {
            None => stop::at_the_limit(&accel_limit),
            Some(value) => stop::units(source, value, &steps_per_unit, &unit, timebase)?,
        };
        let axis = Axis {
            letter: name.clone(),
            name,
            steps_per_unit,
            unit,
            start_speed: limit(start_speed, 1),
            speed_limit: limit(speed.steps, 1),
            accel_limit,
            jerk_limit,
            stop,
            pins_ns,
            pins,
            travel: None,
            home: None,
        };
        axis.check_speed(source, speed.span, timebase)?;
        axis.check_acceleration(source, self.accel_limit.span(), timebase)?;
        Ok(axis)
    }

    /// STEP width, gap, set-up and hold, from the driver's preset and the values that override it;
    /// in ns and in clocks.
    fn pins(
        &self,
        source: &SourceText,
        timebase: &Timebase,
    ) -> Result<(PinTimes, PinTiming), InputError> {
        let preset = match &self.driver {
            None => None,
            Some(name) => Some(drivers().get(name.as_ref().as_str()).ok_or_else(|| {
                let known: Vec<&str> = drivers().keys().map(String::as_str).collect();
                let meant = did_you_mean(name.as_ref(), known.iter().copied());
                InputError::at(
                    source,
                    name.span(),
                    format!("no driver is called '{}'{meant}", quoted(name.as_ref())),
                )
                .help(format!(
                    "known: {}; or give step_high_ns, step_low_ns, dir_setup_ns and dir_hold_ns",
                    known.join(", ")
                ))
            })?),
        };
        // A time in ns and in clocks.
        let time = |key, given: &Option<Spanned<u64>>, default: Option<u64>| {
            let Some(ns) = given.as_ref().map(|value| *value.as_ref()).or(default) else {
                return Err(InputError::at(
                    source,
                    self.name.span(),
                    format!("axis '{}' has no driver and no {key}", self.name.as_ref()),
                )
                .help("name a driver, or give step_high_ns, step_low_ns, dir_setup_ns and dir_hold_ns"));
            };
            let span = given.as_ref().map_or_else(|| self.name.span(), Spanned::span);
            let exact = timebase.clocks_for_ns(ns);
            let clocks = u32::try_from(exact).ok().filter(|&clocks| clocks < MAX_CLOCKS);
            let clocks = clocks.ok_or_else(|| {
                let most = MAX_CLOCKS - 1;
                let message =
                    format!("{key} = {ns} ns is {exact} clocks: the timers count to {most}");
                InputError::at(source, span, message)
            })?;
            Ok((ns, clocks))
        };
        let (step_high_ns, step_high) =
            time("step_high_ns", &self.step_high_ns, preset.map(|d| d.step_high_ns))?;
        let (step_low_ns, step_low) =
            time("step_low_ns", &self.step_low_ns, preset.map(|d| d.step_low_ns))?;
        let (dir_setup_ns, dir_setup) =
            time("dir_setup_ns", &self.dir_setup_ns, preset.map(|d| d.dir_setup_ns))?;
        let (dir_hold_ns, dir_hold) =
            time("dir_hold_ns", &self.dir_hold_ns, preset.map(|d| d.dir_hold_ns))?;
        let times = PinTimes {
            step_high: step_high_ns,
            step_low: step_low_ns,
            dir_setup: dir_setup_ns,
            dir_hold: dir_hold_ns,
        };
        Ok((times, PinTiming { step_high, step_low, dir_setup, dir_hold }))
    }
}

/// Rejects a limit below a thousandth of a step (per second or its powers). A plan would last
/// months, and the value would be too coarse in units of 2^-64 step per tick.
fn not_too_slow(
    source: &SourceText,
    span: Range<usize>,
    key: &str,
    limit: &BigDecimal,
    (unit, seconds): (&Unit, u32),
) -> Result<(), InputError> {
    let least = BigDecimal::new(1.into(), 3);
    if *limit >= least {
        return Ok(());
    }
    let limit = unit.both(decimal::to_f64(limit), seconds);
    let least = Unit::new(None, 1.0).own(decimal::to_f64(&least), seconds);
    Err(InputError::at(source, span, format!("{key} is {limit}: under {least}"))
        .help("check steps_per_unit and the unit of the limit; a moving axis makes a step in a quarter of an hour"))
}

impl Axis {
    /// Checks the speed limit: below half a step per tick, and with a step period that the driver's
    /// width and gap allow.
    pub(super) fn check_speed(
        &self,
        source: &SourceText,
        span: Range<usize>,
        timebase: &Timebase,
    ) -> Result<(), InputError> {
        let limit = self.unit.both(self.speed_limit.float, 1);
        let doubled = &self.speed_limit.steps * BigDecimal::from(2 * timebase.tick_ns());
        if doubled >= 1_000_000_000 {
            let half = self.unit.at_most(0.5e9 / timebase.tick_ns() as f64, 1);
            return Err(InputError::at(
                source,
                span,
                format!("speed_limit is {limit}: half a step per tick or more"),
            )
            .help(format!("with ticks of {} ns stay under {half}", timebase.tick_ns())));
        }
        let PinTiming { step_high, step_low, .. } = self.pins;
        let clocks =
            u64::from(step_high) + u64::from(step_low) + u64::from(timebase.clocks_per_phase());
        if &self.speed_limit.steps * BigDecimal::from(clocks) > timebase.clock_hz() {
            let most = self.unit.at_most(timebase.clock_hz() as f64 / clocks as f64, 1);
            return Err(InputError::at(
                source,
                span,
                format!(
                    "speed_limit is {limit}: over what the driver's step_high and step_low allow"
                ),
            )
            .help(format!(
                "a pulse takes {step_high} + {step_low} clocks and one phase of {}: at most {most}",
                timebase.clocks_per_phase()
            )));
        }
        Ok(())
    }

    /// Checks the acceleration limit: below half a step per tick^2, so that A fits its register.
    fn check_acceleration(
        &self,
        source: &SourceText,
        span: Range<usize>,
        timebase: &Timebase,
    ) -> Result<(), InputError> {
        let tick = BigDecimal::from(timebase.tick_ns());
        if &self.accel_limit.steps * &tick * &tick * BigDecimal::from(2) >= 10_u64.pow(18) {
            let limit = self.unit.both(self.accel_limit.float, 2);
            let half = self.unit.at_most(0.5e18 / (timebase.tick_ns() as f64).powi(2), 2);
            return Err(InputError::at(
                source,
                span,
                format!("accel_limit is {limit}: half a step per tick^2 or more"),
            )
            .help(format!("with ticks of {} ns stay under {half}", timebase.tick_ns())));
        }
        Ok(())
    }
}

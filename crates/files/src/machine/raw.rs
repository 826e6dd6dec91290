//! The machine file as it is written: structures that mirror the TOML, and their checks against each
//! other, which make a [`Machine`] of them.

use super::axis::RawAxis;
use super::guard::RawGuard;
use super::home::{RawOrder, RawPlace};
use super::inputs::RawInputs;
use super::link::RawLink;
use super::outputs::RawOutputs;
use super::{Axis, Kinematics, Machine, adders, gantry, home, kinematics, queue};
use crate::error::{InputError, SourceText};
use carrystep_core::build::{AXES, Timebase, TimebaseError};
use carrystep_core::engine::MAX_AXES;
use carrystep_core::fixed::StartPhase;
use carrystep_core::tick::{ChosenTick, FIXED_CLOCK_HZ, default_tick_of_adders, nearest_ticks};
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a machine file")]
pub(super) struct RawMachineFile {
    pub(super) machine: RawMachine,
}

/// The `[machine]` table as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a [machine] table")]
pub(crate) struct RawMachine {
    clock_hz: Option<Spanned<u64>>,
    tick_ns: Option<Spanned<u64>>,
    phases: Option<Spanned<u32>>,
    #[serde(default)]
    phase: StartPhase,
    kinematics: Option<Spanned<Kinematics>>,
    #[serde(default)]
    guard: RawGuard,
    #[serde(default)]
    inputs: RawInputs,
    #[serde(default)]
    outputs: RawOutputs,
    #[serde(default)]
    link: RawLink,
    queue_depth: Option<Spanned<usize>>,
    #[serde(default)]
    cuts: bool,
    adders: Option<Spanned<usize>>,
    home_order: Option<RawOrder>,
    axis: Spanned<Vec<Spanned<RawAxis>>>,
}

impl RawMachine {
    /// The place of the first axis that the six-axis core cannot hold.
    pub(crate) fn seventh(&self) -> Option<Range<usize>> {
        self.axis.as_ref().get(AXES).map(Spanned::span)
    }

    pub(crate) fn check(self, source: &SourceText) -> Result<Machine, InputError> {
        let adders = adders::check(source, self.adders.as_ref(), self.axis.as_ref().len())?;
        let (timebase, chosen_tick) = self.timebase(source, adders)?;
        adders::check_tick(source, self.adders.as_ref(), self.axis.as_ref().len(), &timebase)?;
        let span = self.axis.span();
        let raw = self.axis.into_inner();
        if raw.is_empty() {
            return Err(InputError::at(source, span, "a machine without axes")
                .help("add a [[machine.axis]] table for each axis"));
        }
        if raw.len() > MAX_AXES {
            let message = format!("{} axes: an engine drives at most {MAX_AXES}", raw.len());
            return Err(InputError::at(source, raw[MAX_AXES].span(), message)
                .help("leave out axes, or build two engines"));
        }
        let mut axes: Vec<Axis> = Vec::with_capacity(raw.len());
        let mut places: Vec<RawPlace> = Vec::with_capacity(raw.len());
        let mut motors = Vec::with_capacity(raw.len());
        for axis in raw {
            let (name_span, table) = (axis.as_ref().name.span(), axis.span());
            let mut axis = axis.into_inner();
            places.push(axis.place());
            motors.push(axis.motor(table.clone()));
            let axis = axis.check(source, table, &timebase);
            let axis = axis.map_err(|error| with_proposal(error, chosen_tick.as_ref()))?;
            if axes.iter().any(|other| other.name == axis.name) {
                return Err(InputError::at(
                    source,
                    name_span,
                    format!("two axes are called '{}'", axis.name),
                )
                .help("give each axis a name of its own"));
            }
            axes.push(axis);
        }
        gantry::unite(source, &timebase, &mut axes, &motors)?;
        let crossed = self.kinematics.filter(|named| *named.as_ref() == Kinematics::CoreXy);
        let crossed = crossed.map(|named| named.span());
        if let Some(place) = crossed.clone() {
            let names: Vec<_> = motors.iter().map(|motor| motor.name.clone()).collect();
            kinematics::cross(source, &timebase, &mut axes, place, &names)?;
        }
        let names: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
        let inputs = self.inputs.check(source, &names, self.guard.limits())?;
        let stop = axes.iter().map(|axis| axis.stop).collect();
        let guard = self.guard.check(source, &timebase, inputs, stop)?;
        let home = |place: &RawPlace| place.home.as_ref().map(Spanned::span);
        let homes: Vec<_> = places.iter().map(home).collect();
        let home_order =
            home::check(source, &timebase, &guard, &mut axes, places, self.home_order)?;
        if let Some(place) = crossed.clone() {
            kinematics::check_switches(source, &axes, guard.limits, place, &homes)?;
        }
        let outputs = self.outputs.check(source)?;
        let (baud, spi) = (self.link.baud(source, &timebase)?, self.link.spi(source)?);
        Ok(Machine {
            timebase,
            chosen_tick,
            phase: self.phase,
            kinematics: if crossed.is_some() { Kinematics::CoreXy } else { Kinematics::Cartesian },
            axes,
            guard,
            outputs,
            output_uses: self.outputs.uses(source, outputs)?,
            queue: queue::check(source, self.queue_depth.as_ref())?,
            cuts: self.cuts,
            adders,
            home_order,
            baud,
            spi,
        })
    }

    /// Clock, tick and phases. If the file gives no tick, also how the tick was chosen.
    fn timebase(
        &self,
        source: &SourceText,
        adders: usize,
    ) -> Result<(Timebase, Option<ChosenTick>), InputError> {
        let clock_hz = self.clock_hz.as_ref().map_or(FIXED_CLOCK_HZ, |v| *v.as_ref());
        let phases = self.phases.as_ref().map_or(16, |v| *v.as_ref());
        let axes = self.axis.as_ref().len().clamp(1, MAX_AXES);
        let given = self.tick_ns.as_ref().map(|v| (*v.as_ref(), None));
        // If the clock allows no tick, the tick of 1 ns makes the check below fail with the
        // matching error.
        let (tick_ns, chosen) = given
            .or_else(|| default_tick_of_adders(clock_hz, phases, axes, adders))
            .unwrap_or((1, None));
        let timebase = Timebase::new(clock_hz, tick_ns, phases).map_err(|error| {
            let tick = self.tick_ns.as_ref().map(Spanned::span);
            let clock = self.clock_hz.as_ref().map(Spanned::span);
            let phase_span = self.phases.as_ref().map(Spanned::span);
            // Points at the value that is wrong. If that value is a default, points at another
            // value that contributes to the error.
            let span = match error {
                TimebaseError::Clock(_) => clock,
                TimebaseError::Phases(_) => phase_span,
                TimebaseError::NotWhole { .. } | TimebaseError::Range(_) => tick.clone().or(clock),
                TimebaseError::NotDivisible { .. } => phase_span.or(tick.clone()).or(clock),
            };
            let (message, help) = match error {
                TimebaseError::Clock(_) | TimebaseError::Phases(_) => (error.to_string(), None),
                _ if tick.is_none() => (
                    format!("a clock of {clock_hz} Hz has no tick"),
                    Some(nearest_ticks(clock_hz, tick_ns, phases, axes)),
                ),
                _ => (error.to_string(), Some(nearest_ticks(clock_hz, tick_ns, phases, axes))),
            };
            let place = span.map(|span| (source.clone(), span));
            InputError { message, help, place, lines_before: 0 }
        })?;
        Ok((timebase, chosen))
    }
}

/// Adds the proposal of fewer phases to an error of an axis, if they would shorten the tick that
/// was chosen.
fn with_proposal(mut error: InputError, chosen: Option<&ChosenTick>) -> InputError {
    if let (Some(help), Some(proposal)) = (&mut error.help, chosen.and_then(ChosenTick::proposal)) {
        *help = format!("{help}; {proposal}");
    }
    error
}

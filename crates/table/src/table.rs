//! Converts a request to compare values.
//!
//! The names of the fields are part of `--json` and may not change.

use crate::austin::{ConstantAcceleration, FloatRecurrence, IntegerRecurrence};
use crate::error::TableError;
use crate::figures::TableFigures;
use crate::groups::{self, Group};
use crate::inverse_table::InverseTable;
use crate::logistic::Logistic;
use crate::request::{Arithmetic, Kind, TableRequest};
use crate::sine::Sine;
use schemars::JsonSchema;
use serde::Serialize;

/// A ramp in compare values, ready for the player.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct Table {
    request: TableRequest,
    figures: TableFigures,
    compare: Vec<u16>,
    cruise: u16,
    groups: Vec<Group>,
    #[serde(skip_serializing_if = "Option::is_none")]
    inverse: Option<Vec<u16>>,
    #[serde(skip)]
    ideal: Vec<f64>,
}

/// The entries before they are converted to compare values.
struct Entries {
    /// Delays of the formula, counts, not rounded.
    ideal: Vec<f64>,
    /// Delays in whole counts.
    counts: Vec<u32>,
    /// Pulses of each entry.
    sizes: Vec<u32>,
}

impl Table {
    /// Computes a table.
    ///
    /// Each delay is rounded to the nearest count by itself, as in the source methods. After n
    /// pulses a move is at most n / 2 counts away from its curve.
    ///
    /// # Errors
    /// A [`TableError`] names the parameter and the nearest value that works. For a delay that does
    /// not fit the timer it names a prescaler that works, if there is one.
    pub fn new(request: TableRequest) -> Result<Self, TableError> {
        request.check()?;
        let timer = &request.timer;
        let cruise_ideal = timer.frequency() / request.top_frequency();
        let Entries { ideal, counts, sizes } = match request.kind {
            Kind::Logistic { entries, steepness, centre } => {
                let centre = centre.unwrap_or(f64::from(entries) / 2.0);
                let (start, top) = (request.start_frequency, request.top_frequency());
                logistic(&request, entries, &Logistic { start, top, steepness, centre })?
            }
            Kind::Avr446 { ramp_steps, arithmetic } => {
                let (ideal, whole) = avr446(&request, ramp_steps, arithmetic)?;
                merged(&request, &ideal, whole.as_deref())?
            }
            Kind::Sine { ramp_steps, .. } => {
                let ideal = sine(&request, ramp_steps);
                timer.fit(cruise_ideal, longest(&ideal))?;
                merged(&request, &ideal, None)?
            }
        };
        let most_seconds = |pulses: u32| cruise_ideal * f64::from(pulses) / timer.frequency();
        let groups = groups::runs(&sizes, most_seconds)?;
        let compare = counts.iter().map(|&c| timer.word(c)).collect::<Result<Vec<_>, _>>()?;
        let cruise = timer.word(round(cruise_ideal))?;
        let inverse = match request.kind {
            Kind::Sine { inverse, .. } => {
                inverse.map(|intervals| InverseTable::new(intervals).words())
            }
            _ => None,
        };
        let figures =
            TableFigures::new(&request, &ideal, &counts, &sizes, &groups, inverse.as_deref());
        Ok(Self { request, figures, compare, cruise, groups, inverse, ideal })
    }

    /// The request from which the table was computed.
    pub fn request(&self) -> &TableRequest {
        &self.request
    }

    /// The figures that a user needs to judge the table.
    pub fn figures(&self) -> &TableFigures {
        &self.figures
    }

    /// Compare values of the entries, in order of rising speed.
    pub fn compare(&self) -> &[u16] {
        &self.compare
    }

    /// Compare value of the cruise.
    pub fn cruise(&self) -> u16 {
        self.cruise
    }

    /// Runs of entries with the same number of pulses, in order.
    pub fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// The inverse table of the sine curve, if it was requested.
    pub fn inverse(&self) -> Option<&[u16]> {
        self.inverse.as_deref()
    }

    /// Delays of the entries by the formula, counts, not rounded.
    pub fn ideal_delays(&self) -> &[f64] {
        &self.ideal
    }

    /// The index of the entry of each pulse of the ramp.
    pub fn ramp_entries(&self) -> impl Iterator<Item = usize> + '_ {
        let starts = std::iter::once(0).chain(self.groups.iter().map(|group| group.end));
        starts.zip(&self.groups).flat_map(|(start, group)| {
            (start..group.end).flat_map(|entry| {
                std::iter::repeat_n(usize::from(entry), usize::from(group.pulses))
            })
        })
    }

    /// The delays before each pulse of a move of `steps` steps, counts: the values that the player
    /// has to play.
    ///
    /// Delay j of N is that of ramp pulse min(j, N - 1 - j), or that of the cruise if the ramp has
    /// fewer pulses. A long move goes up, cruises and goes down. A move shorter than two ramps goes
    /// up and down. Both are symmetric.
    pub fn delays(&self, steps: u32) -> impl Iterator<Item = u32> + '_ {
        let needed = steps.div_ceil(2) as usize;
        let ramp: Vec<u16> =
            self.ramp_entries().take(needed).filter_map(|e| self.compare.get(e).copied()).collect();
        (0..steps).map(move |j| {
            let place = j.min(steps - 1 - j) as usize;
            self.request.timer.counts(ramp.get(place).copied().unwrap_or(self.cruise))
        })
    }
}

fn logistic(request: &TableRequest, entries: u32, curve: &Logistic) -> Result<Entries, TableError> {
    let timer = &request.timer;
    let ideal: Vec<f64> =
        (0..entries).map(|i| timer.frequency() / curve.frequency(f64::from(i))).collect();
    timer.fit(timer.frequency() / curve.top, longest(&ideal))?;
    let counts: Vec<u32> = ideal.iter().copied().map(round).collect();
    let sizes = groups::stretch(&counts, &request.pulses, timer.frequency())?;
    Ok(Entries { ideal, counts, sizes })
}

/// Delays of the steps by the float recurrence, and by the integer recurrence if it is requested.
fn avr446(
    request: &TableRequest,
    ramp_steps: u32,
    arithmetic: Arithmetic,
) -> Result<(Vec<f64>, Option<Vec<u32>>), TableError> {
    let timer = &request.timer;
    let (start, top) = (request.start_frequency, request.top_frequency());
    let curve = ConstantAcceleration::between(timer.frequency(), start, top, f64::from(ramp_steps));
    // The integer recurrence counts n in quarters of a step. The float recurrence starts at the
    // same n, so that both follow one curve.
    let quarters = (4.0 * curve.steps_at(start)).round();
    let n = quarters / 4.0;
    let first = curve.delay(n);
    let ideal: Vec<f64> = FloatRecurrence::new(first, n).take(ramp_steps as usize).collect();
    let cruise = timer.frequency() / top;
    timer.fit(cruise, longest(&ideal))?;
    let whole = || {
        let recurrence = IntegerRecurrence::new(round(first), quarters as u64);
        // The delay is never shorter than that of the cruise, as in AVR446.
        recurrence.take(ramp_steps as usize).map(|c| c.max(round(cruise))).collect()
    };
    Ok((ideal, (arithmetic == Arithmetic::Integer).then(whole)))
}

/// Delays of the steps along the sine curve, counts.
fn sine(request: &TableRequest, ramp_steps: u32) -> Vec<f64> {
    let curve = Sine {
        start: request.start_frequency,
        top: request.top_frequency(),
        steps: f64::from(ramp_steps),
    };
    let crossings: Vec<f64> = (0..=ramp_steps).map(|n| curve.crossing(f64::from(n))).collect();
    let cruise = 1.0 / curve.top;
    // The last steps have nearly the delay of the cruise; the rounding of two times must not make
    // it shorter.
    let delay = |t: &[f64]| (t[1] - t[0]).max(cruise) * request.timer.frequency();
    crossings.windows(2).map(delay).collect()
}

/// Entries that each cover one step or more.
fn merged(
    request: &TableRequest,
    ideal: &[f64],
    whole: Option<&[u32]>,
) -> Result<Entries, TableError> {
    let sizes = groups::merge(ideal, &request.pulses, request.timer.frequency())?;
    let means = groups::means(ideal, &sizes);
    let counts = match whole {
        Some(whole) => {
            let whole: Vec<f64> = whole.iter().copied().map(f64::from).collect();
            groups::means(&whole, &sizes).into_iter().map(round).collect()
        }
        None => means.iter().copied().map(round).collect(),
    };
    Ok(Entries { ideal: means, counts, sizes })
}

fn round(counts: f64) -> u32 {
    counts.round() as u32
}

fn longest(delays: &[f64]) -> f64 {
    delays.iter().copied().fold(0.0, f64::max)
}

//! Counts the pulses of each axis by their error, for a histogram. The classes grow with the errors,
//! so that the memory is bounded.

use crate::edge::{PinChange, PinSink};
use crate::error::TraceError;
use crate::follow::Follower;
use carrystep_core::{StartPhase, Timebase};
use carrystep_profile::Timeline;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// Classes on each side of zero.
const CLASSES: i64 = 32;

/// Pulses of one axis by their error e = edge - profile.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct ErrorCounts {
    /// The name of the axis.
    pub axis: String,
    /// The error at which the first class begins, ns.
    pub from_ns: f64,
    /// Width of a class, ns.
    pub width_ns: f64,
    /// Number of pulses in each class.
    pub counts: Vec<u64>,
}

/// Counts the pulses of a run by their error.
pub struct ErrorCounter {
    axes: Vec<Counter>,
}

struct Counter {
    name: String,
    follower: Follower,
    width_ns: f64,
    counts: Vec<u64>,
}

impl fmt::Debug for ErrorCounter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ErrorCounter").field("axes", &self.axes.len()).finish_non_exhaustive()
    }
}

impl ErrorCounter {
    /// A counter for axes with these names and profiles. `origin_ps` is the load of the first move
    /// plus the latency L, ps of the capture.
    pub fn new<'a>(
        timebase: &Timebase,
        phase: StartPhase,
        origin_ps: i64,
        axes: impl Iterator<Item = (&'a str, Timeline)>,
    ) -> Self {
        let axes = axes.map(|(name, timeline)| Counter {
            name: name.to_owned(),
            follower: Follower::new(&timeline, phase, timebase, origin_ps),
            width_ns: 0.25,
            counts: vec![0; 2 * CLASSES as usize],
        });
        Self { axes: axes.collect() }
    }

    /// What was counted; without the empty classes at both ends.
    pub fn finish(self) -> Vec<ErrorCounts> {
        let counts = self.axes.into_iter().map(|axis| {
            let first = axis.counts.iter().position(|&count| count > 0).unwrap_or(0);
            let last = axis.counts.iter().rposition(|&count| count > 0).map_or(0, |at| at + 1);
            ErrorCounts {
                axis: axis.name,
                from_ns: (first as i64 - CLASSES) as f64 * axis.width_ns,
                width_ns: axis.width_ns,
                counts: axis.counts[first..last.max(first)].to_vec(),
            }
        });
        counts.collect()
    }
}

impl Counter {
    fn add(&mut self, error_ns: f64) {
        let class = loop {
            let class = (error_ns / self.width_ns).floor();
            if class.abs() < CLASSES as f64 || !class.is_finite() {
                break class as i64;
            }
            self.widen();
        };
        self.counts[(class.clamp(-CLASSES, CLASSES - 1) + CLASSES) as usize] += 1;
    }

    /// Makes two neighbours one class. Zero stays an end of classes.
    fn widen(&mut self) {
        let old = std::mem::replace(&mut self.counts, vec![0; 2 * CLASSES as usize]);
        for (class, count) in (-CLASSES..).zip(old) {
            self.counts[(class.div_euclid(2) + CLASSES) as usize] += count;
        }
        self.width_ns *= 2.0;
    }
}

impl PinSink for ErrorCounter {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        if let Some(axis) = self.axes.get_mut(usize::from(level.axis)) {
            axis.follower.initial(level.pin, level.level);
        }
        Ok(())
    }

    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        let Some(axis) = self.axes.get_mut(usize::from(change.axis)) else { return Ok(()) };
        if let Some(error_ns) = axis.follower.change(change).and_then(|pulse| pulse.error_ns) {
            axis.add(error_ns);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_profile::Leg;

    #[test]
    fn classes_grow_and_lose_no_pulse() {
        let timebase = Timebase::new(80_000_000, 1000, 16).unwrap();
        let timeline = Timeline::new(1e-6, Vec::<Leg>::new());
        let axes = std::iter::once(("x", timeline));
        let mut counter = ErrorCounter::new(&timebase, StartPhase::Half, 0, axes);
        let errors = [0.1, -0.1, 5.0, -62.0, 61.9, 1000.0, -3.0];
        errors.iter().for_each(|&error| counter.axes[0].add(error));
        let found = &counter.finish()[0];
        assert_eq!(found.width_ns, 32.0);
        assert_eq!(found.from_ns, -64.0);
        let class = |error: f64| ((error - found.from_ns) / found.width_ns) as usize;
        let mut expected = vec![0; class(1000.0) + 1];
        errors.iter().for_each(|&error| expected[class(error)] += 1);
        assert_eq!(found.counts, expected);
    }
}

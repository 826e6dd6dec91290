//! Writes time and speed of every pulse as CSV, like the program of the article.
//!
//! The names of the columns are part of the command's interface.

use crate::edge::{PinChange, PinSink};
use crate::error::TraceError;
use crate::follow::{Follower, Pulse};
use carrystep_core::{StartPhase, Timebase};
use carrystep_profile::Timeline;
use std::io::Write;

const HEAD: [&str; 6] = ["axis", "pulse", "time_s", "speed_steps_per_s", "direction", "error_ns"];

/// Returns a writer of a line for every rising edge of STEP, with the columns
/// `axis,pulse,time_s,speed_steps_per_s,direction,error_ns`.
///
/// Times count from the origin. The speed is that of the period which the pulse ends, without a
/// sign; it is empty for the first pulse of a direction. The error is empty beyond the profile's
/// last pulse. `axes` are the names and profiles; `origin_ps` is the load of the first move plus
/// the latency L, ps of the capture.
pub fn csv_writer<'a>(
    out: impl Write + 'a,
    timebase: &Timebase,
    phase: StartPhase,
    origin_ps: i64,
    axes: impl IntoIterator<Item = (&'a str, Timeline)>,
) -> Box<dyn PinSink + 'a> {
    let follow = |(name, timeline)| (name, Follower::new(&timeline, phase, timebase, origin_ps));
    boxed(Box::new(out), origin_ps, axes.into_iter().map(follow).collect())
}

/// The same without a parameter, so that all of it is compiled with this crate.
fn boxed<'a>(
    out: Box<dyn Write + 'a>,
    origin_ps: i64,
    axes: Vec<(&'a str, Follower)>,
) -> Box<dyn PinSink + 'a> {
    Box::new(CsvWriter { out: csv::Writer::from_writer(out), origin_ps, axes, begun: false })
}

struct CsvWriter<'a> {
    out: csv::Writer<Box<dyn Write + 'a>>,
    origin_ps: i64,
    axes: Vec<(&'a str, Follower)>,
    begun: bool,
}

impl CsvWriter<'_> {
    fn begin(&mut self) -> Result<(), csv::Error> {
        if !self.begun {
            self.begun = true;
            self.out.write_record(HEAD)?;
        }
        Ok(())
    }

    fn pulse(&mut self, name: &str, pulse: &Pulse) -> Result<(), csv::Error> {
        self.begin()?;
        let optional = |value: Option<f64>, digits| {
            value.map_or_else(String::new, |x| format!("{x:.digits$}"))
        };
        self.out.write_record([
            name,
            &pulse.number.to_string(),
            &seconds(i128::from(pulse.ps) - i128::from(self.origin_ps)),
            &optional(pulse.speed().map(f64::abs), 6),
            if pulse.backward { "backward" } else { "forward" },
            &optional(pulse.error_ns, 3),
        ])
    }
}

/// Formats ps as seconds exactly, without a float.
fn seconds(ps: i128) -> String {
    const SECOND: u128 = 1_000_000_000_000;
    let sign = if ps < 0 { "-" } else { "" };
    let ps = ps.unsigned_abs();
    format!("{sign}{}.{:012}", ps / SECOND, ps % SECOND)
}

impl PinSink for CsvWriter<'_> {
    fn initial(&mut self, level: PinChange) -> Result<(), TraceError> {
        if let Some((_, follower)) = self.axes.get_mut(usize::from(level.axis)) {
            follower.initial(level.pin, level.level);
        }
        Ok(())
    }

    fn change(&mut self, change: PinChange) -> Result<(), TraceError> {
        let Some((name, follower)) = self.axes.get_mut(usize::from(change.axis)) else {
            return Ok(());
        };
        let name = *name;
        match follower.change(change) {
            Some(pulse) => self.pulse(name, &pulse).map_err(TraceError::csv),
            None => Ok(()),
        }
    }

    fn end(&mut self, _ps: u64) -> Result<(), TraceError> {
        self.begin().map_err(TraceError::csv)?;
        self.out.flush().map_err(|source| TraceError::Write { what: "the CSV", source })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_are_formatted_exactly() {
        assert_eq!(seconds(1), "0.000000000001");
        assert_eq!(seconds(3_600_000_000_000_001), "3600.000000000001");
        assert_eq!(seconds(-1_500_000_000_000), "-1.500000000000");
    }
}

//! Judges what a clock module does from the changes of its levels.

use std::fmt;
use thiserror::Error;

/// Greatest difference of the frequency from the wanted one, in millionths: 0.1 %.
pub const MOST_OFF_PPM: f64 = 1000.0;

/// No time at one level is shorter than this part of the period.
pub const LEAST_PHASE: f64 = 0.45;

/// Clocks between the lock and the first clock that leaves the module, at least.
pub const WAIT_CLOCKS: usize = 1024;

/// A fault of a clock module, or of its models.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ClockFault {
    /// A cell has no model.
    #[error("there is no model of {cell} in the folder")]
    NoModel {
        /// Name of the cell.
        cell: String,
    },
    /// The simulator or a model reports an error, for example of an attribute.
    #[error("simulator or model: {line}")]
    Complaint {
        /// The line.
        line: String,
    },
    /// A line of the bench cannot be read.
    #[error("an unknown line of the bench: {line}")]
    Unread {
        /// The line.
        line: String,
    },
    /// The level is not known.
    #[error("the clock is {level} at {at_ps} ps")]
    Unknown {
        /// X or Z.
        level: char,
        /// Time of the change, ps.
        at_ps: u64,
    },
    /// There are too few clocks in the simulated time.
    #[error("{edges} clocks until the end of the simulation")]
    TooFew {
        /// Clocks that were seen.
        edges: usize,
    },
    /// The clock starts before the lock, or less than [`WAIT_CLOCKS`] clocks after it.
    #[error("the clock starts at {at_ps} ps, {clocks} clocks after the lock")]
    Early {
        /// Time of the first edge, ps.
        at_ps: u64,
        /// Clocks of the manager since the lock.
        clocks: usize,
    },
    /// The lock is lost again.
    #[error("the lock is lost at {at_ps} ps")]
    Unlocked {
        /// Time, ps.
        at_ps: u64,
    },
    /// Another frequency.
    #[error("{hz:.0} Hz instead of {wanted_hz}")]
    Frequency {
        /// The frequency that was found, Hz.
        hz: f64,
        /// The wanted one, Hz.
        wanted_hz: u64,
    },
    /// The level changes again too soon.
    #[error("a pulse of {width_ps} ps at {at_ps} ps")]
    Short {
        /// Time at that level, ps.
        width_ps: u64,
        /// Its begin, ps.
        at_ps: u64,
    },
}

/// What a clock module did, where everything is in order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockFigures {
    /// Frequency, Hz.
    pub hz: f64,
    /// The lock, ps after the start.
    pub lock_ps: u64,
    /// The first edge, ps after the start.
    pub first_ps: u64,
    /// Clocks of the manager between both.
    pub waited: usize,
    /// Shortest and longest time at one level, ps.
    pub phases_ps: (u64, u64),
}

impl fmt::Display for ClockFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { hz, lock_ps, first_ps, waited, phases_ps: (least, most) } = self;
        let us = |ps: &u64| *ps as f64 / 1e6;
        write!(
            f,
            "{:.4} MHz, locked after {:.1} us, first edge after {:.1} us ({waited} clocks), at one level for {least} to {most} ps",
            hz / 1e6,
            us(lock_ps),
            us(first_ps)
        )
    }
}

/// A change of a level: its time, ps, and the new level.
type Change = (u64, char);

/// The changes that the bench prints.
#[derive(Debug, Default)]
pub(super) struct Trace {
    reset: Vec<Change>,
    locked: Vec<Change>,
    made: Vec<Change>,
    clock: Vec<Change>,
}

impl Trace {
    /// Reads the lines of the bench. Lines of the models are skipped.
    pub(super) fn of(said: &str) -> Result<Self, ClockFault> {
        let mut trace = Self::default();
        for line in said.lines() {
            let mut words = line.split(' ');
            let list = match words.next() {
                Some("reset") => &mut trace.reset,
                Some("locked") => &mut trace.locked,
                Some("made") => &mut trace.made,
                Some("clock") => &mut trace.clock,
                _ => continue,
            };
            let time = words.next().and_then(|time| time.parse().ok());
            let level = words.next().and_then(|level| level.chars().next());
            let unread = || ClockFault::Unread { line: line.to_owned() };
            list.push(time.zip(level).ok_or_else(unread)?);
        }
        Ok(trace)
    }

    /// Judges the clock, which has a wanted frequency, Hz.
    pub(super) fn judged(&self, wanted_hz: u64) -> Result<ClockFigures, ClockFault> {
        // Until the global reset ends, the FPGA is being configured.
        let start = self.reset.iter().rfind(|(_, level)| *level == '0').map_or(0, |(at, _)| *at);
        let unknown = self.clock.iter().find(|(at, level)| *at >= start && !"01".contains(*level));
        if let Some(&(at_ps, level)) = unknown {
            return Err(ClockFault::Unknown { level, at_ps });
        }
        let edges: Vec<u64> = rising(&self.clock).collect();
        let (Some(&first), Some(&last)) = (edges.first(), edges.last()) else {
            return Err(ClockFault::TooFew { edges: 0 });
        };
        let lock = rising(&self.locked).next();
        let waited = lock.map_or(0, |lock| {
            self.made.iter().filter(|(at, _)| (lock..first).contains(at)).count()
        });
        if waited < WAIT_CLOCKS {
            return Err(ClockFault::Early { at_ps: first, clocks: waited });
        }
        let lock = lock.unwrap_or_default();
        if let Some(&(at_ps, _)) =
            self.locked.iter().find(|(at, level)| *at > lock && *level != '1')
        {
            return Err(ClockFault::Unlocked { at_ps });
        }
        if edges.len() as u64 != super::EDGES {
            return Err(ClockFault::TooFew { edges: edges.len() });
        }
        let hz = 1e12 * (edges.len() - 1) as f64 / (last - first) as f64;
        if (hz / wanted_hz as f64 - 1.0).abs() * 1e6 > MOST_OFF_PPM {
            return Err(ClockFault::Frequency { hz, wanted_hz });
        }
        // The changes from the first edge on, with the time until the next one.
        let from = self.clock.iter().position(|(at, _)| *at == first).unwrap_or_default();
        let phases = self.clock[from..].windows(2).map(|pair| (pair[0].0, pair[1].0 - pair[0].0));
        let period = 1e12 / wanted_hz as f64;
        let (mut least, mut most) = (u64::MAX, 0);
        for (at_ps, width_ps) in phases {
            if (width_ps as f64) < LEAST_PHASE * period {
                return Err(ClockFault::Short { width_ps, at_ps });
            }
            (least, most) = (least.min(width_ps), most.max(width_ps));
        }
        Ok(ClockFigures {
            hz,
            lock_ps: lock.saturating_sub(start),
            first_ps: first.saturating_sub(start),
            waited,
            phases_ps: (least, most),
        })
    }
}

/// The times at which a level becomes 1.
fn rising(changes: &[Change]) -> impl Iterator<Item = u64> {
    changes.iter().filter(|(_, level)| *level == '1').map(|(at, _)| *at)
}

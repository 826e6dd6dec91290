//! The pace of a board: how its simulated time relates to real time.

use std::time::{Duration, Instant};

/// Greatest time that a board makes up for after a delay. Its host was probably delayed too.
const BEHIND: Duration = Duration::from_millis(20);

/// Time without a byte after which a host that keeps its end of the line open is considered gone, so
/// that a board that waits for its host continues. A busy system was seen to deliver no
/// byte of any pseudo-terminal for 4.4 s.
const GONE: Duration = Duration::from_secs(15);

/// While an axis needs segments from its host, a fast board runs ahead by at most a part of what it
/// may otherwise: a host that cuts the queues keeps 20 ms of them, and a cut that comes later is
/// refused.
const PART_IN_A_MOVE: u64 = 4;

/// Decides up to which cycle a board may run.
#[derive(Debug)]
pub enum Pace {
    /// The board runs in real time.
    Real(Walk),
    /// The board runs as fast as possible, but at most `ahead` clocks beyond the last byte on the
    /// line (a quarter of them while an axis needs its host), and not further than its queues allow
    /// ([`crate::SimulatedBoard::alone`]). A delayed host is therefore not considered dead, and its
    /// delays make no segment late.
    Fast {
        /// Greatest number of clocks for which the line is idle.
        ahead: u64,
        /// Real time and cycle in which the line was busy at last, with requests or answers.
        heard: Option<(Instant, u64)>,
        /// Real-time pace for the time after the host is gone.
        alone: Walk,
    },
}

/// Converts real time to cycles.
#[derive(Debug)]
pub struct Walk {
    clock_hz: u64,
    from: (Instant, u64),
}

impl Walk {
    /// Counts from now and from this cycle.
    pub fn new(clock_hz: u64, cycle: u64) -> Self {
        Self { clock_hz, from: (Instant::now(), cycle) }
    }

    fn target(&mut self, cycle: u64) -> u64 {
        let (begin, first) = self.from;
        let target = first + self.clocks(begin.elapsed());
        if target.saturating_sub(cycle) <= self.clocks(BEHIND) {
            return target.max(cycle);
        }
        let near = cycle + self.clocks(BEHIND);
        self.from = (Instant::now(), near);
        near
    }

    fn clocks(&self, time: Duration) -> u64 {
        (time.as_nanos() * u128::from(self.clock_hz) / 1_000_000_000) as u64
    }
}

impl Pace {
    /// Real time, for a board with this clock, Hz.
    pub fn real(clock_hz: u64) -> Self {
        Self::Real(Walk::new(clock_hz, 0))
    }

    /// As fast as possible, for a board with this clock, Hz, but at most `ahead` clocks beyond the
    /// last byte on the line.
    pub fn fast(clock_hz: u64, ahead: u64) -> Self {
        Self::Fast { ahead, heard: None, alone: Walk::new(clock_hz, 0) }
    }

    /// Whether the board runs as fast as possible.
    pub const fn is_fast(&self) -> bool {
        matches!(self, Self::Fast { .. })
    }

    /// Whether a board that has reached its target goes on only behind a byte from the host. (If
    /// the host stays silent for too long, it goes on without one.)
    pub const fn needs_host(&self) -> bool {
        matches!(self, Self::Fast { heard: Some(_), .. })
    }

    /// Records that the line is busy in this cycle: a byte is on it, or an answer is being assembled.
    pub fn hear(&mut self, cycle: u64) {
        if let Self::Fast { heard, .. } = self {
            *heard = Some((Instant::now(), cycle));
        }
    }

    /// Records that no host has the line open: the board continues without one, in real time.
    pub fn lose(&mut self) {
        if let Self::Fast { heard, .. } = self {
            *heard = None;
        }
    }

    /// The cycle up to which the board may run now. It is in cycle `cycle`, and may run for `alone`
    /// clocks without its host.
    pub fn target(&mut self, cycle: u64, alone: Option<u64>) -> u64 {
        match self {
            Self::Real(walk) => walk.target(cycle),
            Self::Fast { ahead, heard, alone: walk } => match *heard {
                Some((when, at)) if when.elapsed() < GONE => {
                    *walk = Walk::new(walk.clock_hz, cycle);
                    let target = match alone {
                        None => at + *ahead,
                        Some(clocks) => {
                            (at + *ahead / PART_IN_A_MOVE).min(cycle.saturating_add(clocks))
                        }
                    };
                    target.max(cycle)
                }
                _ => walk.target(cycle),
            },
        }
    }
}

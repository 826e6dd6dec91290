//! How fast a board's time goes beside the host's.

use std::time::{Duration, Instant};

/// A board that was held up does not hurry for longer than this: its host was held up too.
const BEHIND: Duration = Duration::from_millis(20);

/// So long without a byte, and the host is no more: a board that waits for its host goes on.
const GONE: Duration = Duration::from_secs(1);

/// Which cycle a board may go to.
#[derive(Debug)]
pub enum Pace {
    /// By the clock on the wall.
    Real(Walk),
    /// As fast as it can, but never further than `ahead` clocks past the last byte from the host, nor further than its
    /// queues allow ([`crate::Gateware::alone`]): a host that is held up is not taken for dead, and its own delays make no
    /// segment late.
    Fast {
        /// Clocks.
        ahead: u64,
        /// When the host was last heard, on the wall and in cycles.
        heard: Option<(Instant, u64)>,
        /// Where the host is gone.
        alone: Walk,
    },
}

/// Cycles by the clock on the wall.
#[derive(Debug)]
pub struct Walk {
    clock_hz: u64,
    from: (Instant, u64),
}

impl Walk {
    /// From this cycle on.
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
    /// By the clock on the wall.
    pub fn real(clock_hz: u64) -> Self {
        Self::Real(Walk::new(clock_hz, 0))
    }

    /// As fast as a board of this clock can that runs at most `ahead` clocks past what it heard.
    pub fn fast(clock_hz: u64, ahead: u64) -> Self {
        Self::Fast { ahead, heard: None, alone: Walk::new(clock_hz, 0) }
    }

    /// Bytes have come from the host.
    pub fn hear(&mut self, cycle: u64) {
        if let Self::Fast { heard, .. } = self {
            *heard = Some((Instant::now(), cycle));
        }
    }

    /// The cycle to go to now, from this one; the board may go on without its host for `alone` clocks.
    pub fn target(&mut self, cycle: u64, alone: Option<u64>) -> u64 {
        match self {
            Self::Real(walk) => walk.target(cycle),
            Self::Fast { ahead, heard, alone: walk } => match *heard {
                Some((when, at)) if when.elapsed() < GONE => {
                    *walk = Walk::new(walk.clock_hz, cycle);
                    let reach = alone.map_or(u64::MAX, |clocks| cycle.saturating_add(clocks));
                    (at + *ahead).min(reach).max(cycle)
                }
                _ => walk.target(cycle),
            },
        }
    }
}

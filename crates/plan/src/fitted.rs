//! A segment of a fit in integers, before it is written: its distance, which a whole V reaches, and
//! the limits that its registers keep.

use crate::bend::Bend;
use crate::check::{speeds, start_speed};
use crate::cubic::steps;
use crate::limits::ExactLimits;
use carrystep_core::Segment;

/// One segment of a fit, in the direction of travel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fitted {
    pub ticks: u64,
    pub bend: Bend,
    /// Distance of the segment, 2^-64 step. For every segment but the last of a move it is reached
    /// exactly by one value of V.
    pub distance: i128,
}

impl Fitted {
    /// Rounds the distance to one that a whole V reaches, and that is at most `rest`. The last
    /// segment of a move (`ends`) keeps its distance; `Writer::lay` divides it later.
    pub fn whole(self, backward: bool, rest: i128, ends: bool) -> Option<Self> {
        let Self { ticks, bend, distance } = self;
        let n = i128::from(ticks);
        let bent = bend.distance(ticks)?;
        let level = distance - bent;
        // P must never be behind its ideal, in either direction of travel.
        let (down, up) = (level.div_euclid(n), -(-level).div_euclid(n));
        let v = if backward || n * up + bent > rest { down } else { up };
        Some(if ends { self } else { Self { distance: n * v + bent, ..self } })
    }

    /// Returns V times the number of ticks in steps, and A and J in steps per tick^2 and per
    /// tick^3, or `None` if they break a limit. The start speed counts only for a segment that
    /// `opens` a move; if it also steps `at once`, its V must not start at 0.
    pub fn found(&self, limits: &ExactLimits, opens: bool, at_once: bool) -> Option<[f64; 3]> {
        let &Self { ticks, bend, distance } = self;
        let Bend { a, j } = bend;
        let n = i128::from(ticks);
        let level = distance - bend.distance(ticks)?;
        let register = |x: i128| i64::try_from(x).ok();
        let (v, a64, j64) = (register(level.div_euclid(n))?, register(a)?, register(j)?);
        let segment = Segment { ticks: u32::try_from(ticks).ok()?, v, a: a64, j: j64, last: false };
        let fastest = limits.fastest();
        if !speeds(&segment).all(|v| (0..=fastest).contains(&v)) {
            return None;
        }
        if opens && at_once && v == 0 {
            return None;
        }
        if opens && start_speed(&segment, false, limits) > limits.start_speed + limits.tolerance {
            return None;
        }
        Some([steps(level), steps(a), steps(j)])
    }
}

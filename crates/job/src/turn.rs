//! DIR at reversals: set-up and hold fit between the last edge of STEP, the change of DIR and the
//! next edge.
//!
//! DIR follows the sign of V. Near a change of sign the axis is slow, and an edge can be near in time
//! only if the reversal is within about 10^-6 step of a step's place. Then P is moved by a few times
//! that much before the reversal, by the V of the segment before, and back behind it. P starts at
//! half a step (`StartPhase`), so that edges are at odd multiples of half a step.

use carrystep_core::{PinTiming, Segment, Timebase};
use carrystep_plan::exact::travel;

/// Half a step in units of 2^-64 step.
const HALF: i128 = 1 << 63;

/// Ticks around a change of sign that have to be free of edges.
pub(crate) fn quiet(pins: &PinTiming, timebase: &Timebase) -> u32 {
    let clocks = pins.dir_setup.max(pins.dir_hold).max(pins.step_high + pins.step_low);
    clocks.div_ceil(timebase.clocks_per_tick()) + 2
}

/// Two segments in succession, and where P is before them.
pub(crate) struct Pair<'a> {
    pub at: i128,
    pub before: &'a Segment,
    pub now: &'a Segment,
}

impl Pair<'_> {
    /// P at tick `t` from the start of the second segment.
    fn place(&self, t: i64) -> i128 {
        let whole = i64::from(self.before.ticks);
        if t < 0 {
            self.at + travel(self.before, (whole + t).max(0).cast_unsigned())
        } else {
            let n = t.cast_unsigned().min(self.now.ticks.into());
            self.at + travel(self.before, self.before.ticks.into()) + travel(self.now, n)
        }
    }

    /// Whether no edge is within `quiet` ticks of a change of sign of V, for the changes from
    /// `quiet` ticks before the second segment to `quiet` ticks before its end.
    pub fn is_quiet(&self, quiet: u32) -> bool {
        let quiet = i64::from(quiet);
        let end = i64::from(self.now.ticks) - quiet;
        let speed = |t: i64| self.place(t + 1) - self.place(t);
        // V in the second segment is monotonic from its start to its extreme, and from there on.
        let extreme = match self.now.j {
            0 => 0,
            j => (-i128::from(self.now.a) / i128::from(j)).clamp(0, end.max(0).into()) as i64,
        };
        let mut signs: Vec<(i64, i128)> = (-quiet..=0).map(|t| (t, speed(t).signum())).collect();
        signs.extend(
            [extreme - 1, extreme, extreme + 1, end]
                .iter()
                .filter(|t| (1..=end).contains(*t))
                .map(|&t| (t, speed(t).signum())),
        );
        signs.windows(2).all(|pair| {
            let [(mut low, sign), (mut high, other)] = [pair[0], pair[1]];
            if sign == other {
                return true;
            }
            while high - low > 1 {
                let middle = low + (high - low) / 2;
                if speed(middle).signum() == sign { low = middle } else { high = middle }
            }
            let cell = |t: i64| (self.place(t) + HALF) >> 64;
            (high - quiet..=high + quiet).all(|t| cell(t) == cell(high))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A reversal in the middle of a segment, `past` units beyond a step's place.
    fn reversal(past: i128) -> (i128, [Segment; 2]) {
        let a = -1_i64 << 24;
        let before = Segment { ticks: 4000, v: -6000 * a, a, j: 0, last: false };
        let now = Segment { v: -2000 * a, ..before };
        let far = travel(&before, 4000) + travel(&now, 2000);
        (HALF + past - far, [before, now])
    }

    #[test]
    fn edges_near_a_reversal_are_found() {
        // 20 ticks before and after the reversal, the axis is 200 |A| from it.
        for (past, quiet) in [(1 << 40, true), (100 << 24, false), (1, false), (-1, true)] {
            let (at, [before, now]) = reversal(past);
            let pair = Pair { at, before: &before, now: &now };
            assert_eq!(pair.is_quiet(20), quiet, "{past}");
        }
    }
}

//! When the pulses of a plan are due, from its integers alone.
//!
//! The gateware adds V to P in each tick and makes a step when P passes a multiple of a step. P
//! starts half a step before one. A pulse is due where the straight line from P at the start of its
//! tick to P at the end passes the multiple; the gateware places the edge at the phase before it.
//! The positions are computed by the closed form of a segment, not by adding.

use carrystep_core::Segment;

/// A step in units of P, and the half of it at which P starts.
const STEP: i128 = 1 << 64;
const HALF: i128 = 1 << 63;

/// P of one axis from segment to segment.
#[derive(Debug, Clone, Default)]
pub(crate) struct AxisDue {
    /// P at the start of the next segment, from the start of the plan, 2^-64 step.
    at: i128,
}

/// A due pulse: the tick from the start of the segment, and the place in it, from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DuePulse {
    pub tick: u32,
    pub part: f64,
}

/// V in tick `k` of a segment.
fn speed(s: &Segment, k: i128) -> i128 {
    i128::from(s.v) + k * i128::from(s.a) + k * (k - 1) / 2 * i128::from(s.j)
}

/// The distance of the first `k` ticks of a segment.
fn distance(s: &Segment, k: i128) -> i128 {
    k * i128::from(s.v)
        + k * (k - 1) / 2 * i128::from(s.a)
        + k * (k - 1) * (k - 2) / 6 * i128::from(s.j)
}

/// The first tick from `low` on, but before `high`, for which a condition that stays true holds;
/// `high` if there is none.
fn first(mut low: i128, mut high: i128, holds: impl Fn(i128) -> bool) -> i128 {
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle) { high = middle } else { low = middle + 1 }
    }
    low
}

impl AxisDue {
    /// Passes a segment; gives its pulses in order.
    pub fn pass(&mut self, segment: &Segment, mut due: impl FnMut(DuePulse)) {
        let n = i128::from(segment.ticks);
        let (a, j) = (i128::from(segment.a), i128::from(segment.j));
        // V is monotone before and behind the tick in which A changes its sign.
        let vertex = if j == 0 { n } else { (-a).div_euclid(j).clamp(0, n) };
        let mut from = 0;
        for end in [vertex, n] {
            while from < end {
                let forward = speed(segment, from) >= 0;
                let to = first(from + 1, end, |k| (speed(segment, k) >= 0) != forward);
                self.stretch(segment, from, to, &mut due);
                from = to;
            }
        }
        self.at += distance(segment, n);
    }

    /// The pulses of a stretch in which V keeps its sign.
    fn stretch(&self, s: &Segment, from: i128, to: i128, due: &mut impl FnMut(DuePulse)) {
        let place = |k: i128| self.at + HALF + distance(s, k);
        let [begin, end] = [place(from), place(to)].map(|p| p.div_euclid(STEP));
        let mut low = from;
        let mut next = |boundary: i128, passed: &dyn Fn(i128) -> bool| {
            // The end of the tick of the pulse.
            let tick = near(s, low, to, boundary - place(low), passed) - 1;
            let part = (boundary - place(tick)) as f64 / speed(s, tick) as f64;
            due(DuePulse { tick: tick as u32, part });
            low = tick;
        };
        for step in begin + 1..=end {
            let boundary = step * STEP;
            next(boundary, &|k| place(k) >= boundary);
        }
        for step in (end + 1..=begin).rev() {
            let boundary = step * STEP;
            next(boundary, &|k| place(k) < boundary);
        }
    }
}

/// The first tick after `low`, at most `to`, at whose start a boundary has been passed that is
/// `away` from the place at `low`. A guess in floats is tried first, then the ticks are halved.
fn near(s: &Segment, low: i128, to: i128, away: i128, passed: &dyn Fn(i128) -> bool) -> i128 {
    let (away, start) = (away as f64, low as f64);
    let [v, a, j] = [s.v as f64, s.a as f64, s.j as f64];
    let value = |k: f64| k * v + k * (k - 1.0) / 2.0 * a + k * (k - 1.0) * (k - 2.0) / 6.0 * j;
    let base = value(start);
    let mut k = start;
    for _ in 0..4 {
        let slope = v + (k - 0.5) * a + k * (k - 1.0) / 2.0 * j;
        k += (away - (value(k) - base)) / slope;
    }
    if k.is_finite() {
        let guess = k.ceil().clamp(start + 1.0, to as f64) as i128;
        for end in [guess, guess + 1, guess - 1] {
            if end > low && end <= to && passed(end) && (end == low + 1 || !passed(end - 1)) {
                return end;
            }
        }
    }
    first(low + 1, to, passed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The pulses by adding tick by tick, as the gateware does.
    fn added(segments: &[Segment]) -> Vec<(usize, u32)> {
        let mut p = 1_u64 << 63;
        let mut found = Vec::new();
        for (number, s) in segments.iter().enumerate() {
            let (mut v, mut a) = (s.v, s.a);
            for tick in 0..s.ticks {
                let (next, carry) = p.overflowing_add(v as u64);
                if carry != (v < 0) {
                    found.push((number, tick));
                }
                p = next;
                v = v.wrapping_add(a);
                a = a.wrapping_add(s.j);
            }
        }
        found
    }

    fn segment() -> impl Strategy<Value = Segment> {
        let top = 1_i64 << 58;
        (1..400_u32, -top..top, -top / 64..top / 64, -top / 8192..top / 8192, 0..4_u8).prop_map(
            |(ticks, v, a, j, kind)| Segment {
                ticks,
                v: if kind == 3 { 0 } else { v },
                a: if kind == 0 { 0 } else { a },
                j: if kind == 1 { 0 } else { j },
                last: false,
            },
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

        #[test]
        fn pulses_are_those_of_adding(segments in prop::collection::vec(segment(), 1..6)) {
            let mut axis = AxisDue::default();
            let mut found = Vec::new();
            for (number, segment) in segments.iter().enumerate() {
                axis.pass(segment, |due| {
                    assert!((0.0..=1.0).contains(&due.part), "{due:?}");
                    found.push((number, due.tick));
                });
            }
            prop_assert_eq!(found, added(&segments));
        }
    }
}

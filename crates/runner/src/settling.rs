//! Segments that bring P of axes at rest to its start value.

use carrystep_core::Segment;

/// Half a step in units of 2^-64 step.
pub(crate) const HALF_STEP: i128 = 1 << 63;

/// What brings P of axes that rest at these places (2^-64 step) to its start value: the segments of
/// each axis, `ticks` in all. No axis makes a step, because each stays within half a step of the whole
/// number that its position register shows.
pub fn settling(at: &[i128], ticks: u32) -> Vec<Vec<Segment>> {
    let ticks = ticks.max(1);
    let axis = |&at: &i128| {
        let whole = (at + HALF_STEP) >> 64 << 64;
        let (left, count) = (whole - at, i128::from(ticks));
        let (v, more) = (left.div_euclid(count), left.rem_euclid(count));
        // `more` ticks with one unit more, and then the others.
        let parts = [(more, v + 1), (count - more, v)];
        let parts = parts.into_iter().filter(|(ticks, _)| *ticks > 0);
        let mut segments: Vec<Segment> = parts
            .map(|(ticks, v)| Segment { ticks: ticks as u32, v: v as i64, a: 0, j: 0, last: false })
            .collect();
        segments.iter_mut().last().into_iter().for_each(|segment| segment.last = true);
        segments
    };
    at.iter().map(axis).collect()
}

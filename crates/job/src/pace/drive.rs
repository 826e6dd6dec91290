//! Rows of equal length along planned rows at given rates: samples of the planned curve, one each
//! row, and the cubic spline through them.
//!
//! ```text
//! planned    |----|----|----|----|----|----|----|----|----|     p
//! samples    x         x         x        x      x    x          one each row of equal length in t
//! spline     c    c    c    c    c    c                          acceleration without a jump
//! ```
//!
//! The spline goes through the samples ((c[k-1] + 4 c[k] + c[k+1]) / 6 is sample k), so the motors
//! are on the planned curve there. Between two samples they are off it by what a cubic cannot follow
//! where the jerk changes: at most about A h^2 / 60 for rows of h seconds, 0.3 um at 1000 mm/s^2.

use super::place::Place;
use super::rates::Rates;
use super::track::Track;
use crate::keep::REST;
use crate::row::Row;
use carrystep_core::Segment;
use carrystep_plan::exact::travel;
use std::sync::Arc;

/// Samples behind a row that its spline looks at: each counts 0.27 of the one before.
const AHEAD: usize = 14;
/// Rows that are looked at, at the least, if the rate is 1 or less behind them.
const LEAST: usize = 160;
/// Rows that are looked at, at the most.
const MOST: usize = 4096;

/// A motion between two rows that is not at its place in the plan.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    /// Planned ticks behind the beginning of the planned row.
    pub tick: f64,
    /// The control points around the place and the next one, 2^-64 step from machine zero.
    pub control: [Vec<i128>; 3],
    /// The rates that lead here, and that may go on.
    pub rates: Arc<Rates>,
    /// Ticks of a row.
    pub ticks: u32,
}

/// Where a row begins.
#[derive(Debug, Clone)]
pub(super) struct Begin {
    /// The planned row.
    pub row: u64,
    /// The first planned row whose marks have not been passed on.
    pub marked: u64,
    /// P of each motor, 2^-64 step from machine zero.
    pub at: Vec<i128>,
    /// The segments before.
    pub before: Vec<Segment>,
    /// `None` where the planned row follows as it is.
    pub motion: Option<Motion>,
}

/// Rows that follow each other, each with its beginning.
#[derive(Debug)]
pub(super) struct Driven {
    pub rows: Vec<(Row, Begin)>,
    /// Where the last one ends.
    pub end: Begin,
}

/// The three control points of the planned curve around the beginning of a row.
fn planned_control(at: &[i128], segments: &[Segment]) -> [Vec<i128>; 3] {
    let mut control = [Vec::new(), Vec::new(), Vec::new()];
    for (&at, one) in at.iter().zip(segments) {
        let [v, a, j] = [one.v, one.a, one.j].map(i128::from);
        let n = i128::from(one.ticks);
        // The polynomial that is exact at whole ticks: x' = v - a/2 + j/3 and x'' = a - j.
        let (speed, bend) = ((6 * v - 3 * a + 2 * j) * n / 6, (a - j) * n * n);
        let middle = at - bend / 6;
        let ends = [middle - speed + bend / 2, middle, middle + speed + bend / 2];
        control.iter_mut().zip(ends).for_each(|(list, point)| list.push(point));
    }
    control
}

impl Begin {
    pub fn place(&self) -> Place {
        Place { row: self.row, tick: self.motion.as_ref().map_or(0.0, |motion| motion.tick) }
    }

    /// Planned ticks per tick.
    pub fn rate(&self, track: &Track) -> f64 {
        self.motion.as_ref().map_or(1.0, |motion| self.place().rate(track, &motion.rates))
    }

    /// The control points around here, and the length of rows.
    fn control(&self, track: &Track, rests: bool) -> Option<([Vec<i128>; 3], u32)> {
        if let Some(motion) = &self.motion {
            return Some((motion.control.clone(), motion.ticks));
        }
        let row = track.row(self.row)?;
        if rests {
            return Some(([self.at.clone(), self.at.clone(), self.at.clone()], row.ticks));
        }
        Some((planned_control(&self.at, &row.segments), row.ticks))
    }
}

/// The rows from a place at these rates: to the rest where row `end` would begin if `ends` is true,
/// otherwise nearly so far. Their limits are not checked. `rests` says whether the motion rests at
/// the place.
pub(super) fn drive(
    track: &Track,
    from: &Begin,
    (end, ends): (u64, bool),
    rates: &Arc<Rates>,
    rests: bool,
) -> Option<Driven> {
    let base = from.at.clone();
    let motors = base.len();
    let (control, ticks) = from.control(track, rests)?;
    let mut places = vec![from.place()];
    loop {
        let last = places[places.len() - 1];
        let whole = last.row + if ends { 0 } else { 3 } >= end;
        let enough = places.len() > LEAST && last.rate(track, rates) <= 1.0;
        if whole || enough || places.len() > MOST {
            break;
        }
        places.push(last.later(track, rates, ticks));
    }
    let lands = places.last().is_some_and(|last| last.row >= end) && ends;
    while lands && places.len() < 4 {
        places.push(Place { row: end, tick: 0.0 });
    }
    let knots = places.len() - 1;
    if !lands && knots < AHEAD + 2 {
        return None;
    }
    let goal = track.at(end).filter(|_| lands).cloned();
    let samples: Option<Vec<Vec<f64>>> = places
        .iter()
        .map(|place| match &goal {
            Some(goal) if place.row >= end => {
                Some(goal.iter().zip(&base).map(|(goal, base)| (goal - base) as f64).collect())
            }
            _ => place.sample(track, &base),
        })
        .collect();
    let samples = samples?;
    let mut points: Vec<Vec<i128>> = Vec::with_capacity(motors);
    for motor in 0..motors {
        let known: Vec<i128> = control.iter().map(|points| points[motor]).collect();
        let second = (known[2] - base[motor]) as f64;
        let of = |knot: usize| samples[knot][motor];
        // Knots 2 to `last` are solved for.
        let last = if lands { knots - 2 } else { knots - 1 };
        let end = of(knots);
        let mut solved = tridiagonal(second, (2..=last).map(of), end);
        if lands {
            solved.push(end);
        }
        let mut list = known;
        list.extend(solved.into_iter().map(|point| base[motor] + point.round() as i128));
        if let Some(goal) = &goal {
            // At rest, three control points are one.
            list.truncate(knots);
            list.extend([goal[motor]; 3]);
        }
        points.push(list);
    }
    let count = if lands { knots } else { knots - AHEAD };
    let mut rows = Vec::with_capacity(count);
    let mut begin = Begin { motion: None, ..from.clone() };
    for knot in 0..count {
        let next = places[knot + 1];
        let lasts = if lands && knot + 1 == count { ticks + 1 } else { ticks };
        let mut segments = Vec::with_capacity(motors);
        let mut at = Vec::with_capacity(motors);
        for (list, &here) in points.iter().zip(&begin.at) {
            let four = list.get(knot..knot + 4)?;
            let segment = segment(four, here, lasts)?;
            at.push(here + travel(&segment, lasts.into()));
            segments.push(segment);
        }
        let motion = |knot: usize| Motion {
            tick: places[knot].tick,
            control: [0, 1, 2].map(|by| points.iter().map(|list| list[knot + by]).collect()),
            rates: Arc::clone(rates),
            ticks,
        };
        begin.motion = if knot == 0 && from.motion.is_none() { None } else { Some(motion(knot)) };
        // What changes where a planned row begins changes with the first row from there on. The
        // last row may begin a little before the last of these places.
        let marked = if lands && knot + 1 == count { end } else { (begin.row + 1).min(end) };
        let marked = marked.max(begin.marked);
        let row = row(track, (&begin, next.row.min(end)), segments.clone(), marked)?;
        let after = Begin { row: next.row.min(end), marked, at, before: segments, motion: None };
        rows.push((row, std::mem::replace(&mut begin, after)));
    }
    if lands {
        land(&mut rows, &mut begin, goal?)?;
        begin.row = end;
    } else {
        let knot = count;
        begin.motion = Some(Motion {
            tick: places[knot].tick,
            control: [0, 1, 2].map(|by| points.iter().map(|list| list[knot + by]).collect()),
            rates: Arc::clone(rates),
            ticks,
        });
    }
    Some(Driven { rows, end: begin })
}

/// The row of these segments from a beginning to a place: what it tells is that of the planned rows.
fn row(
    track: &Track,
    (begin, next): (&Begin, u64),
    segments: Vec<Segment>,
    marked: u64,
) -> Option<Row> {
    // A run ends with up to a row at rest.
    let first = if begin.row == next { begin.row.min(marked.saturating_sub(1)) } else { begin.row };
    let here = track.row(first)?;
    let marks = (begin.marked..marked).filter_map(|number| track.row(number));
    let marks = marks.flat_map(|row| row.marks.iter().copied()).collect();
    let passed = || (first..next.max(first + 1)).filter_map(|number| track.row(number));
    let most = |of: fn(&Row) -> f64| passed().map(of).fold(0.0, f64::max);
    Some(Row {
        ticks: segments.first()?.ticks,
        line: here.line,
        block: here.block,
        feed: passed().map(|row| row.feed).fold(f64::INFINITY, f64::min),
        off: most(|row| row.off),
        corner: most(|row| row.corner),
        marks,
        rests: false,
        segments,
    })
}

/// The segment of a cubic B-spline with these control points, where P is at `at`.
fn segment(four: &[i128], at: i128, ticks: u32) -> Option<Segment> {
    let [c0, c1, c2, c3] = four.try_into().ok()?;
    let n = i128::from(ticks);
    let (second, third): (i128, i128) = (c2 - 2 * c1 + c0, c3 - 3 * c2 + 3 * c1 - c0);
    let j = i64::try_from(third / (n * n * n)).ok()?;
    let a = i64::try_from((second.checked_mul(n)? + third) / (n * n * n)).ok()?;
    let bent = travel(&Segment { a, j, ticks, ..REST }, ticks.into());
    let goal = (c1 + 4 * c2 + c3).div_euclid(6);
    let v = i64::try_from((goal - at - bent + n / 2).div_euclid(n)).ok()?;
    Some(Segment { ticks, v, a, j, last: false })
}

/// Brings the last row exactly to its goal: its length and that of the row before differ by one.
fn land(rows: &mut [(Row, Begin)], end: &mut Begin, goal: Vec<i128>) -> Option<()> {
    let [.., (before, _), (last, begin)] = rows else { return None };
    let motors = before.segments.iter_mut().zip(&mut last.segments).zip(&mut begin.at);
    for (((before, last), at), (goal, end)) in motors.zip(goal.iter().zip(&end.at)) {
        let rest = goal - end;
        before.v = i64::try_from(i128::from(before.v) - rest).ok()?;
        last.v = i64::try_from(i128::from(last.v) + rest).ok()?;
        *at -= rest * i128::from(before.ticks);
    }
    last.rests = true;
    begin.before.clone_from(&before.segments);
    end.before.clone_from(&last.segments);
    end.at = goal;
    Some(())
}

/// Points so that point i - 1, 4 times point i and point i + 1 are 6 times each value; the points
/// before and behind them are known.
fn tridiagonal(before: f64, values: impl Iterator<Item = f64>, after: f64) -> Vec<f64> {
    let mut right: Vec<f64> = values.map(|value| 6.0 * value).collect();
    let count = right.len();
    if let Some(first) = right.first_mut() {
        *first -= before;
    }
    if let Some(last) = right.last_mut() {
        *last -= after;
    }
    let mut factors = Vec::with_capacity(count);
    let (mut factor, mut sum) = (0.0, 0.0);
    for value in &mut right {
        let pivot = 4.0 - factor;
        factor = 1.0 / pivot;
        sum = (*value - sum) / pivot;
        *value = sum;
        factors.push(factor);
    }
    for index in (1..count).rev() {
        right[index - 1] -= factors[index - 1] * right[index];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_points_give_the_values() {
        let values: Vec<f64> = (0..30).map(|k| f64::from(k * k % 17)).collect();
        let found = tridiagonal(3.0, values.iter().copied(), 5.0);
        let all = [vec![3.0], found, vec![5.0]].concat();
        for (three, value) in all.windows(3).zip(values) {
            assert!((three[0] + 4.0 * three[1] + three[2] - 6.0 * value).abs() < 1e-9);
        }
    }
}

//! The rows of a transition: from a time law to segments that land exactly.
//!
//! A re-timed row ends where a planned one does, and between such places where it would be much
//! longer than the planned one. Each of its segments is the cubic of Hermite between two samples of
//! the re-timed motion.

use super::curve::{Curve, CurvePlace, Sample, between};
use super::law::Law;
use crate::row::Row;
use carrystep_plan::exact::travel;

/// The rows of a transition between two planned ticks, of at most twice `longest` ticks; `None` if
/// there are none of such lengths. Their limits are not checked.
pub(super) fn rows(
    curve: &Curve<'_>,
    (begin, end): (u64, u64),
    law: Law,
    longest: u32,
) -> Option<Vec<Row>> {
    let ends = ends(curve, (begin, end), law, longest)?;
    let first = curve.place(begin);
    let mut at = curve.at(first);
    let sample = |tick: u64| -> Vec<Sample> {
        let rate = law.rate(tick as f64);
        let mut samples = curve.sample(begin as f64 + law.planned(tick as f64));
        samples.iter_mut().for_each(|sample| sample.speed *= rate);
        samples
    };
    let (mut before, mut now) = (0, sample(0));
    let mut rows = Vec::with_capacity(ends.len());
    let mut source = first.row;
    for (number, &tick) in ends.iter().enumerate() {
        let ticks = (tick - before) as u32;
        let mut next = sample(tick);
        if number + 1 == ends.len() {
            let exact = curve.at(curve.place(end));
            next.iter_mut().zip(exact).for_each(|(next, at)| next.at = at);
        }
        let mut segments = Vec::with_capacity(at.len());
        for ((at, &from), &to) in at.iter_mut().zip(&now).zip(&next) {
            let segment = between(*at, ticks, from, to)?;
            *at += travel(&segment, ticks.into());
            segments.push(segment);
        }
        let planned = begin + law.planned(before as f64).round() as u64;
        let here = curve.place(planned).row.min(curve.rows().len() - 1);
        // What changes where a planned row begins, changes with the first row from there on. The
        // last row may begin a little before the last of these places.
        let since = if number == 0 && first.tick == 0 { source } else { source + 1 };
        let last = number + 1 == ends.len();
        let until = if last { curve.place(end - 1).row } else { here };
        let marks = curve.rows().get(since..=until).unwrap_or_default();
        let marks = marks.iter().flat_map(|row| row.marks.iter().copied()).collect();
        source = source.max(until);
        let &Row { line, block, feed, off, corner, .. } = &curve.rows()[here];
        let ends = curve.rows().get(until).is_some_and(|row| row.rests);
        let rests = last && (law.rests() || ends);
        rows.push(Row { ticks, segments, line, block, feed, off, corner, marks, rests });
        (before, now) = (tick, next);
    }
    land(&mut rows, &at, &curve.at(curve.place(end)))?;
    // A resumption may lead to the end of the plan, where the moves of the motors end.
    let end_of_plan = curve.rows().last().filter(|_| end == curve.ticks());
    if let (Some(row), Some(planned)) = (rows.last_mut(), end_of_plan) {
        let motors = row.segments.iter_mut().zip(&planned.segments);
        motors.for_each(|(segment, planned)| segment.last = planned.last);
    }
    Some(rows)
}

/// The ends of the rows of a transition, ticks from its beginning: where the planned rows end,
/// and between them, so that the rows are nearly as short as the planned ones. The last two rows
/// have lengths without a common divisor ([`land`]).
fn ends(curve: &Curve<'_>, (begin, end): (u64, u64), law: Law, longest: u32) -> Option<Vec<u64>> {
    let first = curve.place(begin).row;
    let mut planned = curve.ticks_to(CurvePlace { row: first, tick: 0 });
    let mut corners = Vec::new();
    for row in &curve.rows()[first..] {
        planned += u64::from(row.ticks);
        if planned >= end {
            corners.push((law.ticks(), row.ticks));
            break;
        }
        corners.push((law.tick_of(planned - begin), row.ticks));
    }
    let (mut ends, mut before) = (Vec::new(), 0);
    for (corner, planned) in corners {
        let length = corner.checked_sub(before).filter(|&length| length > 0)?;
        // None is shorter than the planned one: the line may carry no more rows a second than those.
        let pieces = (length / u64::from(planned)).max(length.div_ceil(2 * u64::from(longest)));
        let is_all = ends.is_empty() && corner == law.ticks();
        let pieces = if is_all { pieces.max(2) } else { pieces };
        ends.extend((1..=pieces).map(|piece| before + length * piece / pieces));
        before = corner;
    }
    let [.., earlier, _] = ends[..] else { return None };
    let third = ends.len().checked_sub(3).map_or(0, |at| ends[at]);
    let lengths = |middle: u64| [middle - third, law.ticks() - middle];
    let middle = (0..64).find_map(|by| {
        let middle = earlier.checked_sub(by).filter(|&middle| middle > third)?;
        let [a, b] = lengths(middle);
        inverse(a.into(), b.into()).map(|_| middle)
    })?;
    let place = ends.len() - 2;
    ends[place] = middle;
    Some(ends)
}

/// Brings the last row exactly to `goal`, where `at` is P after it: takes from its V and adds to the
/// V of the row before. Their lengths m and n have no common divisor, so some x m + y n are what is
/// left, with x and y of at most n and m units.
fn land(rows: &mut [Row], at: &[i128], goal: &[i128]) -> Option<()> {
    let [.., before, last] = rows else { return None };
    let (m, n) = (i128::from(before.ticks), i128::from(last.ticks));
    let inverse = inverse(m, n)?;
    let motors = before.segments.iter_mut().zip(&mut last.segments).zip(at.iter().zip(goal));
    for ((before, last), (at, goal)) in motors {
        let left = goal - at;
        let x = (left % n * inverse).rem_euclid(n);
        let y = (left - x * m) / n;
        before.v = before.v.checked_add(i64::try_from(x).ok()?)?;
        last.v = last.v.checked_add(i64::try_from(y).ok()?)?;
    }
    Some(())
}

/// The number x below n with x m = 1 modulo n, after Euclid; `None` if m and n have a common
/// divisor.
fn inverse(m: i128, n: i128) -> Option<i128> {
    let (mut a, mut b, mut x, mut y) = (m.rem_euclid(n), n, 1, 0);
    while a > 1 {
        if b == 0 {
            return None;
        }
        (a, b, x, y) = (b, a % b, y, x - a / b * y);
    }
    (a == 1 || n == 1).then(|| x.rem_euclid(n))
}

#[cfg(test)]
mod tests {
    use super::inverse;

    #[test]
    fn inverse_times_its_number_is_one() {
        for n in 1..60 {
            for m in 1..60 {
                match inverse(m, n) {
                    Some(x) => assert_eq!((x * m).rem_euclid(n), 1 % n, "{m} {n}"),
                    None => assert!((2..=n).any(|d| m % d == 0 && n % d == 0), "{m} {n}"),
                }
            }
        }
    }
}

//! Planned rows as a curve over planned time: exact at whole ticks, and as floats between them.

use crate::keep::REST;
use crate::row::Row;
use carrystep_core::Segment;
use carrystep_plan::exact::travel;

/// Rows of a plan, one after the other, and where the motors are.
#[derive(Debug, Clone)]
pub struct Curve<'a> {
    rows: &'a [Row],
    /// For each row, and for the end of the last one: ticks from the beginning of the curve, and P
    /// of each motor, 2^-64 step from machine zero.
    begins: Vec<(u64, Vec<i128>)>,
}

/// A place on a curve: a row, and ticks from its beginning, at most its length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CurvePlace {
    /// Number of the row.
    pub row: usize,
    /// Ticks from the beginning of the row.
    pub tick: u64,
}

/// Where a motor is on a curve, and how fast.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    /// P from machine zero, 2^-64 step.
    pub at: i128,
    /// Speed per planned tick, 2^-64 step.
    pub speed: f64,
}

impl<'a> Curve<'a> {
    /// The curve of these rows, which begin where P of each motor is `at`, 2^-64 step from machine
    /// zero.
    pub fn new(rows: &'a [Row], at: &[i128]) -> Self {
        let mut begins = vec![(0, at.to_vec())];
        for row in rows {
            let (ticks, at) = &begins[begins.len() - 1];
            let motors = at.iter().zip(&row.segments);
            let end = motors.map(|(at, segment)| at + travel(segment, segment.ticks.into()));
            let end = (ticks + u64::from(row.ticks), end.collect());
            begins.push(end);
        }
        Self { rows, begins }
    }

    /// The rows.
    pub fn rows(&self) -> &'a [Row] {
        self.rows
    }

    /// The length of all rows, ticks.
    pub(crate) fn ticks(&self) -> u64 {
        self.begins[self.rows.len()].0
    }

    /// The ticks from the beginning of the curve to a place.
    pub(crate) fn ticks_to(&self, place: CurvePlace) -> u64 {
        self.begins[place.row.min(self.rows.len())].0 + place.tick
    }

    /// The place so many ticks from the beginning: of two rows that meet there, in the second one.
    pub(crate) fn place(&self, ticks: u64) -> CurvePlace {
        let row = self.begins.partition_point(|&(begin, _)| begin <= ticks) - 1;
        CurvePlace { row, tick: ticks - self.begins[row].0 }
    }

    /// The segments of a row, one a motor; at rest where there is no such row.
    pub(crate) fn segments(&self, row: Option<usize>) -> Vec<Segment> {
        let row = row.and_then(|row| self.rows.get(row));
        row.map_or_else(|| vec![REST; self.begins[0].1.len()], |row| row.segments.clone())
    }

    /// P of each motor at a place, exactly.
    pub fn at(&self, place: CurvePlace) -> Vec<i128> {
        let at = &self.begins[place.row.min(self.rows.len())].1;
        let segments = self.segments(Some(place.row));
        at.iter().zip(segments).map(|(at, segment)| at + travel(&segment, place.tick)).collect()
    }

    /// Each motor `ticks` planned ticks from the beginning.
    pub(crate) fn sample(&self, ticks: f64) -> Vec<Sample> {
        let CurvePlace { row, .. } = self.place(ticks.max(0.0) as u64);
        let (begin, at) = &self.begins[row];
        let within = ticks - *begin as f64;
        let segments = self.rows.get(row).map_or(&[][..], |row| &row.segments);
        let segments = segments.iter().chain(std::iter::repeat(&REST));
        at.iter().zip(segments).map(|(&at, segment)| of_segment(at, segment, within)).collect()
    }
}

/// A motor at `n` ticks, which need not be whole, from the beginning of a segment that begins at
/// `at`: the polynomial that is exact at whole ticks.
fn of_segment(at: i128, segment: &Segment, n: f64) -> Sample {
    let [v, a, j] = [segment.v, segment.a, segment.j].map(|value| value as f64);
    let travelled = n * (v + (n - 1.0) / 2.0 * (a + (n - 2.0) / 3.0 * j));
    let speed = v + (2.0 * n - 1.0) / 2.0 * a + (3.0 * n * n - 6.0 * n + 2.0) / 6.0 * j;
    Sample { at: at + travelled.round() as i128, speed }
}

/// The segment of so many ticks between two samples in real time, whose speeds are per tick: the
/// cubic of Hermite. P is at `at` at its beginning, to within rounding, and ends within half of its
/// ticks of the second sample, units of 2^-64 step.
pub(crate) fn between(at: i128, ticks: u32, from: Sample, to: Sample) -> Option<Segment> {
    let n = f64::from(ticks);
    let way = (to.at - from.at) as f64;
    let second = (3.0 * way - (2.0 * from.speed + to.speed) * n) / (n * n);
    let third = ((from.speed + to.speed) * n - 2.0 * way) / (n * n * n);
    let register = |value: f64| (value.abs() < 9e18).then_some(value.round() as i64);
    let j = register(6.0 * third)?;
    let a = register(2.0 * second + 6.0 * third)?;
    let bent = travel(&Segment { ticks, v: 0, a, j, last: false }, ticks.into());
    let n = i128::from(ticks);
    let v = i64::try_from((to.at - at - bent + n / 2).div_euclid(n)).ok()?;
    Some(Segment { ticks, v, a, j, last: false })
}

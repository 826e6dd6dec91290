//! One row with the figures that the page and the causes need.

use crate::axis::AxisSetup;
use crate::bound::{Bound, Parts, bound};
use crate::motion::Motion;
use carrystep_core::Segment;
use carrystep_plan::exact::{speeds, travel};

/// 2^64, the units of a step.
const STEP: f64 = 18_446_744_073_709_551_616.0;
/// Speeds below this part of a limit are a rest at the end of a run.
const STILL: f64 = 1e-6;

/// A row of segments and what it does.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    pub ticks: u32,
    pub segments: Vec<Segment>,
    /// Line of the program, or number of the move.
    pub line: u64,
    pub bound: Bound,
    /// Speed along the path at the start, in the middle and at the end, units/s.
    pub speed: [f64; 3],
    /// Whether all axes are at rest at its end.
    pub ends_at_rest: bool,
    /// The place at its end, units.
    pub place: Vec<f64>,
    /// How far the motion may be from the straight line between its ends, units.
    pub bow: f64,
    /// The greatest distance from the path as a part of the tolerance.
    pub off: f64,
}

/// Makes frames of rows, one after the other.
#[derive(Debug, Clone)]
pub(crate) struct Frames {
    axes: Vec<AxisSetup>,
    /// For each axis the factor from V, A and J to its own unit and seconds.
    scale: Vec<[f64; 3]>,
    tick_seconds: f64,
    /// Distance of each axis from its start, 2^-64 step.
    distance: Vec<i128>,
}

impl Frames {
    pub fn new(axes: Vec<AxisSetup>, tick_seconds: f64) -> Self {
        let scale = axes.iter().map(|axis| {
            let unit = 1.0 / STEP / axis.steps_per_unit;
            [1, 2, 3].map(|power| unit / tick_seconds.powi(power))
        });
        let (scale, distance) = (scale.collect(), vec![0; axes.len()]);
        Self { axes, scale, tick_seconds, distance }
    }

    pub fn axes(&self) -> &[AxisSetup] {
        &self.axes
    }

    /// For each axis the factors from V, A and J to its own unit and seconds.
    pub fn scale(&self) -> &[[f64; 3]] {
        &self.scale
    }

    pub fn tick_seconds(&self) -> f64 {
        self.tick_seconds
    }

    /// The frame of the next row.
    pub fn frame(&mut self, motion: &Motion<'_>) -> Frame {
        let Motion { ticks, segments, line, feed, given, off, corner } = *motion;
        let count = self.axes.len().min(segments.len());
        let mut parts = Parts { given, off, corner, rests: true, ..Parts::default() };
        // Speed and acceleration of each axis at the start, in the middle and at the end.
        let (mut v, mut a) = (vec![[0.0; 3]; count], vec![0.0; count]);
        let (mut place, mut ends_at_rest, mut bow) = (Vec::with_capacity(count), true, 0.0);
        let last = ticks.saturating_sub(1);
        for (i, segment) in segments.iter().take(count).enumerate() {
            let (axis, [of_v, of_a, of_j]) = (&self.axes[i], self.scale[i]);
            parts.rests &= segment.v == 0 && segment.a == 0 && segment.j == 0;
            let at = |k: u32| {
                let (k, j) = (f64::from(k), segment.j as f64);
                let pairs = k * (k - 1.0) / 2.0;
                (segment.v as f64 + k * segment.a as f64 + pairs * j, segment.a as f64 + k * j)
            };
            v[i] = [0, last / 2, last].map(|k| at(k).0 * of_v);
            let ends = [0, last].map(|k| at(k).1 * of_a);
            a[i] = (ends[0] + ends[1]) / 2.0;
            let most = ends[0].abs().max(ends[1].abs());
            let fastest = speeds(segment).map(i128::unsigned_abs).max().unwrap_or(0) as f64 * of_v;
            let [speed, acceleration, jerk] = axis.limits;
            let greater = |known: &mut (f64, usize), found: f64, limit: Option<f64>| {
                let part = limit.map_or(0.0, |limit| found / limit);
                if part > known.0 {
                    *known = (part, i);
                }
            };
            greater(&mut parts.speed, fastest, speed);
            greater(&mut parts.acceleration, a[i].abs(), acceleration);
            greater(&mut parts.jerk, (segment.j as f64 * of_j).abs(), jerk);
            ends_at_rest &= v[i][2].abs() <= STILL * speed.unwrap_or(f64::INFINITY);
            self.distance[i] += travel(segment, ticks.into());
            place.push(axis.start + self.distance[i] as f64 / STEP / axis.steps_per_unit);
            if axis.linear {
                let seconds = f64::from(ticks) * self.tick_seconds;
                bow += (axis.counts * most * seconds * seconds / 8.0).powi(2);
            }
        }
        let linear = (0..count).any(|i| self.axes[i].linear && v[i] != [0.0; 3]);
        let counts = |i: &usize| self.axes[*i].linear == linear;
        let square = |i: usize| self.axes[i].counts * self.axes[i].counts;
        let norm = |of: &dyn Fn(usize) -> f64| {
            (0..count).filter(counts).map(|i| square(i) * of(i) * of(i)).sum::<f64>().sqrt()
        };
        let speed = [0, 1, 2].map(|k| norm(&|i| v[i][k]));
        parts.feed = speed[1] / feed;
        let along = (0..count).filter(counts).map(|i| square(i) * v[i][1] * a[i]).sum::<f64>();
        let along = along / speed[1];
        let all = norm(&|i| a[i]);
        parts.turns = along.is_finite() && 2.0 * along * along <= all * all;
        let bound = bound(&parts);
        let segments = segments[..count].to_vec();
        let bow = f64::sqrt(bow);
        Frame { ticks, segments, line, bound, speed, ends_at_rest, place, bow, off }
    }
}

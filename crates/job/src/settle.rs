//! The last stage of planning in floats: a speed law whose emitted curve is known to keep the
//! limits and the tolerance.
//!
//! The stage samples the curve as `retime.rs` does, filters the samples, and measures what the
//! hardware would do. Where a limit is exceeded, it makes the motion slower there; where the
//! tolerance is exceeded, it moves the curve towards the path. Then it plans the window again. Each
//! window ends at rest in its plan; if no plan of a window is good, the motion goes on with the
//! plan of the window before to that rest.

use crate::filter::Filter;
use crate::inspect::{Fault, Inspector};
use crate::path::Path;
use crate::rough::Knot;
use crate::smooth::RESTING;
use crate::speed::{Grid, Instant, MARGIN, Rules, fastest, reachable, sampled};
use crate::vector::{Point, plus};
use std::collections::VecDeque;

/// Intervals that are passed in one block.
const BLOCK: usize = 192;
/// Most plans of one window before the motion stops instead.
const TRIES: usize = 40;
/// Knots on both sides of a fault that are made slower.
const AROUND: f64 = 3.0;

/// Plans of a window in which a distance from the path only changes the curve; after them the
/// motion also gets slower there.
const SHAPE_TRIES: usize = 6;
/// Control points from the start of a window on that belong to what has been passed.
const PASSED: usize = MARGIN + 2;
/// Control points behind the rest at the end of a plan: the curve before it can still be moved.
const TAIL: usize = 8;
/// Plans of a window after which the speed law may use more of the limits.
const BOOSTS: usize = 2;
/// Least x and least part of a limit: a motion that is still wrong then is given up.
const SLOWEST: f64 = 0.004;
/// How far the curve is moved, as a part of what it is beyond the tolerance.
const MOVE: f64 = 1.3;
/// How much further within the tolerance the curve is moved, as a part of it: the next plan passes
/// the same place at another time, and its curve differs a little.
const ROOM: f64 = 0.03;
/// Weights of the control points around a fault when the curve is moved.
const BUMP: [f64; 5] = [0.25, 0.75, 1.0, 0.75, 0.25];

/// How much slower than the limits allow the motion is at one grid point.
#[derive(Debug, Clone, Copy)]
struct Ease {
    part: f64,
    most: f64,
}

const NONE: Ease = Ease { part: 1.0, most: f64::INFINITY };

/// No plan of the first window of a run keeps limits and tolerance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stuck {
    pub line: u64,
}

#[derive(Debug)]
pub(crate) struct Settle<const N: usize> {
    rules: Rules<N>,
    ahead: usize,
    buffer: VecDeque<Knot<N>>,
    ease: VecDeque<Ease>,
    x: f64,
    next: f64,
    /// The good plan of the window before, from the first grid point on: x at each.
    stop: Option<Vec<f64>>,
    inspector: Inspector<N>,
    filter: Filter<N>,
    /// Half the length of a filter over more than two samples, knots.
    spread: f64,
}

/// A point of the emitted curve: a control point, with its place on the path.
pub(crate) type Emitted<const N: usize> = Knot<N>;

impl<const N: usize> Settle<N> {
    pub fn new(rules: Rules<N>, ahead: usize, average: usize) -> Self {
        let inspector = Inspector::new(rules.motors.clone(), rules.knot_seconds);
        Self {
            rules,
            ahead,
            buffer: VecDeque::new(),
            ease: VecDeque::new(),
            x: f64::INFINITY,
            next: 0.0,
            stop: None,
            inspector,
            filter: Filter::new(average),
            spread: if average > 2 { average as f64 / 2.0 + 1.0 } else { 0.0 },
        }
    }

    /// Adds the next control point of the smoothed curve.
    pub fn push(
        &mut self,
        knot: Knot<N>,
        path: &Path<N>,
        out: &mut Vec<Emitted<N>>,
    ) -> Result<(), Stuck> {
        if self.buffer.is_empty() {
            self.buffer.push_back(knot);
            self.filter.rest(knot);
            self.inspector.rest(knot);
        }
        self.buffer.push_back(knot);
        while self.buffer.len() >= BLOCK + self.ahead + 2 * MARGIN + TAIL {
            self.advance(false, path, out)?;
        }
        Ok(())
    }

    /// The run ends at rest at the last control point.
    pub fn finish(&mut self, path: &Path<N>, out: &mut Vec<Emitted<N>>) -> Result<(), Stuck> {
        if let Some(&last) = self.buffer.back() {
            self.buffer.push_back(last);
            while self.buffer.len() > 2 * MARGIN + 1 {
                self.advance(true, path, out)?;
            }
            let rest: Vec<Instant<N>> = self.filter.settling(last);
            self.emit(&rest, path, out);
        }
        self.buffer.clear();
        self.ease.clear();
        self.x = f64::INFINITY;
        self.next = 0.0;
        self.stop = None;
        Ok(())
    }

    /// Passes one block, or in the last window all of it, or the rest of the plan before.
    fn advance(
        &mut self,
        end: bool,
        path: &Path<N>,
        out: &mut Vec<Emitted<N>>,
    ) -> Result<(), Stuck> {
        let mut c: Vec<Knot<N>> = self.buffer.iter().copied().collect();
        let seen = if end { c.len() } else { c.len() - TAIL };
        let count = seen - 2 * MARGIN;
        self.ease.resize(count, NONE);
        let mut plain = self.rules.grid(&c[..seen], path);
        for attempt in 0..TRIES {
            let speeds = self.speeds(&plain, end);
            let (samples, _) = sampled(&c, &speeds, self.next);
            let (faults, used) = self.faults(&samples, &c[..seen], path);
            let boosts = if self.spread > 0.0 { 0 } else { BOOSTS };
            if attempt < boosts {
                self.speed_up(&used);
            }
            if faults.is_empty() && attempt >= boosts {
                let upto = if end { count - 1 } else { BLOCK };
                self.buffer = c.into();
                self.pass(&speeds, upto, path, out);
                self.stop = Some(speeds[upto..].to_vec());
                return Ok(());
            }
            for (number, fault) in faults.iter().enumerate() {
                let Some(off) = fault.off else {
                    self.slow_down(fault, &speeds);
                    continue;
                };
                let greater = |other: &Fault<N>| {
                    other.off.is_some()
                        && (other.u - fault.u).abs() < AROUND
                        && other.excess > fault.excess
                };
                let near = &faults[number.saturating_sub(8)..faults.len().min(number + 9)];
                if !near.iter().any(greater) {
                    move_back(&mut c, fault, &off);
                }
                if attempt >= SHAPE_TRIES {
                    self.slow_down(fault, &speeds);
                }
            }
            plain = self.rules.grid(&c[..seen], path);
        }
        let Some(speeds) = self.stop.take() else {
            let line = path.piece(c[MARGIN].place.piece).map_or(0, |piece| piece.line);
            return Err(Stuck { line });
        };
        self.pass(&speeds, speeds.len() - 1, path, out);
        self.ease.clear();
        Ok(())
    }

    fn speeds(&self, plain: &[Grid<N>], end: bool) -> Vec<f64> {
        let grid: Vec<Grid<N>> = plain
            .iter()
            .zip(&self.ease)
            .map(|(grid, ease)| grid.eased(ease.part, ease.most))
            .collect();
        let reach = reachable(&grid, if end { f64::INFINITY } else { 0.0 });
        let mut speeds = fastest(&grid, &reach, self.x);
        // The motion cannot start the window slower than it is.
        speeds[0] = if self.x.is_finite() { self.x } else { speeds[0] };
        speeds
    }

    /// What the hardware would do wrong with these samples and a rest behind them.
    fn faults(
        &self,
        samples: &[Instant<N>],
        c: &[Knot<N>],
        path: &Path<N>,
    ) -> (Vec<Fault<N>>, Vec<(f64, f64)>) {
        let mut filter = self.filter.clone();
        let mut inspector = self.inspector.clone();
        let (mut faults, mut used) = (Vec::new(), Vec::new());
        // The last window ends at the last grid point, and so does every plan.
        let last = Instant {
            knot: Knot {
                point: crate::spline::value(
                    &std::array::from_fn::<_, 4, _>(|i| c[c.len() - 2 * MARGIN + i].point),
                    0.0,
                ),
                place: c[c.len() - 1 - MARGIN].place,
            },
            u: (c.len() - 1 - 2 * MARGIN) as f64,
            ahead: c[c.len() - 1].place,
        };
        let mut rest = filter.settling(last.knot);
        rest.fill(last);
        for instant in samples.iter().chain(&rest) {
            let emitted = filter.push(instant);
            faults.extend(inspector.push(&emitted, path));
            used.push(inspector.accelerated());
        }
        (faults, used)
    }

    /// Where the filter leaves a part of the acceleration limit unused, the speed law may use more.
    fn speed_up(&mut self, used: &[(f64, f64)]) {
        let mut most = vec![0.0_f64; self.ease.len()];
        for &(u, part) in used {
            let middle = u.max(0.0).round() as usize;
            let range = middle.saturating_sub(2).min(most.len())..(middle + 3).min(most.len());
            most[range].iter_mut().for_each(|most| *most = most.max(part));
        }
        for (ease, most) in self.ease.iter_mut().zip(most) {
            ease.part *= (0.99 / most.max(0.5)).clamp(1.0, 1.06);
            ease.part = ease.part.min(1.25);
        }
    }

    fn slow_down(&mut self, fault: &Fault<N>, speeds: &[f64]) {
        // A limit depends on all samples of the filter.
        let around = AROUND + if fault.off.is_none() { self.spread } else { 0.0 };
        let first = (fault.u - around).floor().max(0.0) as usize;
        let last = ((fault.u + around).ceil().max(0.0) as usize).min(self.ease.len() - 1);
        for (ease, x) in self.ease.range_mut(first.min(last)..=last).zip(&speeds[first.min(last)..])
        {
            if fault.off.is_none() {
                ease.part = (ease.part * (0.99 / fault.excess).max(0.8)).max(SLOWEST);
            } else {
                let slower = x * (1.0 / fault.excess).clamp(0.7, 0.95);
                ease.most = ease.most.min(slower.max(SLOWEST));
            }
        }
    }

    /// The motion goes on with these x up to a grid point.
    fn pass(&mut self, speeds: &[f64], upto: usize, path: &Path<N>, out: &mut Vec<Emitted<N>>) {
        let (samples, next) = sampled(self.buffer.make_contiguous(), &speeds[..=upto], self.next);
        self.emit(&samples, path, out);
        self.next = next;
        self.x = speeds[upto];
        self.buffer.drain(..upto);
        self.ease.drain(..upto);
        self.filter.rebase(upto as f64);
        self.inspector.rebase(upto as f64);
    }

    fn emit(&mut self, samples: &[Instant<N>], path: &Path<N>, out: &mut Vec<Emitted<N>>) {
        for instant in samples {
            let emitted = self.filter.push(instant);
            // What has been found good is measured again only to go on from there.
            drop(self.inspector.push(&emitted, path));
            out.push(Knot { place: self.inspector.place(), ..emitted.knot });
        }
    }
}

/// Moves the control points around a fault towards the path.
fn move_back<const N: usize>(c: &mut [Knot<N>], fault: &Fault<N>, off: &Point<N>) {
    let middle = (fault.u.max(0.0).round() as usize) + MARGIN;
    // The last ones may be those where the run comes to rest.
    let resting = RESTING + 1;
    let part = -MOVE * (1.0 - (1.0 - ROOM) / fault.excess);
    for (k, weight) in BUMP.iter().enumerate() {
        let Some(index) = (middle + k).checked_sub(BUMP.len() / 2) else { continue };
        if index >= PASSED && index + resting < c.len() {
            c[index].point = plus(&c[index].point, part * weight, off);
        }
    }
}

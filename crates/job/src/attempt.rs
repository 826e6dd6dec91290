//! Plans of one window of the last stage: each is measured as the hardware would run it, and the
//! next one is slower or nearer to the path where a limit or the tolerance is exceeded.

use crate::emitted::Emitted;
use crate::filter::Filter;
use crate::inspect::{Depth, Fault, Inspector};
use crate::path::Path;
use crate::rough::Knot;
use crate::smooth::RESTING;
use crate::speed::{Grid, Instant, MARGIN, Rules, fastest, reachable, sampled};
use crate::spline::value;
use crate::vector::{Point, plus};

/// Most plans of one window.
const TRIES: usize = 40;
/// Plans of a window in which a distance from the path only changes the curve; after them the
/// motion also gets slower there.
const SHAPE_TRIES: usize = 6;
/// Plans of a window after which the speed law may use more of the limits.
const BOOSTS: usize = 2;
/// Knots on both sides of a fault that are made slower.
const AROUND: f64 = 3.0;
/// Control points from the start of a window on that belong to what has been passed.
const PASSED: usize = MARGIN + 2;
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
pub(crate) struct Ease {
    part: f64,
    most: f64,
}

pub(crate) const NONE: Ease = Ease { part: 1.0, most: f64::INFINITY };

/// One window: its control points, and how the motion begins.
pub(crate) struct Window<'a, const N: usize> {
    pub rules: &'a Rules<N>,
    pub path: &'a Path<N>,
    pub filter: &'a Filter<N>,
    pub inspector: &'a Inspector<N>,
    /// Half the length of a filter over more than two samples, knots.
    pub spread: f64,
    /// x at the first grid point, and the time from there to the next sample.
    pub x: f64,
    pub next: f64,
    /// Control points, of which the first `seen` are in the plan.
    pub c: Vec<Knot<N>>,
    pub seen: usize,
    /// The run ends with the window.
    pub end: bool,
    /// Intervals that are passed on if the plan is good; at most all of the plan.
    pub pass: usize,
    pub ease: Vec<Ease>,
}

/// A good plan, and what is passed on of it.
pub(crate) struct Plan<const N: usize> {
    /// x at each grid point.
    pub speeds: Vec<f64>,
    /// The grid point up to which it is passed on.
    pub upto: usize,
    /// The control points up to there, and the state after them.
    pub emitted: Vec<Emitted<N>>,
    pub filter: Filter<N>,
    pub inspector: Inspector<N>,
    /// The time from there to the next sample.
    pub next: f64,
}

impl<const N: usize> Window<'_, N> {
    /// A plan without a fault.
    ///
    /// # Errors
    /// The parameter of the first fault of the last plan.
    pub fn plan(&mut self) -> Result<Plan<N>, f64> {
        let mut plain = self.rules.grid(&self.c[..self.seen], self.path);
        self.ease.resize(plain.len(), NONE);
        let boosts = if self.spread > 0.0 { 0 } else { BOOSTS };
        let mut first = 0.0;
        for attempt in 0..TRIES {
            let speeds = self.speeds(&plain);
            let (samples, _) = sampled(&self.c, &speeds, self.next);
            let faults;
            if attempt >= boosts {
                match self.proved(&samples, &speeds) {
                    Ok(plan) => return Ok(plan),
                    Err(found) => faults = found,
                }
            } else {
                let used;
                (faults, used) = self.measured(&samples);
                self.speed_up(&used);
            }
            first = faults.iter().map(|fault| fault.u).fold(f64::INFINITY, f64::min);
            self.correct(&faults, &speeds, attempt >= SHAPE_TRIES);
            plain = self.rules.grid(&self.c[..self.seen], self.path);
        }
        Err(first)
    }

    /// Moves the curve where it is too far from the path, and makes the motion slower.
    fn correct(&mut self, faults: &[Fault<N>], speeds: &[f64], slower: bool) {
        for (number, fault) in faults.iter().enumerate() {
            let Some(off) = fault.off else {
                self.slow_down(fault, speeds);
                continue;
            };
            let greater = |other: &Fault<N>| {
                other.off.is_some()
                    && (other.u - fault.u).abs() < AROUND
                    && other.excess > fault.excess
            };
            let near = &faults[number.saturating_sub(8)..faults.len().min(number + 9)];
            if !near.iter().any(greater) {
                move_back(&mut self.c, fault, &off);
            }
            if slower {
                self.slow_down(fault, speeds);
            }
        }
    }

    fn speeds(&self, plain: &[Grid<N>]) -> Vec<f64> {
        let grid: Vec<Grid<N>> = plain
            .iter()
            .zip(&self.ease)
            .map(|(grid, ease)| grid.eased(ease.part, ease.most))
            .collect();
        let reach = reachable(&grid, if self.end { f64::INFINITY } else { 0.0 });
        let mut speeds = fastest(&grid, &reach, self.x);
        // The motion cannot start the window slower than it is.
        speeds[0] = if self.x.is_finite() { self.x } else { speeds[0] };
        speeds
    }

    /// The samples of a rest behind a plan.
    fn rest(&self) -> Vec<Instant<N>> {
        // The last window ends at the last grid point, and so does every plan.
        let c = &self.c[self.seen - 2 * MARGIN..self.seen];
        let knot = Knot {
            point: value(&std::array::from_fn::<_, 4, _>(|i| c[i].point), 0.0),
            place: c[1].place,
        };
        let u = (self.seen - 1 - 2 * MARGIN) as f64;
        let last = Instant { knot, u, ahead: c[2 * MARGIN - 1].place };
        let mut rest = self.filter.settling(last.knot);
        rest.fill(last);
        rest
    }

    /// What the hardware would do wrong with these samples and a rest behind them, as far as places
    /// show it, and how much of the acceleration limit it would use. While the speed law still
    /// changes, nothing needs to be proved.
    fn measured(&self, samples: &[Instant<N>]) -> (Vec<Fault<N>>, Vec<(f64, f64)>) {
        let (mut filter, mut inspector) = (self.filter.clone(), self.inspector.clone());
        let (mut faults, mut used) = (Vec::new(), Vec::new());
        for instant in samples.iter().chain(&self.rest()) {
            let emitted = filter.push(instant);
            faults.extend(inspector.push(&emitted, self.path, Depth::Places));
            used.push(inspector.accelerated());
        }
        (faults, used)
    }

    /// Proves the motion of these samples and a rest behind them.
    ///
    /// # Errors
    /// What the hardware would do wrong.
    fn proved(&self, samples: &[Instant<N>], speeds: &[f64]) -> Result<Plan<N>, Vec<Fault<N>>> {
        let upto = self.pass.min(speeds.len() - 1);
        let (first, next) = sampled(&self.c, &speeds[..=upto], self.next);
        let (mut filter, mut inspector) = (self.filter.clone(), self.inspector.clone());
        let (mut emitted, mut faults) = (Vec::with_capacity(first.len()), Vec::new());
        let mut passed = None;
        for (number, instant) in samples.iter().chain(&self.rest()).enumerate() {
            if number == first.len() {
                passed = Some((filter.clone(), inspector.clone()));
            }
            let (point, found) =
                Emitted::measured(&filter.push(instant), &mut inspector, self.path);
            faults.extend(found);
            if number < first.len() {
                emitted.push(point);
            }
        }
        if self.end && faults.is_empty() {
            faults.extend(inspector.behind(self.path));
        }
        let (filter, inspector) = passed.unwrap_or((filter, inspector));
        if faults.is_empty() {
            let speeds = speeds.to_vec();
            Ok(Plan { speeds, upto, emitted, filter, inspector, next })
        } else {
            Err(faults)
        }
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
        let last = ((fault.u + around).ceil().max(0.0) as usize).min(self.ease.len() - 1);
        let first = ((fault.u - around).floor().max(0.0) as usize).min(last);
        for (ease, x) in self.ease[first..=last].iter_mut().zip(&speeds[first..]) {
            if fault.off.is_none() {
                ease.part = (ease.part * (0.99 / fault.excess).max(0.8)).max(SLOWEST);
            } else {
                let slower = x * (1.0 / fault.excess).clamp(0.7, 0.95);
                ease.most = ease.most.min(slower.max(SLOWEST));
            }
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

//! The last stage of planning in floats: a speed law whose emitted curve is known to keep the
//! limits and the tolerance.
//!
//! The stage plans one window after the other (`attempt.rs`). The plan of each window ends at rest.
//! If no plan of a window is good, the motion goes on with the plan of the window before to that
//! rest. If no plan from rest is good, a shorter window ends before the first fault; where that is
//! too near, the motion goes to the end of the piece and stops there exactly (`halt.rs`). So every
//! path has a motion.

use crate::attempt::{Ease, NONE, Window};
use crate::emitted::{Emitted, Passed};
use crate::filter::Filter;
use crate::halt::halt;
use crate::inspect::Inspector;
use crate::path::Path;
use crate::rough::Knot;
use crate::smooth::RESTING;
use crate::speed::{Instant, MARGIN, Rules, sampled};
use crate::spline::value;
use std::collections::VecDeque;

/// Intervals that are passed in one block.
const BLOCK: usize = 192;
/// Control points behind the rest at the end of a plan: the curve before it can still be moved.
const TAIL: usize = 8;
/// A shorter window ends so many intervals before the first fault.
const BEFORE_FAULT: f64 = 8.0;
/// Fewest intervals of a shorter window.
const SHORTEST: usize = 12;
/// Most shorter windows before an exact stop.
const SHORTER: usize = 2;
/// Copies of the knot where the curve rests at the start of a window.
const START: usize = RESTING + 1;

#[derive(Debug)]
pub(crate) struct Settle<const N: usize> {
    rules: Rules<N>,
    ahead: usize,
    buffer: VecDeque<Knot<N>>,
    ease: VecDeque<Ease>,
    /// x at the first grid point, and the time from there to the next sample.
    x: f64,
    next: f64,
    /// The good plan of the window before, from the first grid point on: x at each.
    stop: Option<Vec<f64>>,
    /// Knots up to this piece have been passed by an exact stop at its end.
    halted: Option<u64>,
    inspector: Inspector<N>,
    filter: Filter<N>,
    /// Half the length of a filter over more than two samples, knots.
    spread: f64,
}

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
            halted: None,
            inspector,
            filter: Filter::new(average),
            spread: if average > 2 { average as f64 / 2.0 + 1.0 } else { 0.0 },
        }
    }

    /// The first piece on which the emitted curve may still be.
    pub fn oldest(&self) -> u64 {
        self.inspector.oldest()
    }

    /// Adds the next control point of the smoothed curve.
    pub fn push(&mut self, knot: Knot<N>, path: &Path<N>, out: &mut Vec<Emitted<N>>) {
        if self.buffer.is_empty() {
            self.begin(knot, 1);
        }
        if self.halted.is_some_and(|piece| knot.place.piece <= piece) {
            return;
        }
        self.buffer.push_back(knot);
        while self.buffer.len() >= BLOCK + self.ahead + 2 * MARGIN + TAIL {
            self.advance(false, path, out);
        }
    }

    /// The run ends at rest at the last control point.
    pub fn finish(&mut self, path: &Path<N>, out: &mut Vec<Emitted<N>>) {
        if let Some(&last) = self.buffer.back() {
            self.buffer.push_back(last);
            while self.buffer.len() > 2 * MARGIN + 1 {
                self.advance(true, path, out);
            }
            let last = self.buffer.back().copied().unwrap_or(last);
            self.emit(&self.filter.settling(last), path, out);
        }
        self.buffer.clear();
        self.ease.clear();
        self.halted = None;
    }

    /// The curve is at rest at a knot.
    fn begin(&mut self, knot: Knot<N>, copies: usize) {
        (0..copies).for_each(|_| self.buffer.push_front(knot));
        self.filter.rest(knot);
        self.inspector.rest(knot);
        self.ease.clear();
        self.x = f64::INFINITY;
        self.next = 0.0;
        self.stop = None;
    }

    /// Passes one block, or in the last window all of it, or a motion to a rest.
    fn advance(&mut self, end: bool, path: &Path<N>, out: &mut Vec<Emitted<N>>) {
        let all = if end { self.buffer.len() } else { self.buffer.len() - TAIL };
        let mut seen = all;
        for _ in 0..=SHORTER {
            let mut window = Window {
                rules: &self.rules,
                path,
                filter: &self.filter,
                inspector: &self.inspector,
                spread: self.spread,
                x: self.x,
                next: self.next,
                c: self.buffer.iter().copied().collect(),
                seen,
                end: end && seen == all,
                pass: if end || seen < all { usize::MAX } else { BLOCK },
                ease: self.ease.iter().copied().collect(),
            };
            let plan = window.plan();
            let (c, ease) = (window.c, window.ease);
            match (plan, self.stop.take()) {
                (Ok(plan), _) => {
                    self.buffer = c.into();
                    self.ease = ease.into();
                    self.stop = (seen == all).then(|| plan.speeds[plan.upto..].to_vec());
                    // What the plan has proved is passed on as it is.
                    out.extend(plan.emitted);
                    (self.filter, self.inspector) = (plan.filter, plan.inspector);
                    self.go_on(plan.upto, plan.speeds[plan.upto], plan.next);
                    return;
                }
                (Err(_), Some(speeds)) => {
                    self.pass(&speeds, speeds.len() - 1, path, out);
                    self.ease.clear();
                    return;
                }
                (Err(first), None) => {
                    self.ease.clear();
                    let count = (first - BEFORE_FAULT).max(0.0) as usize;
                    if count < SHORTEST || count + 2 * MARGIN >= seen {
                        break;
                    }
                    seen = count + 2 * MARGIN;
                }
            }
        }
        self.halt(path, out);
    }

    /// Goes from rest to the end of a piece, and rests there.
    fn halt(&mut self, path: &Path<N>, out: &mut Vec<Emitted<N>>) {
        let c: [_; 4] = std::array::from_fn(|i| self.buffer[MARGIN - 1 + i].point);
        let here = Knot { point: value(&c, 0.0), place: self.buffer[MARGIN].place };
        self.emit(&self.filter.settling(here), path, out);
        let place = self.inspector.leaving(&here.point, path);
        let motion = halt(&here.point, place, path, &self.rules.motors, self.rules.knot_seconds);
        let Some(&last) = motion.last() else { return };
        let passed = Passed::new(place.piece, place.piece, 0.0, 0.0, path);
        let rest = [last; RESTING - 1];
        out.extend(motion.iter().chain(&rest).map(|knot| Emitted { point: knot.point, passed }));
        self.halted = Some(place.piece);
        self.buffer.retain(|knot| knot.place.piece > place.piece);
        self.begin(last, START);
    }

    /// The motion goes on with these x up to a grid point.
    fn pass(&mut self, speeds: &[f64], upto: usize, path: &Path<N>, out: &mut Vec<Emitted<N>>) {
        let (samples, next) = sampled(self.buffer.make_contiguous(), &speeds[..=upto], self.next);
        self.emit(&samples, path, out);
        self.go_on(upto, speeds[upto], next);
    }

    /// The motion is at a grid point with this x, and the next sample comes so much later.
    fn go_on(&mut self, upto: usize, x: f64, next: f64) {
        (self.x, self.next) = (x, next);
        self.buffer.drain(..upto);
        self.ease.resize(self.ease.len().max(upto), NONE);
        self.ease.drain(..upto);
        self.filter.rebase(upto as f64);
        self.inspector.rebase(upto as f64);
    }

    fn emit(&mut self, samples: &[Instant<N>], path: &Path<N>, out: &mut Vec<Emitted<N>>) {
        for instant in samples {
            let emitted = self.filter.push(instant);
            // What has been found good is measured again only to go on from there.
            out.push(Emitted::measured(&emitted, &mut self.inspector, path).0);
        }
    }
}

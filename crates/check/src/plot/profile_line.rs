//! Collects the speed of the profile as a line, while its moves go by.

use crate::thin::{Point, Thin};
use carrystep_profile::{Leg, Reader, Timeline};

/// Number of stretches of time to which the line is thinned out, and of points at even times.
const STRETCHES: usize = 600;

/// The distance of the two points on both sides of a jump, as a part of the whole time.
const BESIDE: f64 = 1e-6;

/// The line of one axis.
#[derive(Debug)]
pub(super) struct ProfileLine {
    legs: Reader<Leg>,
    tick_s: f64,
    span_s: f64,
    /// The end of the last leg, s.
    end_s: f64,
    line: Thin,
}

impl ProfileLine {
    /// A line over `span_s` seconds, with ticks of `tick_s` seconds.
    pub(super) fn new(timeline: &Timeline, tick_s: f64, span_s: f64) -> Self {
        let mut line = Thin::new(span_s, STRETCHES);
        line.add((0.0, 0.0));
        Self { legs: timeline.legs(), tick_s, span_s, end_s: 0.0, line }
    }

    /// Adds the moves that begin by `tick`.
    pub(super) fn reach(&mut self, tick: u64) {
        while let Some(leg) = self.legs.next_by(tick) {
            self.add(&leg);
        }
    }

    /// Adds a move: points at even times, at the bends of the profile, and on both sides of its
    /// ends, where the speed may jump.
    fn add(&mut self, leg: &Leg) {
        let start = leg.start_tick as f64 * self.tick_s;
        let duration = leg.profile.duration();
        let beside = BESIDE * self.span_s;
        if start > self.end_s {
            self.line.add((self.end_s + beside, 0.0));
            self.line.add((start - beside, 0.0));
        }
        let inside = (duration - beside).max(0.0);
        let pitch = self.span_s / STRETCHES as f64;
        let first = (start / pitch).ceil();
        let even = (0..=STRETCHES).map(|k| (first + k as f64) * pitch - start);
        let even = even.take_while(|t| *t < inside);
        let bends = leg.profile.breakpoints().iter().copied();
        let ends = [beside.min(inside), inside];
        for t in ends.into_iter().chain(bends).chain(even) {
            self.line.add((start + t, leg.speed(t)));
        }
        self.end_s = start + duration;
    }

    /// The points of the line, in order of time.
    pub(super) fn points(&self) -> Vec<Point> {
        let rest = [self.end_s + BESIDE * self.span_s, self.span_s];
        let rest = rest.into_iter().filter(|t| *t <= self.span_s).map(|t| (t, 0.0));
        let mut points: Vec<Point> = self.line.points().chain(rest).collect();
        points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        points
    }
}

//! Ramps to and from a rest: what binds them is the stop, which is known only when the rest comes.
//!
//! A row belongs to a stop if only acceleration or jerk binds it, and
//!
//! - after a rest: it and all rows since the rest end faster than they began;
//! - before a rest: neither it nor any row up to the rest ends faster than it began.

use crate::bound::Bound;
use crate::frame::Frame;
use std::collections::VecDeque;

/// Most rows that wait for a rest; a longer slowing down keeps its own causes.
const WAITING: usize = 8192;

/// Rows on their way to those who add them up.
#[derive(Debug, Clone)]
pub(crate) struct Stops {
    /// Rows that slow down, and may end at rest.
    waiting: VecDeque<Frame>,
    /// The motion speeds up from a rest.
    rising: bool,
}

impl Stops {
    /// The motion begins at rest.
    pub fn new() -> Self {
        Self { waiting: VecDeque::new(), rising: true }
    }

    /// Adds a row, and passes on those whose cause is known.
    pub fn push(&mut self, mut frame: Frame, pass: &mut impl FnMut(Frame)) {
        let of_limits = matches!(frame.bound, Bound::Acceleration(_) | Bound::Jerk(_));
        let faster = frame.speed[2] > frame.speed[0];
        self.rising &= (of_limits && faster) || frame.bound == Bound::Stop;
        if self.rising {
            frame.bound = Bound::Stop;
        }
        if faster || !of_limits || self.waiting.len() >= WAITING {
            self.flush(pass);
        }
        let rests = frame.ends_at_rest;
        // A row in which the motion only slows down may belong to a stop.
        if of_limits && !faster {
            self.waiting.push_back(frame);
            if rests {
                self.waiting.iter_mut().for_each(|frame| frame.bound = Bound::Stop);
                self.flush(pass);
            }
        } else {
            pass(frame);
        }
        self.rising |= rests;
    }

    /// Passes on all rows.
    pub fn flush(&mut self, pass: &mut impl FnMut(Frame)) {
        self.waiting.drain(..).for_each(pass);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The causes of rows with these speeds at their ends, from rest.
    fn causes(speeds: &[f64], own: &[Bound]) -> Vec<Bound> {
        let mut stops = Stops::new();
        let mut found = Vec::new();
        let mut before = 0.0;
        let mut pass = |frame: Frame| found.push(frame.bound);
        for (&after, &bound) in speeds.iter().zip(own) {
            let frame = Frame {
                ticks: 1,
                segments: Vec::new(),
                line: 1,
                bound,
                speed: [before, before.midpoint(after), after],
                ends_at_rest: after == 0.0,
                place: Vec::new(),
                bow: 0.0,
                off: 0.0,
            };
            stops.push(frame, &mut pass);
            before = after;
        }
        stops.flush(&mut pass);
        found
    }

    #[test]
    fn ramps_to_and_from_a_rest_belong_to_the_stop() {
        let (a, j) = (Bound::Acceleration(0), Bound::Jerk(0));
        let own = [j, a, Bound::Feed, a, a, a, a, j, Bound::Stop, a, j];
        let found = causes(&[1.0, 2.0, 2.0, 1.0, 1.5, 1.0, 0.5, 0.0, 0.0, 1.0, 0.0], &own);
        let s = Bound::Stop;
        assert_eq!(found, [s, s, Bound::Feed, a, a, s, s, s, s, s, s]);
    }

    #[test]
    fn a_corner_on_the_way_keeps_its_cause() {
        let a = Bound::Acceleration(1);
        let own = [a, a, Bound::Tolerance, a, a];
        let found = causes(&[2.0, 1.0, 1.0, 2.0, 1.0], &own);
        assert_eq!(found, [Bound::Stop, a, Bound::Tolerance, a, a]);
    }
}

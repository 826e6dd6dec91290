//! Follows a programmed path in its order, from one place of the tool to the next.
//!
//! The tool is known by its places alone, so several places of the path may belong to one of them:
//! where the path crosses itself, or goes back along itself. `reached` is the set of all places of
//! the path where the tool can be. With the next place of the tool, each of them goes on along the
//! path, as long as the path stays within a *far* distance of the tool, to the places within the
//! *near* distance. If none is left, the tool has left the path or its order.
//!
//! ```text
//!                       far
//!     path   ----o-----(----[=====x=====]----)------->    = reached, with the tool at x
//!                       near
//! ```
//!
//! Near is the tolerance and one step of each motor. Far is one tolerance more, because a tool that
//! stays near both sides of an acute corner cuts its tip by up to that.

use crate::path_leg::{LETTERS, LINEAR, Leg, PathLeg, Place, Reach};
use std::collections::VecDeque;

/// A part of a leg that the tool can have reached.
#[derive(Debug, Clone, Copy)]
struct Span {
    leg: u64,
    from: f64,
    to: f64,
}

/// How far the tool is from the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Off {
    /// Over x, y and z, mm.
    pub linear: f64,
    /// The greatest of a, b and c, degrees.
    pub rotary: f64,
    /// What is allowed there, mm.
    pub linear_bound: f64,
    /// What is allowed there for the rotary letter with the greatest step, degrees.
    pub rotary_bound: f64,
    /// Line of the program.
    pub line: u64,
}

impl Off {
    /// The distance as a part of what is allowed.
    pub fn part(&self) -> f64 {
        (self.linear / self.linear_bound).max(self.rotary / self.rotary_bound)
    }
}

/// The tool is nowhere where it should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lost {
    /// The distance from the next part of the path.
    pub off: Off,
}

/// A path and how far a tool has followed it.
pub(crate) struct PathFollow<'a> {
    legs: Box<dyn Iterator<Item = PathLeg> + Send + 'a>,
    /// One leg is read ahead, because the tolerance behind it matters for `far`.
    ahead: Option<PathLeg>,
    end: Place,
    tolerance_before: [f64; 2],
    window: VecDeque<Leg>,
    /// Number of the first leg of the window.
    first: u64,
    /// One step of each letter: of the motors that move it, the root of the sum of squares.
    step: Place,
    reached: Vec<Span>,
    next: Vec<Span>,
}

impl<'a> PathFollow<'a> {
    /// A path that begins at a place. `step` is one step of each letter.
    pub fn new(
        mut legs: Box<dyn Iterator<Item = PathLeg> + Send + 'a>,
        start: Place,
        step: Place,
    ) -> Self {
        let ahead = legs.next();
        Self {
            legs,
            ahead,
            end: start,
            tolerance_before: [0.0; 2],
            window: VecDeque::new(),
            first: 0,
            step,
            reached: vec![Span { leg: 0, from: 0.0, to: 0.0 }],
            next: Vec::new(),
        }
    }

    /// Reads the leg of this number into the window, if the path has it.
    fn read(&mut self, number: u64) -> bool {
        while self.first + self.window.len() as u64 <= number {
            let Some(leg) = self.ahead.take() else { return false };
            self.ahead = self.legs.next();
            let own = [leg.tolerance_mm, leg.tolerance_deg];
            let after = self.ahead.map_or(own, |next| [next.tolerance_mm, next.tolerance_deg]);
            let most: [f64; 2] =
                std::array::from_fn(|k| own[k].max(after[k]).max(self.tolerance_before[k]));
            let steps = self.step[..LINEAR].iter().map(|s| s * s).sum::<f64>().sqrt();
            let rotary =
                |extra: f64| std::array::from_fn(|k| own[1] + extra + self.step[LINEAR + k]);
            let near = (own[0] + steps - leg.off_mm).max(0.0);
            let near = Reach { linear: near, rotary: rotary(0.0) };
            let far = Reach { linear: near.linear + most[0], rotary: rotary(most[1]) };
            let from = std::mem::replace(&mut self.end, leg.to);
            self.tolerance_before = own;
            self.window.push_back(Leg { from, leg, near, far });
        }
        true
    }

    /// The next place of the tool. Returns how far it is from where it should be; `None` if the
    /// path has no legs.
    ///
    /// # Errors
    /// [`Lost`]; the path cannot be followed further.
    pub fn go(&mut self, place: &Place) -> Result<Option<Off>, Lost> {
        let [Some(first), Some(last)] = [self.reached.first(), self.reached.last()] else {
            return Ok(None);
        };
        let (mut number, last) = (first.leg, last.leg);
        if !self.read(number) {
            return Ok(None);
        }
        self.next.clear();
        let (mut spans, mut goes_on) = (0, false);
        let (mut best, mut missed): (Option<Off>, Option<Off>) = (None, None);
        while (goes_on || number <= last) && self.read(number) {
            let leg = &self.window[(number - self.first) as usize];
            let mut reached = None;
            while let Some(span) = self.reached.get(spans).filter(|span| span.leg == number) {
                reached = Some((span.from, span.to));
                spans += 1;
            }
            let Some((low, high)) = leg.within(place, &leg.far) else {
                goes_on = false;
                keep_least(&mut missed, off(leg, place, 0.0, 1.0), Off::part);
                number += 1;
                continue;
            };
            // Where the tool comes onto this part of the leg: at its start, or where it was.
            let comes = if goes_on && low <= 0.0 {
                Some(0.0)
            } else {
                reached
                    .filter(|(from, to)| *to >= low && *from <= high)
                    .map(|(from, _)| from.max(low))
            };
            goes_on = comes.is_some() && high >= 1.0;
            keep_least(&mut missed, off(leg, place, low, high), Off::part);
            if let (Some(comes), Some((low, high))) = (comes, leg.within(place, &leg.near))
                && high >= comes
            {
                let (from, to) = (low.max(comes), high);
                keep_least(&mut best, off(leg, place, from, to), Off::part);
                self.next.push(Span { leg: number, from, to });
            }
            number += 1;
        }
        let Some(best) = best else {
            return missed.map_or(Ok(None), |off| Err(Lost { off }));
        };
        std::mem::swap(&mut self.reached, &mut self.next);
        let oldest = self.reached.first().map_or(0, |span| span.leg);
        while self.first < oldest {
            self.window.pop_front();
            self.first += 1;
        }
        Ok(Some(best))
    }

    /// Whether the tool can be at the end of the path.
    pub fn is_at_the_end(&mut self) -> bool {
        let Some(last) = self.reached.last().copied() else { return true };
        let at_the_end = last.to >= 1.0 || (last.leg == 0 && !self.read(0));
        at_the_end && !self.read(last.leg + 1)
    }

    /// Whether the tool can be where the leg of this number begins, or behind it.
    pub fn may_be_at(&self, leg: u64) -> bool {
        let last = self.reached.last();
        last.is_none_or(|last| last.leg >= leg || (last.leg + 1 == leg && last.to >= 1.0))
    }

    /// Whether the tool is behind the place where the leg of this number begins, and cannot be
    /// there any more.
    pub fn is_behind(&self, leg: u64) -> bool {
        let first = self.reached.first();
        first.is_some_and(|first| first.leg > leg || (first.leg == leg && first.from > 0.0))
    }

    /// The line that the tool has reached; `None` if the path has no legs.
    pub fn line(&self) -> Option<u64> {
        let last = self.reached.last()?.leg;
        self.window.get((last - self.first) as usize).map(|leg| leg.leg.line)
    }
}

fn off(leg: &Leg, place: &Place, low: f64, high: f64) -> Off {
    let (linear, rotary) = leg.distance(place, low, high);
    let rotary_bound = leg.near.rotary.iter().copied().fold(0.0, f64::max);
    let linear_bound = leg.near.linear + leg.leg.off_mm;
    Off { linear, rotary, linear_bound, rotary_bound, line: leg.leg.line }
}

fn keep_least(slot: &mut Option<Off>, new: Off, key: fn(&Off) -> f64) {
    if slot.as_ref().is_none_or(|old| key(&new) < key(old)) {
        *slot = Some(new);
    }
}

const _: () = assert!(LETTERS == 6, "a place has the letters of G-code");

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 0.01;

    fn place(x: f64, y: f64) -> Place {
        [x, y, 0.0, 0.0, 0.0, 0.0]
    }

    fn follow(corners: &[(f64, f64)]) -> PathFollow<'static> {
        let legs: Vec<PathLeg> = (1..)
            .zip(&corners[1..])
            .map(|(line, &(x, y))| PathLeg {
                to: place(x, y),
                tolerance_mm: 0.02,
                tolerance_deg: 0.02,
                off_mm: 0.0,
                line,
            })
            .collect();
        let step = [STEP, STEP, 0.0, 0.0, 0.0, 0.0];
        let (x, y) = corners[0];
        PathFollow::new(Box::new(legs.into_iter()), place(x, y), step)
    }

    /// Goes straight from place to place in steps, and returns the worst part of what is allowed.
    fn go(follow: &mut PathFollow<'_>, places: &[(f64, f64)]) -> Result<f64, Lost> {
        let mut worst = 0.0_f64;
        for pair in places.windows(2) {
            let [(x0, y0), (x1, y1)] = [pair[0], pair[1]];
            let count = ((x1 - x0).hypot(y1 - y0) / STEP).ceil().max(1.0) as u32;
            for k in 0..=count {
                let u = f64::from(k) / f64::from(count);
                let at = place(x0 + u * (x1 - x0), y0 + u * (y1 - y0));
                worst = worst.max(follow.go(&at)?.map_or(0.0, |off| off.part()));
            }
        }
        Ok(worst)
    }

    #[test]
    fn tool_on_the_path_is_at_distance_0_and_arrives() {
        // The path crosses itself and goes back along itself.
        let corners =
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1.0), (0.5, -1.0), (0.5, 1.0), (0.0, 0.0)];
        let mut path = follow(&corners);
        assert!(!path.is_at_the_end());
        assert!(go(&mut path, &corners).unwrap() < 1e-9);
        assert!(path.is_at_the_end());
        assert_eq!(path.line(), Some(6));
    }

    #[test]
    fn acute_tip_may_be_cut_within_the_tolerance_of_both_sides() {
        let mut path = follow(&[(0.0, 0.0), (1.0, 0.0), (0.0, 0.1)]);
        assert!(go(&mut path, &[(0.0, 0.0), (0.96, 0.002), (0.0, 0.1)]).is_ok());
        assert!(path.is_at_the_end());
        let mut path = follow(&[(0.0, 0.0), (1.0, 0.0), (0.0, 0.1)]);
        assert!(go(&mut path, &[(0.0, 0.0), (0.8, 0.01), (0.0, 0.1)]).is_err());
    }

    #[test]
    fn tool_beside_the_path_is_lost() {
        let mut path = follow(&[(0.0, 0.0), (1.0, 0.0)]);
        let lost = go(&mut path, &[(0.0, 0.0), (0.5, 0.05), (1.0, 0.0)]).unwrap_err();
        assert!(lost.off.part() > 1.0 && lost.off.part() < 1.1, "{lost:?}");
    }

    #[test]
    fn loop_that_is_left_out_is_not_followed() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.5, 0.5), (1.0, 0.0), (2.0, 0.0)];
        let mut path = follow(&corners);
        let left_out = go(&mut path, &[(0.0, 0.0), (2.0, 0.0)]);
        assert!(left_out.is_err());
    }

    #[test]
    fn path_in_another_order_is_not_followed() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0)];
        let mut reversed = corners;
        reversed.reverse();
        assert!(go(&mut follow(&corners), &reversed).is_err());
    }

    #[test]
    fn tool_that_stops_short_is_not_at_the_end() {
        let mut path = follow(&[(0.0, 0.0), (1.0, 0.0)]);
        assert!(go(&mut path, &[(0.0, 0.0), (0.9, 0.0)]).is_ok());
        assert!(!path.is_at_the_end());
    }

    #[test]
    fn path_without_legs_is_at_its_end() {
        let mut path = follow(&[(0.0, 0.0)]);
        assert_eq!(path.go(&place(0.0, 0.0)), Ok(None));
        assert!(path.is_at_the_end());
    }
}

//! Drilling cycles G81, G82 and G83 as single moves, made one after the other.
//!
//! ```text
//!   Raise     straight up to R, if the cycle begins below it
//!   Over      over the hole, at the level where the tool is, or at that of Leave if it is higher
//!   Approach  down to R
//!   Drill     with feed, to the bottom or to the next peck
//!   Clear     back to R after a peck, and Return, down to 0.254 mm above it
//!   Dwell     at the bottom (G82)
//!   Leave     up to R (G99) or to the initial level (G98); then Over for the next hole
//! ```

use crate::canon::{Canon, Pace, Plane, Point};
use crate::circle::{Polar, Vector};
use crate::frame::Frame;

/// Distance above the last peck at which feed begins again, in mm: 0.01 inch, as in LinuxCNC.
const PECK_CLEARANCE: f64 = 0.254;

/// Kinds of holes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Hole {
    /// G81.
    Drill,
    /// G82: with a rest at the bottom, in s.
    Dwell(f64),
    /// G83: in pecks of this depth, in mm.
    Peck(f64),
}

/// Holes that remain to be drilled. Lengths are in mm, in program coordinates.
#[derive(Debug)]
pub(crate) struct Cycle {
    pub(crate) hole: Hole,
    pub(crate) plane: Plane,
    pub(crate) frame: Frame,
    pub(crate) pace: Pace,
    /// Where the tool is.
    pub(crate) at: Point,
    /// Where the holes are.
    pub(crate) pattern: Pattern,
    /// Number of the present hole, from 0.
    pub(crate) hole_number: u32,
    /// Number of holes.
    pub(crate) holes: u32,
    pub(crate) r: f64,
    pub(crate) bottom: f64,
    /// Level after each hole.
    pub(crate) clear: f64,
    pub(crate) stage: Stage,
}

/// Where the holes are, in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Pattern {
    /// The first hole, and the distance of the next ones.
    Straight(Vector, Vector),
    /// The same in polar coordinates.
    Polar(Polar, Polar),
}

impl Pattern {
    /// The place of a hole.
    fn place(self, number: u32) -> Vector {
        let number = f64::from(number);
        match self {
            Self::Straight(first, by) => [first[0] + by[0] * number, first[1] + by[1] * number],
            Self::Polar(first, by) => {
                let radius = first.radius + by.radius * number;
                Polar { radius, angle: first.angle + by.angle * number }.place()
            }
        }
    }
}

/// The next move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Stage {
    Raise,
    Over,
    Approach,
    /// Number of the peck, from 1.
    Drill(u64),
    Clear(u64),
    Return(u64),
    Dwell,
    Leave,
}

impl Cycle {
    /// Where the tool is after the last hole.
    pub(crate) fn end(&self) -> Point {
        let [first, second, normal] = self.plane.axes();
        let mut end = self.at;
        [end[first], end[second]] = self.pattern.place(self.holes.saturating_sub(1));
        end[normal] = self.clear;
        end
    }

    /// Depth after a peck.
    fn depth(&self, peck: u64) -> f64 {
        match self.hole {
            Hole::Peck(depth) => (self.r - depth * peck as f64).max(self.bottom),
            Hole::Drill | Hole::Dwell(_) => self.bottom,
        }
    }

    /// The end of the present stage, and the stage after it.
    fn target(&self) -> (Point, Stage) {
        let [first, second, normal] = self.plane.axes();
        let mut to = self.at;
        let next = match self.stage {
            Stage::Raise => {
                to[normal] = self.r;
                Stage::Over
            }
            Stage::Over => {
                [to[first], to[second]] = self.pattern.place(self.hole_number);
                to[normal] = self.at[normal].max(self.clear);
                Stage::Approach
            }
            Stage::Approach => {
                to[normal] = self.r;
                Stage::Drill(1)
            }
            Stage::Drill(peck) => {
                to[normal] = self.depth(peck);
                match self.hole {
                    _ if to[normal] > self.bottom => Stage::Clear(peck),
                    Hole::Dwell(_) => Stage::Dwell,
                    Hole::Drill | Hole::Peck(_) => Stage::Leave,
                }
            }
            Stage::Clear(peck) => {
                to[normal] = self.r;
                Stage::Return(peck)
            }
            Stage::Return(peck) => {
                to[normal] = (self.depth(peck) + PECK_CLEARANCE).min(self.r);
                Stage::Drill(peck + 1)
            }
            Stage::Dwell => Stage::Leave,
            Stage::Leave => {
                to[normal] = self.clear;
                Stage::Over
            }
        };
        (to, next)
    }
}

impl Iterator for Cycle {
    type Item = Option<Canon>;

    /// Does the next stage; without a move if the tool is already there.
    fn next(&mut self) -> Option<Self::Item> {
        if self.hole_number == self.holes {
            return None;
        }
        let stage = self.stage;
        let (to, next) = self.target();
        let stays = to == self.at;
        self.at = to;
        self.stage = next;
        if stage == Stage::Leave {
            self.hole_number += 1;
        }
        Some(match (stage, self.hole) {
            (Stage::Dwell, Hole::Dwell(seconds)) => Some(Canon::Dwell { seconds }),
            _ if stays => None,
            (Stage::Drill(_), _) => {
                Some(Canon::Feed { to: self.frame.to_machine(&to), pace: self.pace })
            }
            _ => Some(Canon::Traverse { to: self.frame.to_machine(&to) }),
        })
    }
}

//! What binds the motion: the one limit that would have to be greater for the motion to be faster
//! at a place.
//!
//! The rules, in their order, for one row:
//!
//! 1. At rest it is the stop. Where the move file gives the time, it is that time.
//! 2. The feed, from 98 % of it on. 3. The speed of an axis, from 98 % of its limit on.
//! 4. The tolerance, where the curve rounds a corner: it is further than half of the tolerance from
//!    the path, accelerates across its direction at least as much as along it, and the corner is
//!    sharp (`corner` of [`Motion`](crate::Motion)).
//! 5. Where no axis uses half of its acceleration and a quarter of its jerk, the tolerance if the
//!    curve uses half of it: the planner has made the motion slower to stay near the path.
//! 6. Otherwise the greater part: of an axis' acceleration, or twice that of its jerk. The jerk
//!    counts twice because the planner changes the acceleration from nothing to its limit with half
//!    of the jerk limit (`docs/jobs.md`).

/// What binds the motion. The axes are numbered in the order of the machine file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Bound {
    /// The motion rests, or slows down to a rest, or speeds up from it.
    Stop,
    /// The move file gives the time of the move.
    GivenTime,
    /// The feed of the program.
    Feed,
    /// The tolerance: the curve rounds a corner.
    Tolerance,
    /// The speed limit of this axis.
    Speed(usize),
    /// The acceleration limit of this axis.
    Acceleration(usize),
    /// The jerk limit of this axis.
    Jerk(usize),
}

/// Causes that belong to no axis.
const COMMON: [Bound; 4] = [Bound::Stop, Bound::GivenTime, Bound::Feed, Bound::Tolerance];

impl Bound {
    /// All causes of a machine with so many axes, in the order of [`Self::index`].
    pub fn all(axes: usize) -> impl Iterator<Item = Self> {
        let of = move |make: fn(usize) -> Self| (0..axes).map(make);
        COMMON
            .into_iter()
            .chain(of(Self::Speed))
            .chain(of(Self::Acceleration))
            .chain(of(Self::Jerk))
    }

    /// The place in the list of all causes.
    pub fn index(self, axes: usize) -> usize {
        match self {
            Self::Stop => 0,
            Self::GivenTime => 1,
            Self::Feed => 2,
            Self::Tolerance => 3,
            Self::Speed(axis) => COMMON.len() + axis,
            Self::Acceleration(axis) => COMMON.len() + axes + axis,
            Self::Jerk(axis) => COMMON.len() + 2 * axes + axis,
        }
    }

    /// The name in `--json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stop => "stop",
            Self::GivenTime => "given_time",
            Self::Feed => "feed",
            Self::Tolerance => "tolerance",
            Self::Speed(_) => "speed",
            Self::Acceleration(_) => "acceleration",
            Self::Jerk(_) => "jerk",
        }
    }

    /// The axis whose limit it is.
    pub fn axis(self) -> Option<usize> {
        match self {
            Self::Speed(axis) | Self::Acceleration(axis) | Self::Jerk(axis) => Some(axis),
            _ => None,
        }
    }
}

/// From this part of a speed on, the speed binds.
const AT_SPEED: f64 = 0.98;
/// Below this part of an acceleration, and half of it of a jerk, no limit of an axis binds.
const FREE: f64 = 0.5;
/// From this part of the tolerance on, the tolerance may bind.
const FAR: f64 = 0.5;

/// The figures of a row that decide, each as a part of its limit.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Parts {
    /// Nothing moves.
    pub rests: bool,
    /// The move file gives the time.
    pub given: bool,
    /// Speed along the path, of the feed.
    pub feed: f64,
    /// The greatest part of each kind, and the axis that has it.
    pub speed: (f64, usize),
    pub acceleration: (f64, usize),
    pub jerk: (f64, usize),
    /// Distance from the path, of the tolerance.
    pub off: f64,
    /// Sharpness of the corner.
    pub corner: f64,
    /// Whether the acceleration across the path is at least that along it.
    pub turns: bool,
}

/// What binds the motion in a row with these figures.
pub(crate) fn bound(parts: &Parts) -> Bound {
    let Parts { speed, acceleration, jerk, .. } = *parts;
    let changes = 2.0 * jerk.0;
    if parts.rests {
        Bound::Stop
    } else if parts.given {
        Bound::GivenTime
    } else if parts.feed >= AT_SPEED {
        Bound::Feed
    } else if speed.0 >= AT_SPEED {
        Bound::Speed(speed.1)
    } else if parts.off >= FAR
        && ((parts.corner >= 1.0 && parts.turns) || acceleration.0.max(changes) < FREE)
    {
        Bound::Tolerance
    } else if changes > acceleration.0 {
        Bound::Jerk(jerk.1)
    } else {
        Bound::Acceleration(acceleration.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn index_is_the_place_in_the_list() {
        for axes in 1..=8 {
            for (place, bound) in Bound::all(axes).enumerate() {
                assert_eq!(bound.index(axes), place);
            }
        }
    }

    #[test]
    fn rules_hold_in_their_order() {
        let ramp = Parts { acceleration: (0.99, 1), jerk: (0.02, 0), ..Parts::default() };
        let corner = Parts { off: 0.9, corner: 30.0, turns: true, ..ramp };
        for (parts, expected) in [
            (Parts { rests: true, ..corner }, Bound::Stop),
            (Parts { given: true, ..corner }, Bound::GivenTime),
            (Parts { feed: 0.985, ..corner }, Bound::Feed),
            (Parts { speed: (0.99, 2), ..corner }, Bound::Speed(2)),
            (corner, Bound::Tolerance),
            // A ramp on a line near a corner, and an arc that is followed closely.
            (Parts { turns: false, ..corner }, Bound::Acceleration(1)),
            (Parts { corner: 0.1, ..corner }, Bound::Acceleration(1)),
            (Parts { off: 0.2, ..corner }, Bound::Acceleration(1)),
            (Parts { jerk: (0.5, 0), ..ramp }, Bound::Jerk(0)),
            (Parts { off: 0.6, acceleration: (0.3, 1), ..ramp }, Bound::Tolerance),
        ] {
            assert_eq!(bound(&parts), expected, "{parts:?}");
        }
    }
}

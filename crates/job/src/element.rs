//! The input: a programmed path in machine coordinates, element by element.
//!
//! Whoever reads a program (an interpreter of G-code, a host) translates it into these items. The
//! planner knows nothing else of the program.

/// One item of a programmed path.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// The tool moves.
    Move(Element),
    /// The path comes to rest here, for `dwell` seconds, 0 or more.
    Rest {
        /// Time at rest, seconds.
        dwell: f64,
        /// The source line.
        line: u64,
    },
    /// A number of the caller, for what happens at this place of the path (an output that
    /// switches). The first row that starts at or behind the place carries it.
    Mark(u64),
    /// The same, for what may also happen a little before the place: the row carries it whose start
    /// is nearest to the place, of the one in which the path reaches the place and the one behind.
    NearMark(u64),
}

/// A move along a line, an arc or a helix, from where the element before it ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Element {
    /// The end, a coordinate for each letter, mm or degrees.
    pub to: Vec<f64>,
    /// How the element bends; `None` is a straight line.
    pub arc: Option<Arc>,
    /// Greatest speed along the path, mm/s (degrees/s where only rotary letters move); `None` is a
    /// rapid move, which only the limits of the axes bound.
    pub feed: Option<f64>,
    /// How far the commanded path may be from the programmed one.
    pub tolerance: Tolerance,
    /// The source line, for errors and reports.
    pub line: u64,
    /// A number of the caller that does not fall from one element to the next, for reports.
    pub block: u64,
}

/// A circular arc in a plane of two coordinates. All others change in proportion to the angle, so
/// that a third linear coordinate makes a helix. A radius that differs between start and end also
/// changes in proportion to the angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// The two coordinates of the plane, as numbers of letters; a positive angle turns from the
    /// first to the second.
    pub plane: [usize; 2],
    /// The centre in these two coordinates, mm.
    pub centre: [f64; 2],
    /// The angle from start to end, radians, with its sign and with whole turns.
    pub angle: f64,
}

/// A tolerance: distances that the commanded path keeps from the programmed path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Euclidean, over the linear letters, mm.
    pub linear: f64,
    /// For each rotary letter, degrees.
    pub rotary: f64,
}

impl Tolerance {
    /// The greatest distance in a direction, over all letters alike. The first `linear` ones are in
    /// mm. Infinite for the direction 0.
    pub(crate) fn toward(&self, direction: &[f64], linear: usize) -> f64 {
        let norm = |part: &[f64]| part.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (mm, degrees) = direction.split_at(linear.min(direction.len()));
        let most = degrees.iter().map(|x| x.abs()).fold(0.0, f64::max);
        let length = norm(direction);
        let allowed = |tolerance: f64, part: f64| {
            if part > 0.0 { tolerance * (length / part) } else { f64::INFINITY }
        };
        allowed(self.linear, norm(mm)).min(allowed(self.rotary, most))
    }
}

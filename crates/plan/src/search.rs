//! The search for the longest segment of a fit: how long it goes on, and the next length to try.

use crate::corridor::JOINT;

/// The least factor by which the next try is longer, after one that used little of the tolerance.
const LEAP: f64 = 1.25;

/// How the longest segment is searched.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Search {
    /// The greatest fraction of the tolerance that a segment may use.
    pub full: f64,
    /// The fraction of the tolerance that the next try aims at.
    pub aim: f64,
    /// The fraction of the tolerance from which on a segment counts as long enough.
    pub enough: f64,
    /// A segment also counts as long enough if one that is longer by its length divided by this
    /// number is too long.
    pub close: u64,
    /// Whether the whole rest of a piece is tried before a length that is close to it. A stub that
    /// is left costs a segment.
    pub to_end: bool,
}

/// The search in a piece of a single move.
pub(crate) const QUICK: Search =
    Search { full: 0.97, aim: 0.95, enough: 0.90, close: 40, to_end: false };

/// Estimates the longest good length from the two shortest bad ones. The error is taken to grow
/// with the power of the length that fits both, or with the fourth power if there is only one.
pub(crate) fn shorter([(longer, worse), (length, level)]: [(f64, f64); 2], aim: f64) -> f64 {
    let power = (worse / level).ln() / (longer / length).ln();
    let power = if power.is_finite() { power.clamp(2.0, 16.0) } else { 4.0 };
    length * (aim / level).powf(power.recip()).max(0.25)
}

/// Estimates the longest good length from one good length, or from one that has no solution. A
/// small error says little about the length, because it may be the error that the segment starts
/// with.
pub(crate) fn longer(length: f64, level: f64, aim: f64) -> f64 {
    let factor = (aim / level).powf(0.25).clamp(0.25, 4.0);
    length * if level < JOINT { factor.max(LEAP) } else { factor }
}

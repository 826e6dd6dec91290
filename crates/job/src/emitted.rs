//! What the last stage in floats passes on: control points of the emitted curve.

use crate::inspect::{Depth, Fault, Inspector};
use crate::path::Path;
use crate::speed::Instant;
use crate::vector::Point;

/// A curve follows an arc if its curvature is at most this multiple of that of the arc.
const SHARPER: f64 = 1.25;

/// A control point of the emitted curve, and where the curve is at the end of the interval that the
/// point completes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Emitted<const N: usize> {
    pub point: Point<N>,
    pub passed: Passed,
}

/// What the curve has passed at the end of an interval between two knots.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Passed {
    /// The piece of the path.
    pub piece: u64,
    /// Its source line.
    pub line: u64,
    /// Its number of the caller.
    pub block: u64,
    /// The lowest feed of the pieces in the interval.
    pub feed: f64,
    /// The greatest measured distance from the path in the interval, as a part of the tolerance.
    pub off: f64,
    /// See [`Row::corner`](crate::Row::corner).
    pub corner: f64,
}

impl Passed {
    /// The curve goes from one piece to another. It is this far from the path and has this
    /// curvature, 1/mm.
    pub fn new<const N: usize>(from: u64, to: u64, off: f64, bend: f64, path: &Path<N>) -> Self {
        let (mut feed, mut length, mut beyond) = (f64::INFINITY, f64::INFINITY, 0.0_f64);
        let (mut line, mut block, mut tolerance) = (0, 0, f64::INFINITY);
        for piece in (from..=to).filter_map(|piece| path.piece(piece)) {
            feed = feed.min(piece.feed);
            length = length.min(piece.length);
            tolerance = tolerance.min(piece.tolerance.linear);
            let own = piece.bends()[0];
            // A curve that is hardly sharper than its arc follows the arc.
            beyond = beyond.max(if bend > SHARPER * own { bend - own } else { 0.0 });
            (line, block) = (piece.line, piece.block);
        }
        // The height of an arc over its chord.
        let corner = beyond * length * length / 8.0 / tolerance;
        Self { piece: to, line, block, feed, off, corner }
    }
}

impl<const N: usize> Emitted<N> {
    /// Measures and proves the interval that the next control point completes.
    pub fn measured(
        emitted: &Instant<N>,
        inspector: &mut Inspector<N>,
        path: &Path<N>,
    ) -> (Self, impl Iterator<Item = Fault<N>> + use<N>) {
        let from = inspector.place().piece;
        let faults = inspector.push(emitted, path, Depth::Proof);
        let to = inspector.place().piece;
        let passed = Passed::new(from, to, inspector.measured(), inspector.curvature(), path);
        (Self { point: emitted.knot.point, passed }, faults)
    }
}

//! Decides how long a run may be: the rounding of its A, J and V must not move an edge visibly.
//!
//! A run is a sequence of ticks that follows one cubic; a unit is 2^-64 step.

use crate::cubic::wide;
use crate::share::Piece;
use crate::units;
use carrystep_core::StartPhase;
use carrystep_profile::{Profile, Rates, Real};

/// How far the rounding of A, J and V may move an edge, seconds. The rest of the promised 2 ns is
/// for the 32-bit bisection and for the floats of the profile, which are accurate to 0.3 ns after
/// 10^6 s.
const EDGE_SHIFT: f64 = 0.5e-9;

/// How a run may treat the units by which its rounded V is ahead at its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fine {
    /// The next run corrects them.
    Carried,
    /// The run has to land exactly, because they would move an edge of the next run.
    Landed,
}

/// Decides whether a run of this profile may have the length of this piece, and how it then treats
/// its remainder. The piece is from `begin` to `end` seconds, and `middle` are the rates between
/// them; `acceleration` and `jerk` are the magnitudes that rounding leaves out of A and J. The
/// start speed may exceed its limit by `tolerance` units. `None` means that the piece has to be
/// divided.
pub(crate) fn fine<F: Real>(
    profile: &dyn Profile<F>,
    piece: &Piece,
    [begin, end]: [F; 2],
    middle: &Rates<F>,
    [acceleration, jerk]: [f64; 2],
    (phase, tolerance): (StartPhase, i128),
) -> Option<Fine> {
    let &Piece { first, ticks, .. } = piece;
    let length = ticks as f64;
    // V makes up for A and J, so a long first run would start too fast by half of this speed.
    let late = (acceleration + jerk * length / 3.0) * length;
    if first == 0 && late > units::float(tolerance) {
        return None;
    }
    // The deviation is a parabola t(n-t)/2 for each unit left out of A, and at most a cubic t^2
    // (n-t)/6 for each unit left out of J. In addition V is ahead by up to one unit per tick.
    let lost = (jerk * length / 40.0 + acceleration / 8.0) * length + 1.0;
    let small = |lost: f64, speed: f64| lost * length * 2_f64.powi(-64) / speed <= EDGE_SHIFT;
    let at_edge = if middle.are_level() {
        // A breakpoint rounded to a tick may leave the end of a ramp at the beginning of a
        // cruise.
        wide(middle.speed)
    } else {
        // After a start from rest the first edge comes half a step later, at a speed of sqrt(a)
        // or more than cbrt(j). A root is taken only where it decides.
        let from = profile.rates(begin);
        let mut at_edge = wide(from.speed.min(profile.speed(end))).max(f64::MIN_POSITIVE);
        if !small(lost, at_edge) {
            at_edge = at_edge.max(wide(from.acceleration.abs().sqrt()));
        }
        if !small(lost, at_edge) {
            at_edge = at_edge.max(wide(from.jerk.abs().cbrt()));
        }
        at_edge
    };
    if small(lost, at_edge) {
        return Some(Fine::Carried);
    }
    let [from, to] = [begin, end].map(|t| wide(profile.position(t)));
    // Tests whether the units by which V is ahead would move the next edge.
    let still = if small(1.0, at_edge) { Fine::Carried } else { Fine::Landed };
    (!has_edge(phase, from, to)).then_some(still)
}

/// Whether a pulse is due between two positions in steps, or within 10^-3 step of them.
fn has_edge(phase: StartPhase, from: f64, to: f64) -> bool {
    let offset = match phase {
        StartPhase::Half => 0.5,
        StartPhase::Zero => 0.0,
    };
    (to - offset + 1e-3).floor() > (from - offset - 1e-3).floor()
}

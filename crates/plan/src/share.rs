//! A move's distance, shared out over its ticks: the pieces add up to it exactly.

use crate::demand::{Clock, float};
use crate::units;
use carrystep_profile::{Profile, Real};

/// Ticks that follow one formula, or one tick in which formulas change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Piece {
    /// First tick, from 0 at the start of the move.
    pub first: u64,
    /// Length, ticks.
    pub ticks: u64,
    /// Distance from the start of the move to its start, 2^-64 step.
    pub start: i128,
    /// Distance in the direction of travel, 2^-64 step.
    pub units: i128,
}

/// What happens to a breakpoint inside a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Breakpoints<F> {
    /// The tick becomes a piece of its own: nothing is lost.
    Kept,
    /// The nearest boundary takes its place where that moves no edge by more than so many ticks.
    Rounded(F),
}

/// Splits the move at its breakpoints.
///
/// Floats share the distance out; the greatest piece takes what their rounding leaves, so that the sum is
/// `total`. `None` if a float is out of range.
pub(crate) fn share<F: Real>(
    profile: &dyn Profile<F>,
    clock: &Clock<F>,
    total: i128,
    breakpoints: Breakpoints<F>,
) -> Option<Vec<Piece>> {
    let cuts = cuts(profile, clock, breakpoints);
    let mut pieces = Vec::with_capacity(cuts.len());
    for ends in cuts.windows(2) {
        let (first, ticks) = (ends[0], ends[1] - ends[0]);
        pieces.push(Piece { first, ticks, start: 0, units: distance(profile, clock, first, ticks)? });
    }
    let sum: i128 = pieces.iter().map(|piece| piece.units).sum();
    let greatest = pieces.iter_mut().max_by_key(|piece| piece.units)?;
    greatest.units += total - sum;
    if greatest.units < 0 {
        return None;
    }
    let mut start = 0;
    for piece in &mut pieces {
        piece.start = start;
        start += piece.units;
    }
    Some(pieces)
}

/// Distance over whole ticks, as a mean speed: no difference of two positions, so that it is relatively
/// exact for a single tick too.
pub(crate) fn distance<F: Real>(profile: &dyn Profile<F>, clock: &Clock<F>, first: u64, ticks: u64) -> Option<i128> {
    let end = first + ticks;
    let mean = profile.mean_speed(clock.at(first), clock.at(end));
    let used = if end == clock.ticks { float::<F>(ticks - 1) + clock.last } else { float(ticks) };
    Some(units::nearest(mean * (used * clock.tick))?.max(0))
}

/// Ticks at which pieces begin, and the end.
fn cuts<F: Real>(profile: &dyn Profile<F>, clock: &Clock<F>, breakpoints: Breakpoints<F>) -> Vec<u64> {
    let mut cuts = vec![0, clock.ticks];
    // A fit that comes to rest may do so a part of a tick later.
    let rests = breakpoints != Breakpoints::Kept && profile.speed(clock.seconds).is_zero();
    if clock.last < F::one() && !rests {
        cuts.push(clock.ticks - 1);
    }
    for &breakpoint in profile.breakpoints() {
        let exact = breakpoint / clock.tick;
        let nearest = exact.round();
        // So near to a boundary that only rounding, or nothing that a pin could show, lies between.
        let noise = F::epsilon() * float(4) * exact + F::from(1e-9).unwrap_or_else(F::epsilon);
        let off = (exact - nearest).abs();
        let rounded = match breakpoints {
            Breakpoints::Kept => false,
            Breakpoints::Rounded(most) => {
                // A cruise that takes in this much of a ramp, or of a rest, begins with the wrong speed.
                let [here, there] = [breakpoint, nearest * clock.tick].map(|t| profile.speed(t.min(clock.seconds)));
                // And without a ramp a move would start at its top speed.
                let inside = nearest > F::zero() && nearest < float(clock.ticks);
                inside && off * (here - there).abs() <= most * here
            }
        };
        let on_boundary = rounded || off <= noise;
        let before = if on_boundary { nearest } else { exact.floor() };
        let Some(before) = before.to_u64() else { continue };
        cuts.push(before.min(clock.ticks));
        if !on_boundary {
            cuts.push((before + 1).min(clock.ticks));
        }
    }
    cuts.sort_unstable();
    cuts.dedup();
    cuts
}

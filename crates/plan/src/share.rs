//! Divides a move into pieces and shares its distance out among them, so that the pieces add up
//! exactly to the distance.
//!
//! A piece ends at every breakpoint of the profile and wherever a slow move needs special
//! treatment.

use crate::demand::{Clock, float};
use crate::error::Broken;
use crate::slow::Care;
use crate::units;
use carrystep_profile::{Profile, Real};

/// A run of ticks that follows one formula of the profile, or one tick in which formulas change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Piece {
    /// First tick, counted from 0 at the start of the move.
    pub first: u64,
    /// Length, ticks.
    pub ticks: u64,
    /// Distance from the start of the move to the start of the piece, 2^-64 step.
    pub start: i128,
    /// Distance of the piece in the direction of travel, 2^-64 step.
    pub units: i128,
    /// Whether the step of each pulse gets a tick of its own. Such a piece may follow several
    /// formulas.
    pub by_pulse: bool,
}

/// The room in which motions are divided, one after the other. It is kept, because most of them
/// take the same.
#[derive(Debug, Default)]
pub(crate) struct Room {
    /// The ticks at which pieces begin, and the end of the move.
    cuts: Vec<u64>,
    /// The pieces of the motion that was divided last.
    pub pieces: Vec<Piece>,
}

/// How a breakpoint that falls inside a tick is treated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Breakpoints<F> {
    /// The tick becomes a piece of its own, and the breakpoint is exact.
    Kept,
    /// The breakpoint is moved to the nearest tick boundary if this moves no edge by more than the
    /// given number of ticks; otherwise the tick becomes a piece of its own.
    Rounded(F),
}

/// Divides the move at its breakpoints and at the ends of the parts that `care` names. `fastest` is
/// the greatest distance that the axis may travel in a tick, in units. The pieces are then in
/// `room`.
///
/// Floats share the distance out. The greatest piece takes what their rounding leaves, so that the
/// sum is exactly `total`.
///
/// # Errors
/// [`Broken::Range`] if a float is out of range; [`Broken::Slow`] if the axis has to fall behind
/// and the speed limit does not let it catch up.
pub(crate) fn share<F: Real>(
    profile: &dyn Profile<F>,
    clock: &Clock<F>,
    total: i128,
    breakpoints: Breakpoints<F>,
    care: &Care<F>,
    fastest: i128,
    Room { cuts, pieces }: &mut Room,
) -> Result<(), Broken> {
    cuts.clear();
    cut(profile, clock, breakpoints, cuts);
    let tick_at =
        |x: F| (profile.crossing(x) / clock.tick).round().to_u64().unwrap_or(0).min(clock.ticks);
    let zones: Vec<[u64; 2]> = care.by_pulse.iter().map(|zone| zone.map(tick_at)).collect();
    let behind = care.behind.map(|(ends, units)| (ends.map(tick_at), units));
    cuts.extend(zones.iter().flatten());
    if let Some((ends, _)) = behind {
        cuts.extend(ends);
    }
    // They nearly always are in order, and different.
    if !cuts.is_sorted_by(|a, b| a < b) {
        cuts.sort_unstable();
        cuts.dedup();
    }
    divide(profile, clock, total, cuts, pieces).ok_or(Broken::Range)?;
    if let Some((ends, units)) = behind {
        fall_behind(pieces, ends, units, fastest).ok_or(Broken::Slow)?;
    }
    for zone in zones {
        join(pieces, zone);
    }
    let mut start = 0;
    for piece in pieces {
        piece.start = start;
        start += piece.units;
    }
    Ok(())
}

/// Makes one piece, which is written pulse by pulse, of all between two ticks.
fn join(pieces: &mut Vec<Piece>, [begin, end]: [u64; 2]) {
    let inside = |piece: &Piece| (begin..end).contains(&piece.first);
    let units = pieces.iter().filter(|piece| inside(piece)).map(|piece| piece.units).sum();
    pieces.retain(|piece| piece.first == begin || !inside(piece));
    if let Some(zone) = pieces.iter_mut().find(|piece| piece.first == begin) {
        *zone = Piece { ticks: end - begin, units, by_pulse: true, ..*zone };
    }
}

/// Keeps the axis behind between the two ticks: takes units from a piece before the first tick, and
/// adds them to the piece after the second one that has most room below the speed limit. Returns
/// `None` if there is no such piece or no room.
fn fall_behind(
    pieces: &mut [Piece],
    [first, last]: [u64; 2],
    units: i128,
    fastest: i128,
) -> Option<()> {
    let early =
        pieces.iter_mut().filter(|piece| piece.first < first).max_by_key(|piece| piece.units)?;
    early.units -= units;
    let room = |piece: &Piece| i128::from(piece.ticks) * fastest - piece.units;
    let late =
        pieces.iter_mut().filter(|piece| piece.first >= last).max_by_key(|piece| room(piece))?;
    late.units += units;
    (room(late) >= 0).then_some(())
}

/// Sets the pieces between the cuts, which travel `total` units together. Their `start` is not yet
/// set. Returns `None` if a float is out of range.
fn divide<F: Real>(
    profile: &dyn Profile<F>,
    clock: &Clock<F>,
    total: i128,
    cuts: &[u64],
    pieces: &mut Vec<Piece>,
) -> Option<()> {
    pieces.clear();
    let (mut left, mut greatest) = (total, 0);
    let mut begin = clock.at(*cuts.first()?);
    for ends in cuts.windows(2) {
        let (first, ticks) = (ends[0], ends[1] - ends[0]);
        let end = clock.at(ends[1]);
        let units = distance_between(profile, clock, (first, ticks), [begin, end])?;
        if pieces.get(greatest).is_none_or(|piece: &Piece| piece.units <= units) {
            greatest = pieces.len();
        }
        pieces.push(Piece { first, ticks, start: 0, units, by_pulse: false });
        left -= units;
        begin = end;
    }
    let greatest = pieces.get_mut(greatest)?;
    greatest.units += left;
    (greatest.units >= 0).then_some(())
}

/// Distance over whole ticks, in units. It is computed from a mean speed and not from the
/// difference of two positions, so that its relative error stays small for a single tick too.
pub(crate) fn distance<F: Real>(
    profile: &dyn Profile<F>,
    clock: &Clock<F>,
    first: u64,
    ticks: u64,
) -> Option<i128> {
    let ends = [first, first + ticks].map(|tick| clock.at(tick));
    distance_between(profile, clock, (first, ticks), ends)
}

/// [`distance`], where the times of both ends are known, seconds.
fn distance_between<F: Real>(
    profile: &dyn Profile<F>,
    clock: &Clock<F>,
    (first, ticks): (u64, u64),
    [begin, end]: [F; 2],
) -> Option<i128> {
    let mean = profile.mean_speed(begin, end);
    let used = if first + ticks == clock.ticks {
        float::<F>(ticks - 1) + clock.last
    } else {
        float(ticks)
    };
    Some(units::nearest(mean * (used * clock.tick))?.max(0))
}

/// Adds the ticks at which pieces begin, and the end of the move; unsorted, and with duplicates.
fn cut<F: Real>(
    profile: &dyn Profile<F>,
    clock: &Clock<F>,
    breakpoints: Breakpoints<F>,
    cuts: &mut Vec<u64>,
) {
    cuts.push(0);
    for &breakpoint in profile.breakpoints() {
        let exact = breakpoint / clock.tick;
        let Some(whole) = exact.to_u64() else { continue };
        let rest = exact - float(whole);
        let nearest = whole + u64::from(rest + rest >= F::one());
        // This close to a boundary, the difference is float rounding or too small to move an edge.
        let noise = F::epsilon() * float(4) * exact + F::from(1e-9).unwrap_or_else(F::epsilon);
        let off = (exact - float(nearest)).abs();
        let rounded = match breakpoints {
            Breakpoints::Kept => false,
            Breakpoints::Rounded(most) => {
                // A cruise that takes over this much of a ramp, or of a rest, begins with the wrong
                // speed.
                let [here, there] = [breakpoint, float::<F>(nearest) * clock.tick]
                    .map(|t| profile.speed(t.min(clock.seconds)));
                // A breakpoint at either end of the move is not rounded: without its ramp the move
                // would start at its top speed.
                let inside = 0 < nearest && nearest < clock.ticks;
                inside && off * (here - there).abs() <= most * here
            }
        };
        if rounded || off <= noise {
            cuts.push(nearest.min(clock.ticks));
        } else {
            cuts.extend([whole, whole + 1].map(|tick| tick.min(clock.ticks)));
        }
    }
    // A fitted move that comes to rest may do so up to a tick later.
    let rests = breakpoints != Breakpoints::Kept && profile.speed(clock.seconds).is_zero();
    if clock.last < F::one() && !rests {
        cuts.push(clock.ticks - 1);
    }
    cuts.push(clock.ticks);
}

//! Writes the segments of the motion of one axis in one move: it shares the distance out, and each
//! piece is written pulse by pulse, fitted, or exactly.
//!
//! The two constants below may be changed without harm, because the exact check (`check.rs`)
//! decides whether a plan leaves this crate.

use super::{Place, Planner};
use crate::corridor::{Corridor, JOINT};
use crate::cubic;
use crate::demand::Clock;
use crate::error::Broken;
use crate::exchange::Row;
use crate::fit::Fitter;
use crate::fitted::Fitted;
use crate::run::Writer;
use crate::search::QUICK;
use crate::share::{Breakpoints, Piece, Room, share};
use crate::slow::Pulses;
use carrystep_core::Segment;
use carrystep_core::fixed::ONE_STEP;
use carrystep_files::{Move, PathKind};
use carrystep_profile::{Profile, Real};

/// Limits the tolerance of a fit in a short piece, in ticks, to the length of the piece in ticks
/// divided by this number. A piece of 16 ticks has a tolerance of at most 0.25 ticks.
const LEAST_RATIO: f64 = 64.0;

/// The fraction of the tolerance by which rounding a breakpoint to a whole tick may move an edge.
const ROUNDED: f64 = 0.01;

impl<F: Real> Planner<'_, F> {
    /// Returns the segments of the motion alone, in which the axis gives these pulses.
    pub(super) fn motion(
        &self,
        place: Place<'_>,
        pulses: &Pulses<'_, F>,
        room: &mut Room,
    ) -> Result<Vec<Segment>, Broken> {
        let &Pulses { profile, clock, phase, backward, borrowed, .. } = pulses;
        let clock = &clock;
        let total = i128::from(pulses.count) * ONE_STEP - borrowed;
        let limits = self.limits(place, profile);
        let mut fitting = Fitting::new(place.asked.moved, clock, self.build.timebase.tick_ns());
        let breakpoints = fitting.as_ref().map_or(Breakpoints::Kept, |fitting| {
            Breakpoints::Rounded(F::from(fitting.tolerance * ROUNDED).unwrap_or_else(F::zero))
        });
        share(profile, clock, total, breakpoints, &pulses.care()?, limits.fastest(), room)?;
        let pieces = &room.pieces[..];
        let mut writer = Writer {
            profile,
            clock: *clock,
            limits: &limits,
            phase,
            backward,
            // Where a piece lands, its remainder takes a segment of its own, and a rest may take
            // two.
            segments: Vec::with_capacity(2 * pieces.len() + 2),
            ahead: 0,
        };
        for (index, &piece) in pieces.iter().enumerate() {
            // Slow pulses each get a tick of their own (`placed.rs`). Of the other pieces, those
            // that are curved and belong to a fitted kind of profile are fitted. The rest are
            // exact.
            match &mut fitting {
                _ if piece.by_pulse => writer.placed(piece, pulses)?,
                None => writer.piece(piece, true)?,
                Some(_) if is_straight(profile, clock, piece) => {
                    writer.piece(piece, must_land(pieces, index))?;
                }
                Some(fitting) => {
                    fitting.write(&mut writer, piece, pulses.count, index + 1 == pieces.len())?;
                }
            }
        }
        Ok(writer.segments)
    }
}

/// What the fitted pieces of one axis in one move share.
struct Fitting {
    /// The edge tolerance in ticks. In a short piece, [`LEAST_RATIO`] reduces it further.
    tolerance: f64,
    keeps: bool,
    rows: Vec<Row>,
    risen: Vec<Fitted>,
}

impl Fitting {
    /// `None` for a profile that is followed exactly.
    fn new<F: Real>(moved: &Move, clock: &Clock<F>, tick_ns: u64) -> Option<Self> {
        moved.profile.is_fitted().then(|| Self {
            tolerance: tolerance(moved.fit_ns, clock, tick_ns),
            // Along a line, the distances of the ramps depend on its direction. Hardly any two
            // lines share a kept fit, and making one takes longer than a fit of this move alone.
            keeps: moved.path == PathKind::Free
                || moved.steps.iter().filter(|&&steps| steps != 0).count() < 2,
            rows: Vec::new(),
            risen: Vec::new(),
        })
    }

    /// Fits a piece of a move with so many pulses, and writes its segments.
    fn write<F: Real>(
        &mut self,
        writer: &mut Writer<'_, F>,
        piece: Piece,
        pulses: u64,
        last: bool,
    ) -> Result<(), Broken> {
        let Writer { profile, clock, limits, phase, backward, .. } = *writer;
        let [begin, end] =
            [piece.first, piece.first + piece.ticks].map(|tick| profile.speed(clock.at(tick)));
        let rises = begin <= end;
        let corridor = Corridor {
            profile,
            clock,
            phase,
            backward,
            pulses,
            piece,
            rises,
            tolerance: self.tolerance.min(piece.ticks as f64 / LEAST_RATIO),
            bend: cubic::steps(limits.acceleration),
            joint: JOINT,
            longer: 1.0,
        };
        let rows = std::mem::take(&mut self.rows);
        let mut fitter = Fitter { corridor, limits, rows, search: QUICK, keeps: self.keeps };
        let segments = fitter.segments(writer.position(piece), &self.risen);
        self.rows = fitter.rows;
        writer.fitted(piece, &segments, last)?;
        if rises {
            self.risen = segments;
        }
        Ok(())
    }
}

/// Whether a piece of a fitted move lands exactly. Only the last piece must, because each exact
/// landing costs a segment; the remainder of another piece goes to the next one. There are two
/// exceptions.
fn must_land(pieces: &[Piece], index: usize) -> bool {
    // A piece lands exactly if the next one is too small to take over its remainder.
    let length = pieces[index].ticks;
    let small = |next: &Piece| next.ticks == 1 || next.units <= i128::from(length);
    // And a piece longer than one segment's 32-bit tick counter lands exactly, because an
    // uncorrected rounding of half a unit in V would shift edges visibly after some hours.
    length > u64::from(u32::MAX) || pieces.get(index + 1).is_none_or(small)
}

/// The edge tolerance of a fit in ticks: that of the move file, but not less than the time that the
/// floats of the profile can resolve. In a short piece, `LEAST_RATIO` reduces it further.
fn tolerance<F: Real>(fit_ns: u64, clock: &Clock<F>, tick_ns: u64) -> f64 {
    let noise = F::epsilon().to_f64().unwrap_or(0.0) * 16.0 * clock.ticks as f64;
    (fit_ns as f64 / tick_ns as f64).max(noise)
}

/// Whether a piece needs no fit, because it is one tick long or has constant speed.
fn is_straight<F: Real>(profile: &dyn Profile<F>, clock: &Clock<F>, piece: Piece) -> bool {
    let middle =
        (clock.at(piece.first) + clock.at(piece.first + piece.ticks)) / (F::one() + F::one());
    piece.ticks == 1 || (profile.acceleration(middle).is_zero() && profile.jerk(middle).is_zero())
}

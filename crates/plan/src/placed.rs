//! Places slow pulses one by one: the step of each pulse gets a tick of its own.
//!
//! The bisection (`slow.rs`) would place the edge of such a pulse too inaccurately. Between two
//! pulses only the arrival of P matters. The axis therefore approaches the position just before the
//! step slowly, and takes the step in one tick whose speed the bisection divides without a
//! remainder: Q m units of 2^-32 step, where Q is the number of phases and m a whole number. The
//! edge then falls exactly into the phase in which the profile crosses the step.
//!
//! This follows from the arithmetic of the gateware's bisection; both may change only together.

use crate::bend::Bend;
use crate::error::Broken;
use crate::run::Writer;
use crate::share::Piece;
use crate::slow::{Pulses, SEEN};
use carrystep_profile::Real;

impl<F: Real> Writer<'_, F> {
    /// Writes the segments of a part of a move, pulse by pulse, and lands exactly at the end of it.
    ///
    /// # Errors
    /// [`Broken::Slow`] if the speed limit is below the speed of the tick that takes a step, or if
    /// two pulses are too close together for an approach; [`Broken::Range`] if a float is out of
    /// range.
    pub fn placed(&mut self, piece: Piece, pulses: &Pulses<'_, F>) -> Result<(), Broken> {
        let phases = i128::from(pulses.phases);
        let end = piece.start + piece.units;
        let mut at = self.position(piece);
        let mut tick = i128::from(piece.first);
        self.ahead = 0;
        for k in pulses.due_between(at, end) {
            let (place, speed) = pulses.phase_of(k).ok_or(Broken::Range)?;
            // The least multiple of Q x 2^-32 step per tick that is faster than the profile.
            let per_phase = (speed / (phases * SEEN) + 1) * SEEN;
            // Forward, P may exceed this position by less than 2^-32 step, which the bisection does
            // not see. Backward, V is rounded in the other direction, so the slack goes to the
            // other side.
            let slack = if self.backward { SEEN - 1 } else { 0 };
            let before = pulses.due(k) - (place % phases + 1) * per_phase + slack;
            let stroke = phases * per_phase;
            let approach = place / phases - tick;
            let approach = u64::try_from(approach).map_err(|_| Broken::Slow)?;
            if approach < 1 || before < at || stroke > self.limits.fastest() {
                return Err(Broken::Slow);
            }
            at = before + self.travel(approach, before - at)?;
            at += stroke + self.travel(1, stroke)?;
            tick += i128::from(approach) + 1;
        }
        let left = i128::from(piece.first + piece.ticks) - tick;
        let left = u64::try_from(left).map_err(|_| Broken::Slow)?;
        if left < 1 || end < at {
            return Err(Broken::Slow);
        }
        self.lay(left, self.sign() * (end - at), Bend::default(), true)
    }

    /// Travels `units` in `ticks` ticks. Returns by how much the axis comes further, in the
    /// direction of travel: less than one unit per tick, and 0 if the ticks need several segments.
    fn travel(&mut self, ticks: u64, units: i128) -> Result<i128, Broken> {
        self.lay(ticks, self.sign() * units, Bend::default(), ticks > u32::MAX.into())?;
        let ahead = std::mem::take(&mut self.ahead);
        // A deviation of a unit per tick or more is not rounding: the speed limit has held the axis
        // back.
        if ahead.abs() < ticks.into() { Ok(self.sign() * ahead) } else { Err(Broken::Slow) }
    }
}

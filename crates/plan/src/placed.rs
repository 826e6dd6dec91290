//! Pulses that are too slow for the bisection: each gets a tick of its own.
//!
//! Between two pulses P only has to arrive. So the axis goes slowly to just before the step, and the step itself is
//! one tick at a speed that the bisection divides without a remainder: Q m units of 2^-32 step, where Q is the number
//! of phases and m a whole number. The edge is then in the phase in which the profile has it, exactly.

use crate::bend::Bend;
use crate::error::Broken;
use crate::run::Writer;
use crate::share::Piece;
use crate::slow::{Pulses, SEEN};
use carrystep_profile::Real;

impl<F: Real> Writer<'_, F> {
    /// Writes a part of a move pulse by pulse; it lands exactly where the part ends.
    ///
    /// # Errors
    /// [`Broken::Slow`]: the speed limit is under the speed of such a tick.
    pub fn placed(&mut self, piece: Piece, pulses: &Pulses<'_, F>) -> Result<(), Broken> {
        let phases = i128::from(pulses.phases);
        let end = piece.start + piece.units;
        let mut at = self.position(piece);
        let mut tick = i128::from(piece.first);
        self.ahead = 0;
        for k in pulses.due_between(at, end) {
            let (place, speed) = pulses.phase_of(k).ok_or(Broken::Range)?;
            // The least multiple that is no slower than the profile.
            let per_phase = (speed / (phases * SEEN) + 1) * SEEN;
            // P may be ahead of this by less than what the bisection sees; backward, V is rounded the other way.
            let slack = if self.backward { SEEN - 1 } else { 0 };
            let before = pulses.due(k) - (place % phases + 1) * per_phase + slack;
            let stroke = phases * per_phase;
            let approach = place / phases - tick;
            if approach < 1 || before < at || stroke > self.limits.fastest() {
                return Err(Broken::Slow);
            }
            at = before + self.travel(approach, before - at)?;
            at += stroke + self.travel(1, stroke)?;
            tick += approach + 1;
        }
        let left = i128::from(piece.first + piece.ticks) - tick;
        if left < 1 || end < at {
            return Err(Broken::Slow);
        }
        self.lay(left, self.sign() * (end - at), Bend::default(), true)
    }

    /// Goes `units` in so many ticks; how much further it comes, in the direction of travel: less than a unit a tick,
    /// and nothing where several segments are needed.
    fn travel(&mut self, ticks: i128, units: i128) -> Result<i128, Broken> {
        self.lay(ticks, self.sign() * units, Bend::default(), ticks > u32::MAX.into())?;
        let ahead = std::mem::take(&mut self.ahead);
        // Further behind than by rounding only where the speed limit has held the axis back.
        if ahead.abs() < ticks { Ok(self.sign() * ahead) } else { Err(Broken::Slow) }
    }
}

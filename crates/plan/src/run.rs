//! A piece of a move as segments: A from the profile, rounded toward zero, V from the distance.

use crate::demand::Clock;
use crate::error::Broken;
use crate::limits::ExactLimits;
use crate::share::{self, Piece};
use crate::units;
use carrystep_profile::{Profile, Real};
use carrystep_spec::{Segment, StartPhase};

/// How far the rounding of A may move an edge, seconds; the rest of 2 ns is for the 32-bit bisection.
const EDGE_SHIFT: f64 = 0.5e-9;

/// Speeds below this, steps/s, are held to [`EDGE_SHIFT`] as if they were this fast.
const SLOWEST: f64 = 1.0;

/// Writes the segments of one axis in one move.
pub(crate) struct Writer<'a, F> {
    pub profile: &'a dyn Profile<F>,
    pub clock: Clock<F>,
    pub limits: &'a ExactLimits,
    pub phase: StartPhase,
    pub backward: bool,
    pub segments: Vec<Segment>,
    /// Units by which the segments of this piece are ahead.
    pub ahead: i128,
}

/// The acceleration of a piece in units, in the direction of travel.
#[derive(Debug, Clone, Copy)]
struct Slope {
    /// Rounded toward zero, and within the limit.
    units: i128,
    /// What that left out: units, in magnitude.
    lost: f64,
}

impl<F: Real> Writer<'_, F> {
    /// Writes the segments of a piece; their distances add up to it exactly.
    pub fn piece(&mut self, piece: Piece) -> Result<(), Broken> {
        let slope = if piece.ticks == 1 { Slope { units: 0, lost: 0.0 } } else { self.slope(piece)? };
        self.divide(piece, slope, true)
    }

    fn slope(&self, Piece { first, ticks, .. }: Piece) -> Result<Slope, Broken> {
        let middle = (self.clock.at(first) + self.clock.at(first + ticks)) / (F::one() + F::one());
        let per_tick = self.profile.acceleration(middle) * self.clock.tick * self.clock.tick;
        let rounded = units::toward_zero(per_tick).ok_or(Broken::Range)?;
        let most = self.limits.acceleration;
        let clamped = rounded.clamp(-most, most);
        let exact = per_tick.to_f64().unwrap_or(f64::NAN) * 2_f64.powi(64);
        Ok(Slope { units: clamped, lost: (exact - clamped as f64).abs() })
    }

    /// Halves a piece until the rounding of A moves no edge by more than [`EDGE_SHIFT`].
    ///
    /// The slower half gets its distance from the profile, the faster one what remains: float rounding
    /// is relative to a distance, so this keeps it small where edges are far apart.
    fn divide(&mut self, piece: Piece, slope: Slope, ends: bool) -> Result<(), Broken> {
        let Piece { first, ticks, units } = piece;
        if ticks < 4 || self.fine(piece, slope) {
            return self.run(piece, slope.units, ends);
        }
        let half = ticks / 2;
        let local = |first, ticks| {
            let local = share::distance(self.profile, &self.clock, first, ticks);
            local.map(|local| local.min(units)).ok_or(Broken::Range)
        };
        let head = if slope.units >= 0 { local(first, half)? } else { units - local(first + half, ticks - half)? };
        self.divide(Piece { first, ticks: half, units: head }, slope, false)?;
        self.divide(Piece { first: first + half, ticks: ticks - half, units: units - head }, slope, ends)
    }

    fn fine(&self, Piece { first, ticks, .. }: Piece, Slope { lost, .. }: Slope) -> bool {
        let length = ticks as f64;
        // V makes up for A, so that a long first run would start too fast by half of this.
        if first == 0 && lost * length > self.limits.tolerance as f64 {
            return false;
        }
        let [begin, end] = [first, first + ticks].map(|tick| self.clock.at(tick));
        let wide = |x: F| x.to_f64().unwrap_or(f64::NAN);
        let slowest = wide(self.profile.speed(begin).min(self.profile.speed(end)));
        // From rest, the first edge comes half a step later, at speed sqrt(a).
        let at_edge = slowest.max(wide(self.profile.acceleration(begin).abs().sqrt())).max(SLOWEST);
        let shift = lost * length * length / 8.0 * 2_f64.powi(-64) / at_edge;
        shift <= EDGE_SHIFT || !self.has_edge(wide(self.profile.position(begin)), wide(self.profile.position(end)))
    }

    /// Whether a pulse is due between two positions, or near them.
    fn has_edge(&self, from: f64, to: f64) -> bool {
        let offset = match self.phase {
            StartPhase::Half => 0.5,
            StartPhase::Zero => 0.0,
        };
        (to - offset + 1e-3).floor() > (from - offset - 1e-3).floor()
    }

    /// One run of constant A. What V cannot share evenly goes to the first ticks, one unit each, where
    /// the piece ends; before that it is carried into the next run.
    fn run(&mut self, Piece { ticks, units, .. }: Piece, slope: i128, ends: bool) -> Result<(), Broken> {
        let n = i128::from(ticks);
        let sign = if self.backward { -1 } else { 1 };
        let distance = sign * units - self.ahead;
        let pairs = n * (n - 1) / 2;
        // Under this |A| the speed cannot change sign, whatever floats have made of the distance.
        let most = if pairs == 0 { 0 } else { distance.abs() / pairs };
        let a = sign * slope.clamp(-most, most);
        let level = distance - pairs * a;
        let v = level.div_euclid(n);
        let remainder = level.rem_euclid(n);
        if ends {
            self.ahead = 0;
            self.push(remainder, v + 1, a)?;
            self.push(n - remainder, v + remainder * a, a)
        } else {
            let spent = i128::from(remainder > 0);
            self.ahead = n * spent - remainder;
            self.push(n, v + spent, a)
        }
    }

    /// Ticks of constant A, in as many segments as their counters need.
    fn push(&mut self, mut ticks: i128, mut v: i128, a: i128) -> Result<(), Broken> {
        let a64 = i64::try_from(a).map_err(|_| Broken::Range)?;
        while ticks > 0 {
            let length = ticks.min(u32::MAX.into());
            let v64 = i64::try_from(v).map_err(|_| Broken::Range)?;
            self.segments.push(Segment { ticks: length as u32, v: v64, a: a64, j: 0, last: false });
            v += length * a;
            ticks -= length;
        }
        Ok(())
    }
}

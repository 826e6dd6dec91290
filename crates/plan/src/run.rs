//! Writes a piece of constant jerk as segments: J and A come from the profile, rounded toward zero,
//! and V follows from the distance.
//!
//! A run is a sequence of ticks that follows one cubic; a unit is 2^-64 step. `ahead` carries the
//! rounding of V from one run to the next, so that it never accumulates.

use crate::bend::{Bend, Wanted};
use crate::check::speeds;
use crate::cubic::wide;
use crate::demand::Clock;
use crate::error::Broken;
use crate::fine::{Fine, fine};
use crate::fitted::Fitted;
use crate::landing;
use crate::limits::{ExactLimits, MOST_SEGMENTS};
use crate::registers::{Registers, register, shared_out};
use crate::share::{self, Piece};
use crate::units;
use carrystep_core::{Segment, StartPhase};
use carrystep_profile::{Profile, Rates, Real};

/// Writes the segments of one axis in one move.
pub(crate) struct Writer<'a, F> {
    pub profile: &'a dyn Profile<F>,
    pub clock: Clock<F>,
    pub limits: &'a ExactLimits,
    pub phase: StartPhase,
    pub backward: bool,
    pub segments: Vec<Segment>,
    /// Units by which the segments written so far are ahead of the profile; signed, positive is
    /// forward.
    pub ahead: i128,
}

/// A register value of a piece in units, in the direction of travel.
#[derive(Debug, Clone, Copy, Default)]
struct Rate {
    /// The value, rounded toward zero and clamped to its limit.
    units: i128,
    /// Magnitude of the difference from the exact value, units.
    lost: f64,
}

impl<F: Real> Writer<'_, F> {
    /// Writes the segments of a piece of constant jerk. If the piece `ends` a part of the move, its
    /// segments travel exactly the distance that is left.
    pub fn piece(&mut self, piece: &Piece, ends: bool) -> Result<(), Broken> {
        self.divide(piece, None, ends)
    }

    /// The sign of the motion: 1 forward, -1 backward.
    pub const fn sign(&self) -> i128 {
        if self.backward { -1 } else { 1 }
    }

    /// The position of the axis when a piece begins, units in the direction of travel, with what is
    /// carried over from the piece before.
    pub fn position(&self, piece: &Piece) -> i128 {
        piece.start + self.signed(self.ahead)
    }

    /// A distance in the direction of travel as a signed distance, and the reverse.
    const fn signed(&self, units: i128) -> i128 {
        if self.backward { -units } else { units }
    }

    /// Writes the segments of a fitted piece, and carries the units that they are off into the next
    /// piece.
    pub fn fitted(&mut self, piece: &Piece, segments: &[Fitted], ends: bool) -> Result<(), Broken> {
        let sign = self.sign();
        let mut done = self.position(piece);
        self.ahead = 0;
        for (index, &Fitted { ticks, bend, distance }) in segments.iter().enumerate() {
            let lands = ends && index + 1 == segments.len();
            if lands && self.land(segments, sign * distance)? {
                return Ok(());
            }
            self.lay(ticks, sign * distance, bend, lands)?;
            done += distance;
        }
        self.ahead = sign * (done - piece.start - piece.units);
        Ok(())
    }

    /// Lands the last segment of a fit without dividing it, if another segment can take over a few
    /// units of V. Returns whether that was possible.
    fn land(&mut self, segments: &[Fitted], distance: i128) -> Result<bool, Broken> {
        let Some((last, others)) = segments.split_last() else { return Ok(false) };
        let laid = self.segments.len();
        let sign = self.sign();
        let n = i128::from(last.ticks);
        self.lay(last.ticks, distance, last.bend, false)?;
        let rest = -sign * self.ahead;
        for (other, fitted) in (1..laid).rev().zip(others.iter().rev()) {
            let Some((slower, faster)) = landing::shared(fitted.ticks.into(), n, rest) else {
                continue;
            };
            let faster = [(other, slower), (laid, faster)].map(|(i, units)| {
                let segment = self.segments.get(i).copied()?;
                let v = i64::try_from(i128::from(segment.v) + sign * units).ok()?;
                let faster = Segment { v, ..segment };
                let kept =
                    speeds(&faster).all(|v| (0..=self.limits.fastest()).contains(&(sign * v)));
                kept.then_some(faster)
            });
            if let [Some(other_faster), Some(last_faster)] = faster {
                (self.segments[other], self.segments[laid]) = (other_faster, last_faster);
                self.ahead = 0;
                return Ok(true);
            }
        }
        self.segments.truncate(laid);
        Ok(false)
    }

    fn jerk(&self, middle: &Rates<F>) -> Result<Rate, Broken> {
        let tick = self.clock.tick;
        rate(middle.jerk * tick * tick * tick, self.limits.jerk.unwrap_or(i128::MAX))
    }

    /// The acceleration in the middle of a run: twice its value in units, and the magnitude of what
    /// rounding leaves out.
    fn acceleration(&self, middle: &Rates<F>, jerk: Rate) -> Result<(i128, f64), Broken> {
        let tick = self.clock.tick;
        let per_tick = middle.acceleration * tick * tick;
        let doubled = units::toward_zero(per_tick + per_tick).ok_or(Broken::Range)?;
        let lost = rate(per_tick, self.limits.acceleration)?.lost;
        // A is loaded for the start of the run, half a run of J away from the middle. That rounds
        // once more.
        Ok((doubled, if jerk.units == 0 { lost } else { lost.max(1.0) }))
    }

    /// Halves a piece until the rounding of A, J and V moves no edge too far (`fine.rs`).
    /// The jerk is that in the middle of the piece that is halved first.
    ///
    /// The slower half gets its distance from the profile, and the faster half what remains. Float
    /// rounding is relative to a distance, so this keeps the error small where edges are far apart.
    fn divide(&mut self, piece: &Piece, jerk: Option<Rate>, ends: bool) -> Result<(), Broken> {
        let &Piece { first, ticks, units, .. } = piece;
        if ticks == 1 {
            let distance = self.signed(units) - self.ahead;
            if !ends {
                return self.lay(1, distance, Bend::default(), false);
            }
            self.ahead = 0;
            return self.push(1, Registers { v: distance, a: 0, j: 0 });
        }
        let ends_at = [first, first + ticks].map(|tick| self.clock.at(tick));
        let middle = self.profile.rates((ends_at[0] + ends_at[1]) / (F::one() + F::one()));
        let jerk = jerk.map_or_else(|| self.jerk(&middle), Ok)?;
        let (doubled, lost) = self.acceleration(&middle, jerk)?;
        let whole = if ticks < 4 {
            Some(Fine::Carried)
        } else {
            let start = (self.phase, self.limits.tolerance);
            fine(self.profile, piece, ends_at, &middle, [lost, jerk.lost], start)
        };
        if let Some(whole) = whole {
            return self.run(piece, doubled, jerk.units, ends || whole == Fine::Landed);
        }
        let half = ticks / 2;
        if doubled == 0 && jerk.units == 0 && middle.are_level() {
            let (whole, rest) = (units / i128::from(ticks), units % i128::from(ticks));
            let head = whole * i128::from(half) + rest * i128::from(half) / i128::from(ticks);
            return self.halves(piece, half, head, jerk, ends);
        }
        let local = |first, ticks| {
            let local = share::distance(self.profile, &self.clock, first, ticks);
            local.map(|local| local.min(units)).ok_or(Broken::Range)
        };
        let rises = self.profile.speed(self.clock.at(first))
            <= self.profile.speed(self.clock.at(first + ticks));
        let head =
            if rises { local(first, half)? } else { units - local(first + half, ticks - half)? };
        self.halves(piece, half, head, jerk, ends)
    }

    /// Writes the first `half` ticks of a piece, which travel `head` units, and then the other
    /// ticks.
    fn halves(
        &mut self,
        piece: &Piece,
        half: u64,
        head: i128,
        jerk: Rate,
        ends: bool,
    ) -> Result<(), Broken> {
        let &Piece { first, ticks, start, units, by_pulse } = piece;
        let jerk = Some(jerk);
        self.divide(&Piece { ticks: half, units: head, ..*piece }, jerk, false)?;
        let (first, start) = (first + half, start + head);
        let (ticks, units) = (ticks - half, units - head);
        self.divide(&Piece { first, ticks, start, units, by_pulse }, jerk, ends)
    }

    /// Writes one run of constant jerk.
    fn run(
        &mut self,
        piece: &Piece,
        doubled_middle: i128,
        jerk: i128,
        ends: bool,
    ) -> Result<(), Broken> {
        let distance = self.signed(piece.units) - self.ahead;
        let wanted = Wanted {
            ticks: piece.ticks,
            distance: self.signed(distance),
            doubled_middle,
            jerk,
            one_way: true,
            least: 0,
            first: piece.first == 0,
        };
        self.lay(piece.ticks, distance, wanted.within(self.limits), ends)
    }

    /// Writes a run of `n` ticks over a signed distance in units. The part that V cannot spread
    /// evenly is added to the first ticks, one unit each, if the run `ends` a piece; otherwise it
    /// is carried into the next run.
    pub fn lay(&mut self, n: u64, distance: i128, bend: Bend, ends: bool) -> Result<(), Broken> {
        let [a, j] = [register(self.signed(bend.a))?, register(self.signed(bend.j))?];
        let bent = if n == 1 || (a == 0 && j == 0) { Some(0) } else { bend.distance(n) };
        let level = distance - self.signed(bent.ok_or(Broken::Range)?);
        let (v, remainder) = shared_out(level, n);
        if ends {
            self.ahead = 0;
            let mut now = Registers { v: v + 1, a, j };
            if remainder > 0 {
                self.push(remainder, now)?;
                now = now.after(remainder)?;
            }
            self.push(n - remainder, Registers { v: now.v - 1, ..now })
        } else {
            // A distance that the speed limit prevents stays in `ahead` and is not forced.
            let most = if a == 0 && j == 0 { self.limits.fastest() } else { i128::MAX };
            let (whole, ahead) = if remainder > 0 { (v + 1, n - remainder) } else { (v, 0) };
            let used = whole.clamp(-most, most);
            self.ahead = i128::from(ahead);
            if used != whole {
                self.ahead += i128::from(n) * (used - whole);
            }
            self.push(n, Registers { v: used, a, j })
        }
    }

    /// Writes the ticks of one cubic, in as many segments as their 32-bit tick counters need.
    #[inline]
    fn push(&mut self, ticks: u64, now: Registers) -> Result<(), Broken> {
        match u32::try_from(ticks) {
            Ok(ticks) => self.segment(ticks, now),
            Err(_) => self.push_long(ticks, now),
        }
    }

    /// [`Self::push`] for more ticks than a segment can have.
    #[cold]
    fn push_long(&mut self, ticks: u64, mut now: Registers) -> Result<(), Broken> {
        let mut left = ticks;
        while left > 0 {
            let length = u32::try_from(left).unwrap_or(u32::MAX);
            self.segment(length, now)?;
            left -= u64::from(length);
            now = if left > 0 { now.after(length.into())? } else { now };
        }
        Ok(())
    }

    #[inline]
    fn segment(&mut self, ticks: u32, now: Registers) -> Result<(), Broken> {
        if self.segments.len() >= MOST_SEGMENTS {
            return Err(Broken::Segments);
        }
        let Registers { v, a, j } = now;
        self.segments.push(Segment { ticks, v: register(v)?, a, j, last: false });
        Ok(())
    }
}

/// Converts `per_tick` steps to units, rounded toward zero and clamped to `most`.
fn rate<F: Real>(per_tick: F, most: i128) -> Result<Rate, Broken> {
    if per_tick.is_zero() {
        return Ok(Rate::default());
    }
    let exact = wide(per_tick) * 2_f64.powi(64);
    let units = units::toward_zero(per_tick).ok_or(Broken::Range)?;
    if -most <= units && units <= most && exact.abs() < 2_f64.powi(62) {
        // The conversion of 64 bits is an instruction of the processor.
        return Ok(Rate { units, lost: (exact - (exact as i64) as f64).abs() });
    }
    let units = units.clamp(-most, most);
    Ok(Rate { units, lost: (exact - units as f64).abs() })
}

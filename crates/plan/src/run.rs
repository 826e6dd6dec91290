//! Writes a piece of constant jerk as segments: J and A come from the profile, rounded toward zero,
//! and V follows from the distance.
//!
//! A run is a sequence of ticks that follows one cubic; a unit is 2^-64 step. `ahead` carries the
//! rounding of V from one run to the next, so that it never accumulates.

use crate::bend::{Bend, Wanted};
use crate::check::speeds;
use crate::demand::Clock;
use crate::edges::{product, speed};
use crate::error::Broken;
use crate::fitted::Fitted;
use crate::landing;
use crate::limits::{ExactLimits, MOST_SEGMENTS};
use crate::share::{self, Piece};
use crate::units;
use carrystep_core::{Segment, StartPhase};
use carrystep_profile::{Profile, Rates, Real};

/// How far the rounding of A, J and V may move an edge, seconds. The rest of the promised 2 ns is
/// for the 32-bit bisection and for the floats of the profile, which are accurate to 0.3 ns after
/// 10^6 s.
const EDGE_SHIFT: f64 = 0.5e-9;

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

/// How a run may treat the units by which its rounded V is ahead at its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fine {
    /// The next run corrects them.
    Carried,
    /// The run has to land exactly, because they would move an edge of the next run.
    Landed,
}

impl<F: Real> Writer<'_, F> {
    /// Writes the segments of a piece of constant jerk. If the piece `ends` a part of the move, its
    /// segments travel exactly the distance that is left.
    pub fn piece(&mut self, piece: Piece, ends: bool) -> Result<(), Broken> {
        self.divide(piece, None, ends)
    }

    /// The sign of the motion: 1 forward, -1 backward.
    pub const fn sign(&self) -> i128 {
        if self.backward { -1 } else { 1 }
    }

    /// The position of the axis when a piece begins, units in the direction of travel, with what is
    /// carried over from the piece before.
    pub fn position(&self, piece: Piece) -> i128 {
        piece.start + self.signed(self.ahead)
    }

    /// A distance in the direction of travel as a signed distance, and the reverse.
    const fn signed(&self, units: i128) -> i128 {
        if self.backward { -units } else { units }
    }

    /// Writes the segments of a fitted piece, and carries the units that they are off into the next
    /// piece.
    pub fn fitted(&mut self, piece: Piece, segments: &[Fitted], ends: bool) -> Result<(), Broken> {
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

    /// The rates of the profile in the middle of a piece.
    fn middle(&self, Piece { first, ticks, .. }: Piece) -> Rates<F> {
        let ends = self.clock.at(first) + self.clock.at(first + ticks);
        self.profile.rates(ends / (F::one() + F::one()))
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

    /// Halves a piece until the rounding of A, J and V moves no edge by more than [`EDGE_SHIFT`].
    /// The jerk is that in the middle of the piece that is halved first.
    ///
    /// The slower half gets its distance from the profile, and the faster half what remains. Float
    /// rounding is relative to a distance, so this keeps the error small where edges are far apart.
    fn divide(&mut self, piece: Piece, jerk: Option<Rate>, ends: bool) -> Result<(), Broken> {
        let Piece { first, ticks, units, .. } = piece;
        if ticks == 1 {
            return self.lay(1, self.signed(units) - self.ahead, Bend::default(), ends);
        }
        let middle = self.middle(piece);
        let jerk = jerk.map_or_else(|| self.jerk(&middle), Ok)?;
        let (doubled, lost) = self.acceleration(&middle, jerk)?;
        let fine = if ticks < 4 {
            Some(Fine::Carried)
        } else {
            self.fine(piece, &middle, [lost, jerk.lost])
        };
        if let Some(fine) = fine {
            return self.run(piece, doubled, jerk.units, ends || fine == Fine::Landed);
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
        piece: Piece,
        half: u64,
        head: i128,
        jerk: Rate,
        ends: bool,
    ) -> Result<(), Broken> {
        let Piece { first, ticks, start, units, .. } = piece;
        let jerk = Some(jerk);
        self.divide(Piece { ticks: half, units: head, ..piece }, jerk, false)?;
        let (first, start) = (first + half, start + head);
        self.divide(
            Piece { first, ticks: ticks - half, start, units: units - head, ..piece },
            jerk,
            ends,
        )
    }

    /// Decides whether a run may have the length of this piece, and how it then treats its
    /// remainder. `acceleration` and `jerk` are the magnitudes that rounding leaves out of A and J.
    /// `None` means that the piece has to be divided.
    fn fine(
        &self,
        piece: Piece,
        middle: &Rates<F>,
        [acceleration, jerk]: [f64; 2],
    ) -> Option<Fine> {
        let Piece { first, ticks, .. } = piece;
        let length = ticks as f64;
        // V makes up for A and J, so a long first run would start too fast by half of this speed.
        let late = (acceleration + jerk * length / 3.0) * length;
        if first == 0 && late > self.limits.tolerance as f64 {
            return None;
        }
        // The deviation is a parabola t(n-t)/2 for each unit left out of A, and at most a cubic t^2
        // (n-t)/6 for each unit left out of J. In addition V is ahead by up to one unit per tick.
        let lost = (jerk * length / 40.0 + acceleration / 8.0) * length + 1.0;
        let shifts = |lost: f64, speed: f64| {
            let shift = lost * length * 2_f64.powi(-64) / speed;
            // Not a number is no small shift.
            !(shift <= EDGE_SHIFT)
        };
        let [begin, end] = [first, first + ticks].map(|tick| self.clock.at(tick));
        let at_edge = if middle.are_level() {
            // A breakpoint rounded to a tick may leave the end of a ramp at the beginning of a
            // cruise.
            wide(middle.speed)
        } else {
            let from = self.profile.rates(begin);
            let slowest = wide(from.speed.min(self.profile.speed(end))).max(f64::MIN_POSITIVE);
            // After a start from rest the first edge comes half a step later, at a speed of sqrt(a)
            // or more than cbrt(j). A root is only taken where it decides.
            if shifts(lost, slowest) {
                let by_acceleration = slowest.max(wide(from.acceleration.abs().sqrt()));
                if shifts(lost, by_acceleration) {
                    by_acceleration.max(wide(from.jerk.abs().cbrt()))
                } else {
                    by_acceleration
                }
            } else {
                slowest
            }
        };
        if !shifts(lost, at_edge) {
            return Some(Fine::Carried);
        }
        let [from, to] = [begin, end].map(|t| wide(self.profile.position(t)));
        // Tests whether the units by which V is ahead would move the next edge.
        let still = if shifts(1.0, at_edge) { Fine::Landed } else { Fine::Carried };
        (!self.has_edge(from, to)).then_some(still)
    }

    /// Whether a pulse is due between two positions in steps, or within 10^-3 step of them.
    fn has_edge(&self, from: f64, to: f64) -> bool {
        let offset = match self.phase {
            StartPhase::Half => 0.5,
            StartPhase::Zero => 0.0,
        };
        (to - offset + 1e-3).floor() > (from - offset - 1e-3).floor()
    }

    /// Writes one run of constant jerk.
    fn run(
        &mut self,
        piece: Piece,
        doubled_middle: i128,
        jerk: i128,
        ends: bool,
    ) -> Result<(), Broken> {
        let distance = self.signed(piece.units) - self.ahead;
        let wanted = Wanted {
            ticks: piece.ticks.into(),
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
        let level = self.signed(distance) - bend.distance(n).ok_or(Broken::Range)?;
        let [a, j] = [bend.a, bend.j].map(|rate| self.signed(rate));
        let (v, remainder) = shared_out(self.signed(level), n);
        let j = register(j)?;
        if ends {
            self.ahead = 0;
            let Registers { v, a } = self.push(remainder, Registers { v: v + 1, a }, j)?;
            self.push(n - remainder, Registers { v: v - 1, a }, j)?;
        } else {
            // A distance that the speed limit prevents stays in `ahead` and is not forced.
            let most = if a == 0 && j == 0 { self.limits.fastest() } else { i128::MAX };
            let (whole, ahead) = if remainder > 0 { (v + 1, n - remainder) } else { (v, 0) };
            let used = whole.clamp(-most, most);
            self.ahead = i128::from(ahead);
            if used != whole {
                self.ahead += i128::from(n) * (used - whole);
            }
            self.push(n, Registers { v: used, a }, j)?;
        }
        Ok(())
    }

    /// Writes the ticks of one cubic, in as many segments as their 32-bit tick counters need.
    /// Returns the registers after them.
    fn push(&mut self, mut ticks: u64, mut now: Registers, j: i64) -> Result<Registers, Broken> {
        while ticks > 0 {
            if self.segments.len() >= MOST_SEGMENTS {
                return Err(Broken::Segments);
            }
            let length = u32::try_from(ticks).unwrap_or(u32::MAX);
            let (v, a) = (register(now.v)?, register(now.a)?);
            let segment = Segment { ticks: length, v, a, j, last: false };
            self.segments.push(segment);
            now = Registers {
                v: speed(&segment, length.into()),
                a: now.a + product(length.into(), j),
            };
            ticks -= u64::from(length);
        }
        Ok(now)
    }
}

/// The values of V and A before a tick, which the gateware accumulates.
#[derive(Debug, Clone, Copy)]
struct Registers {
    v: i128,
    a: i128,
}

fn register(value: i128) -> Result<i64, Broken> {
    i64::try_from(value).map_err(|_| Broken::Range)
}

/// A distance in `n` equal parts, rounded down, and the remainder.
fn shared_out(distance: i128, n: u64) -> (i128, u64) {
    let magnitude = distance.unsigned_abs();
    let (part, rest) = match (u32::try_from(n), u64::try_from(magnitude >> 32)) {
        // Long division in digits of 32 bits; no rest is over 32 bits, and so no digit is either.
        (Ok(_), Ok(high)) => {
            let low = (high % n) << 32 | magnitude as u64 & u64::from(u32::MAX);
            (u128::from(high / n) << 32 | u128::from(low / n), low % n)
        }
        _ => (magnitude / u128::from(n), (magnitude % u128::from(n)) as u64),
    };
    let part = part.cast_signed();
    match (distance < 0, rest) {
        (false, _) => (part, rest),
        (true, 0) => (-part, 0),
        (true, _) => (-part - 1, n - rest),
    }
}

fn wide<F: Real>(x: F) -> f64 {
    x.to_f64().unwrap_or(f64::NAN)
}

/// Converts `per_tick` steps to units, rounded toward zero and clamped to `most`.
fn rate<F: Real>(per_tick: F, most: i128) -> Result<Rate, Broken> {
    let units = units::toward_zero(per_tick).ok_or(Broken::Range)?.clamp(-most, most);
    let exact = wide(per_tick) * 2_f64.powi(64);
    let rounded = i64::try_from(units).map_or_else(|_| units as f64, |units| units as f64);
    Ok(Rate { units, lost: (exact - rounded).abs() })
}
